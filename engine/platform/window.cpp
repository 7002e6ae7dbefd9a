#include "engine/platform/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/assert.hpp"

// As GLFW declares it when vulkan.h is known; the handles are pointers on every 64-bit platform.
extern "C" int glfwCreateWindowSurface(void* instance, GLFWwindow* window, const void* allocator,
                                       std::uint64_t* surface);

namespace psygen::platform {
namespace {

static_assert(sizeof(void*) == 8, "Vulkan surfaces are pointers only on 64-bit platforms");

// GLFW is initialised once per process and keeps no count of its own.
int& window_count() {
  static int count = 0;
  return count;
}

std::string glfw_error() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description != nullptr ? description : "the window system gave no reason";
}

std::optional<Key> key_of(int glfw_key) {
  const auto offset = [&](Key first, int glfw_first) {
    return static_cast<Key>(static_cast<int>(first) + glfw_key - glfw_first);
  };
  if (glfw_key >= GLFW_KEY_A && glfw_key <= GLFW_KEY_Z) return offset(Key::kA, GLFW_KEY_A);
  if (glfw_key >= GLFW_KEY_0 && glfw_key <= GLFW_KEY_9) return offset(Key::k0, GLFW_KEY_0);
  if (glfw_key >= GLFW_KEY_F1 && glfw_key <= GLFW_KEY_F12) return offset(Key::kF1, GLFW_KEY_F1);
  constexpr std::array<std::pair<int, Key>, 19> kOthers{{
      {GLFW_KEY_UP, Key::kUp},
      {GLFW_KEY_DOWN, Key::kDown},
      {GLFW_KEY_LEFT, Key::kLeft},
      {GLFW_KEY_RIGHT, Key::kRight},
      {GLFW_KEY_PAGE_UP, Key::kPageUp},
      {GLFW_KEY_PAGE_DOWN, Key::kPageDown},
      {GLFW_KEY_HOME, Key::kHome},
      {GLFW_KEY_END, Key::kEnd},
      {GLFW_KEY_LEFT_SHIFT, Key::kShift},
      {GLFW_KEY_RIGHT_SHIFT, Key::kShift},
      {GLFW_KEY_LEFT_CONTROL, Key::kControl},
      {GLFW_KEY_RIGHT_CONTROL, Key::kControl},
      {GLFW_KEY_LEFT_ALT, Key::kAlt},
      {GLFW_KEY_RIGHT_ALT, Key::kAlt},
      {GLFW_KEY_SPACE, Key::kSpace},
      {GLFW_KEY_TAB, Key::kTab},
      {GLFW_KEY_ENTER, Key::kEnter},
      {GLFW_KEY_ESCAPE, Key::kEscape},
      {GLFW_KEY_BACKSPACE, Key::kBackspace},
  }};
  const auto found = std::find_if(kOthers.begin(), kOthers.end(),
                                  [&](const auto& entry) { return entry.first == glfw_key; });
  return found == kOthers.end() ? std::nullopt : std::optional(found->second);
}

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

std::int64_t common_area(const Rectangle& a, const Rectangle& b) {
  const int width = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
  const int height = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
  return std::int64_t{std::max(width, 0)} * std::max(height, 0);
}

// The monitor that shows most of a rectangle, or the first one if none does; null without monitors.
GLFWmonitor* monitor_of(const Rectangle& place) {
  int count = 0;
  GLFWmonitor** const monitors = glfwGetMonitors(&count);
  GLFWmonitor* best = nullptr;
  std::int64_t most = -1;
  for (int i = 0; i < count; ++i) {
    const GLFWvidmode* const mode = glfwGetVideoMode(monitors[i]);
    if (mode == nullptr) continue;
    Rectangle shown{0, 0, mode->width, mode->height};
    glfwGetMonitorPos(monitors[i], &shown.x, &shown.y);
    const std::int64_t area = common_area(place, shown);
    if (area <= most) continue;
    most = area;
    best = monitors[i];
  }
  return best;
}

}  // namespace

struct Window::Implementation {
  GLFWwindow* window = nullptr;
  Rectangle windowed;       // its place before it covered a monitor
  InputState input;         // collected since the last poll
  glm::dvec2 pointer{0.0};  // last reported place; leaves the window while looking

  explicit Implementation(GLFWwindow* created) : window(created) {
    ++window_count();
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, &Implementation::on_key);
    glfwSetMouseButtonCallback(window, &Implementation::on_button);
    glfwSetCursorPosCallback(window, &Implementation::on_pointer);
    glfwSetScrollCallback(window, &Implementation::on_wheel);
    glfwSetFramebufferSizeCallback(window, &Implementation::on_resize);
    glfwSetWindowIconifyCallback(window, [](GLFWwindow* w, int) { of(w).input.resized = true; });
  }
  ~Implementation() {
    glfwDestroyWindow(window);
    if (--window_count() == 0) glfwTerminate();
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  static Implementation& of(GLFWwindow* window) {
    return *static_cast<Implementation*>(glfwGetWindowUserPointer(window));
  }

  static void on_key(GLFWwindow* window, int key, int, int action, int) {
    const std::optional<Key> known = key_of(key);
    if (!known || action == GLFW_REPEAT) return;
    InputState& input = of(window).input;
    input.held.set(static_cast<std::size_t>(*known), action == GLFW_PRESS);
    if (action == GLFW_PRESS) input.went_down.set(static_cast<std::size_t>(*known));
  }

  static void on_button(GLFWwindow* window, int button, int action, int) {
    if (button != GLFW_MOUSE_BUTTON_RIGHT) return;
    of(window).look(action == GLFW_PRESS);
  }

  static void on_pointer(GLFWwindow* window, double x, double y) {
    Implementation& self = of(window);
    const glm::dvec2 now{x, y};
    if (self.input.looking) self.input.look_px += now - self.pointer;
    self.pointer = now;
  }

  static void on_wheel(GLFWwindow* window, double, double steps) {
    of(window).input.wheel += steps;
  }
  static void on_resize(GLFWwindow* window, int, int) { of(window).input.resized = true; }

  // While looking, the pointer is hidden and the screen's edge does not stop it.
  void look(bool looking) {
    if (looking == input.looking) return;
    input.looking = looking;
    glfwSetInputMode(window, GLFW_CURSOR, looking ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    glfwGetCursorPos(window, &pointer.x, &pointer.y);  // changing the mode is not a movement
  }
};

core::Result<std::unique_ptr<Window>> Window::create(const WindowSettings& settings) {
  PSYGEN_ASSERT(settings.size.width > 0 && settings.size.height > 0, "a window without a size");
  if (glfwInit() != GLFW_TRUE) {
    return core::fail(core::ErrorCode::kNoDevice,
                      fmt::format("no window can be opened here: {}", glfw_error()));
  }
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // full screen survives a change of focus
  glfwWindowHint(GLFW_VISIBLE, settings.visible ? GLFW_TRUE : GLFW_FALSE);
  GLFWwindow* window = glfwCreateWindow(static_cast<int>(settings.size.width),
                                        static_cast<int>(settings.size.height),
                                        settings.title.c_str(), nullptr, nullptr);
  if (window == nullptr) {
    const std::string reason = glfw_error();
    if (window_count() == 0) glfwTerminate();
    return core::fail(core::ErrorCode::kNoDevice,
                      fmt::format("no window can be opened here: {}", reason));
  }
  return std::unique_ptr<Window>(new Window(std::make_unique<Implementation>(window)));
}

Window::Window(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

Window::~Window() = default;

std::vector<std::string> Window::required_instance_extensions() const {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return names == nullptr ? std::vector<std::string>()
                          : std::vector<std::string>(names, names + count);
}

core::Result<std::uint64_t> Window::create_surface(void* instance) {
  std::uint64_t surface = 0;
  const int result = glfwCreateWindowSurface(instance, implementation_->window, nullptr, &surface);
  if (result == 0) return surface;
  return core::fail(
      core::ErrorCode::kNoDevice,
      fmt::format("the window has no Vulkan surface (VkResult {}): {}", result, glfw_error()));
}

core::Extent Window::framebuffer_size() const {
  if (minimised()) return {};
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(implementation_->window, &width, &height);
  return {static_cast<std::uint32_t>(std::max(width, 0)),
          static_cast<std::uint32_t>(std::max(height, 0))};
}

InputState Window::poll() {
  glfwPollEvents();
  InputState& input = implementation_->input;
  const InputState result = input;
  input.went_down.reset();
  input.look_px = {};
  input.wheel = 0;
  input.resized = false;
  return result;
}

void Window::keep_alive() {
  glfwPollEvents();
}

void Window::wait_events(double timeout_s) {
  if (std::isfinite(timeout_s) && timeout_s > 0) glfwWaitEventsTimeout(timeout_s);
}

bool Window::should_close() const {
  return glfwWindowShouldClose(implementation_->window) == GLFW_TRUE;
}

void Window::request_close() {
  glfwSetWindowShouldClose(implementation_->window, GLFW_TRUE);
}

bool Window::minimised() const {
  return glfwGetWindowAttrib(implementation_->window, GLFW_ICONIFIED) == GLFW_TRUE;
}

core::Result<void> Window::set_fullscreen(bool fullscreen) {
  if (fullscreen == this->fullscreen()) return {};
  GLFWwindow* const window = implementation_->window;
  Rectangle& place = implementation_->windowed;
  if (!fullscreen) {
    glfwSetWindowMonitor(window, nullptr, place.x, place.y, place.width, place.height, 0);
    return {};
  }
  Rectangle now;
  glfwGetWindowPos(window, &now.x, &now.y);
  glfwGetWindowSize(window, &now.width, &now.height);
  GLFWmonitor* const monitor = monitor_of(now);
  if (monitor == nullptr) {
    return core::fail(core::ErrorCode::kNoDevice,
                      fmt::format("there is no monitor to fill: {}", glfw_error()));
  }
  place = now;
  const GLFWvidmode* const mode = glfwGetVideoMode(monitor);
  glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  return {};
}

bool Window::fullscreen() const {
  return glfwGetWindowMonitor(implementation_->window) != nullptr;
}

float Window::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(implementation_->window, &x, &y);
  return std::isfinite(y) && y > 0 ? y : 1.0F;
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(implementation_->window, title.c_str());
}

void Window::set_size(core::Extent size) {
  PSYGEN_ASSERT(size.width > 0 && size.height > 0, "a window without a size");
  glfwSetWindowSize(implementation_->window, static_cast<int>(size.width),
                    static_cast<int>(size.height));
}

void Window::minimise() {
  glfwIconifyWindow(implementation_->window);
}

void Window::restore() {
  glfwRestoreWindow(implementation_->window);
}

}  // namespace psygen::platform
