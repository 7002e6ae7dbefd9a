#include "engine/platform/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <langinfo.h>

#include <algorithm>
#include <cerrno>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>
#include <utility>

#include "engine/core/assert.hpp"
#include "engine/core/utf8.hpp"

// GLFW declares it like this if vulkan.h is included; the handles are pointers on every 64-bit
// platform.
extern "C" int glfwCreateWindowSurface(void* instance, GLFWwindow* window, const void* allocator,
                                       std::uint64_t* surface);

namespace psygen::platform {
namespace {

static_assert(sizeof(void*) == 8, "Vulkan surfaces are pointers only on 64-bit platforms");

// GLFW is initialised once per process and does not count its users.
int& window_count() {
  static int count = 0;
  return count;
}

// GLFW converts text to the locale's encoding, and would lose characters that it lacks. Like GLFW
// itself, this sets only the character type, never the number format.
void use_unicode() {
  if (std::strcmp(std::setlocale(LC_CTYPE, nullptr), "C") == 0) std::setlocale(LC_CTYPE, "");
  if (std::strcmp(nl_langinfo(CODESET), "UTF-8") != 0) std::setlocale(LC_CTYPE, "C.UTF-8");
}

std::string glfw_error() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description != nullptr ? description : "the window system gave no reason";
}

// Desktops find the desktop file, and so name and icon, of a window by the name of its program.
void name_next_window_after_program() {
  glfwWindowHintString(GLFW_X11_CLASS_NAME, program_invocation_short_name);
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, program_invocation_short_name);
#ifdef GLFW_WAYLAND_APP_ID  // since GLFW 3.4
  glfwWindowHintString(GLFW_WAYLAND_APP_ID, program_invocation_short_name);
#endif
}

// Keys of GLFW and ours, without ranges (key_of).
// clang-format off
constexpr std::pair<int, Key> kOtherKeys[] = {
    {GLFW_KEY_UP, Key::kUp}, {GLFW_KEY_DOWN, Key::kDown}, {GLFW_KEY_LEFT, Key::kLeft},
    {GLFW_KEY_RIGHT, Key::kRight}, {GLFW_KEY_PAGE_UP, Key::kPageUp},
    {GLFW_KEY_PAGE_DOWN, Key::kPageDown}, {GLFW_KEY_HOME, Key::kHome}, {GLFW_KEY_END, Key::kEnd},
    {GLFW_KEY_INSERT, Key::kInsert}, {GLFW_KEY_DELETE, Key::kDelete},
    {GLFW_KEY_LEFT_SHIFT, Key::kLeftShift}, {GLFW_KEY_RIGHT_SHIFT, Key::kRightShift},
    {GLFW_KEY_LEFT_CONTROL, Key::kLeftControl}, {GLFW_KEY_RIGHT_CONTROL, Key::kRightControl},
    {GLFW_KEY_LEFT_ALT, Key::kLeftAlt}, {GLFW_KEY_RIGHT_ALT, Key::kRightAlt},
    {GLFW_KEY_LEFT_SUPER, Key::kLeftSuper}, {GLFW_KEY_RIGHT_SUPER, Key::kRightSuper},
    {GLFW_KEY_MENU, Key::kMenu}, {GLFW_KEY_SPACE, Key::kSpace}, {GLFW_KEY_TAB, Key::kTab},
    {GLFW_KEY_ENTER, Key::kEnter}, {GLFW_KEY_ESCAPE, Key::kEscape},
    {GLFW_KEY_BACKSPACE, Key::kBackspace}, {GLFW_KEY_APOSTROPHE, Key::kApostrophe},
    {GLFW_KEY_COMMA, Key::kComma}, {GLFW_KEY_MINUS, Key::kMinus}, {GLFW_KEY_PERIOD, Key::kPeriod},
    {GLFW_KEY_SLASH, Key::kSlash}, {GLFW_KEY_SEMICOLON, Key::kSemicolon},
    {GLFW_KEY_EQUAL, Key::kEqual}, {GLFW_KEY_LEFT_BRACKET, Key::kLeftBracket},
    {GLFW_KEY_BACKSLASH, Key::kBackslash}, {GLFW_KEY_RIGHT_BRACKET, Key::kRightBracket},
    {GLFW_KEY_GRAVE_ACCENT, Key::kGrave}, {GLFW_KEY_WORLD_1, Key::kWorld1},
    {GLFW_KEY_WORLD_2, Key::kWorld2}, {GLFW_KEY_CAPS_LOCK, Key::kCapsLock},
    {GLFW_KEY_SCROLL_LOCK, Key::kScrollLock}, {GLFW_KEY_NUM_LOCK, Key::kNumLock},
    {GLFW_KEY_PRINT_SCREEN, Key::kPrintScreen}, {GLFW_KEY_PAUSE, Key::kPause},
};
// Ranges whose keys have the same order in both.
struct KeyRange { int first, last; Key key; };
constexpr KeyRange kKeyRanges[] = {
    {GLFW_KEY_A, GLFW_KEY_Z, Key::kA}, {GLFW_KEY_0, GLFW_KEY_9, Key::k0},
    {GLFW_KEY_F1, GLFW_KEY_F25, Key::kF1}, {GLFW_KEY_KP_0, GLFW_KEY_KP_EQUAL, Key::kKeypad0},
};
// clang-format on

std::optional<Key> key_of(int glfw_key) {
  for (const KeyRange& range : kKeyRanges) {
    if (glfw_key >= range.first && glfw_key <= range.last)
      return static_cast<Key>(static_cast<int>(range.key) + glfw_key - range.first);
  }
  const auto found = std::ranges::find(kOtherKeys, glfw_key, &std::pair<int, Key>::first);
  return found == std::end(kOtherKeys) ? std::nullopt : std::optional(found->second);
}

// GLFW's number of a key; GLFW_KEY_UNKNOWN for keys that stand for two.
int glfw_key_of(Key key) {
  for (int number = GLFW_KEY_SPACE; number <= GLFW_KEY_LAST; ++number) {
    if (key_of(number) == key) return number;
  }
  return GLFW_KEY_UNKNOWN;
}

// Updates a key that is down while either of two keys is, with the events of one of them.
void set_key(InputState& input, Key key, bool down) {
  const auto bit = static_cast<std::size_t>(key);
  if (input.held[bit] == down) return;
  input.held.set(bit, down);
  (down ? input.went_down : input.went_up).set(bit);
}

void set_pair(InputState& input, Key both, Key left, Key right) {
  set_key(input, both, input.is_held(left) || input.is_held(right));
}

std::optional<PadReading> read_pad(std::size_t slot) {
  static_assert(kGamepads == GLFW_JOYSTICK_LAST + 1 &&
                kPadButtons == GLFW_GAMEPAD_BUTTON_LAST + 1 &&
                kPadAxes == GLFW_GAMEPAD_AXIS_LAST + 1);
  GLFWgamepadstate state{};
  if (glfwGetGamepadState(static_cast<int>(slot), &state) != GLFW_TRUE) return std::nullopt;
  PadReading reading;
  for (std::size_t i = 0; i < kPadButtons; ++i)
    reading.buttons.set(i, state.buttons[i] == GLFW_PRESS);
  for (std::size_t i = 0; i < kPadAxes; ++i)
    reading.axes[i] = state.axes[i];
  // GLFW's sticks are positive downwards, and its triggers rest at −1.
  for (const PadAxis y : {PadAxis::kLeftY, PadAxis::kRightY})
    reading.axes[static_cast<std::size_t>(y)] *= -1;
  for (const PadAxis trigger : {PadAxis::kLeftTrigger, PadAxis::kRightTrigger}) {
    float& value = reading.axes[static_cast<std::size_t>(trigger)];
    value = (value + 1) / 2;
  }
  return reading;
}

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

std::int64_t common_area(const Rectangle& a, const Rectangle& b) {
  const int width = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
  const int height = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
  return std::int64_t{std::max(width, 0)} * std::max(height, 0);
}

// The monitor that shows the largest part of a rectangle, or the first one if none does; null
// without monitors.
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
  Rectangle windowed;       // its position before it covered a monitor
  InputState input;         // collected since the last poll
  glm::dvec2 pointer{0.0};  // last reported position; leaves the window while looking
  bool right_looks = true;
  bool background_gamepads = false;

  explicit Implementation(GLFWwindow* created) : window(created) {
    ++window_count();
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, &Implementation::on_key);
    glfwSetCharCallback(window, &Implementation::on_text);
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
    if (!known) return;
    InputState& input = of(window).input;
    if (action == GLFW_REPEAT) {
      input.repeated.set(static_cast<std::size_t>(*known));
      return;
    }
    set_key(input, *known, action == GLFW_PRESS);
    set_pair(input, Key::kShift, Key::kLeftShift, Key::kRightShift);
    set_pair(input, Key::kControl, Key::kLeftControl, Key::kRightControl);
    set_pair(input, Key::kAlt, Key::kLeftAlt, Key::kRightAlt);
  }

  static void on_text(GLFWwindow* window, unsigned int character) {
    std::string& text = of(window).input.text;
    constexpr std::size_t kLongest = 4;  // bytes of a character
    if (text.size() + kLongest <= InputState::kMaxTextBytes)
      core::append_utf8(text, static_cast<char32_t>(character));
  }

  static void on_button(GLFWwindow* window, int button, int action, int) {
    if (button < 0 || static_cast<std::size_t>(button) >= kMouseButtons) return;
    Implementation& self = of(window);
    const auto bit = static_cast<std::size_t>(button);
    self.input.buttons_held.set(bit, action == GLFW_PRESS);
    (action == GLFW_PRESS ? self.input.buttons_went_down : self.input.buttons_went_up).set(bit);
    self.update_cursor();
  }

  static void on_pointer(GLFWwindow* window, double x, double y) {
    Implementation& self = of(window);
    const glm::dvec2 now{x, y};
    self.input.move_px += now - self.pointer;
    if (self.input.looking) self.input.look_px += now - self.pointer;
    self.pointer = now;
  }

  static void on_wheel(GLFWwindow* window, double steps_x, double steps) {
    of(window).input.wheel += steps;
    of(window).input.wheel_x += steps_x;
  }
  static void on_resize(GLFWwindow* window, int, int) { of(window).input.resized = true; }

  // While looking, the pointer is hidden and can move beyond the screen's edge.
  void update_cursor() {
    const bool looking = input.captured || (right_looks && input.is_held(MouseButton::kRight));
    if (looking == input.looking) return;
    input.looking = looking;
    glfwSetInputMode(window, GLFW_CURSOR, looking ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    glfwGetCursorPos(window, &pointer.x, &pointer.y);  // changing the mode is not a movement
  }

  // Screen coordinates → pixels of the image.
  glm::dvec2 pointer_px() const {
    int width = 0, height = 0, wide = 0, high = 0;
    glfwGetWindowSize(window, &width, &height);
    glfwGetFramebufferSize(window, &wide, &high);
    if (width <= 0 || height <= 0) return {};
    return pointer * (glm::dvec2(wide, high) / glm::dvec2(width, height));
  }
};

core::Result<std::unique_ptr<Window>> Window::create(const WindowSettings& settings) {
  PSYGEN_ASSERT(settings.size.width > 0 && settings.size.height > 0,
                "the size of a window must be positive");
  if (window_count() == 0) use_unicode();
  if (glfwInit() != GLFW_TRUE) {
    return core::fail(core::ErrorCode::kNoDevice,
                      fmt::format("no window can be opened here: {}", glfw_error()));
  }
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // full screen survives a change of focus
  glfwWindowHint(GLFW_VISIBLE, settings.visible ? GLFW_TRUE : GLFW_FALSE);
  name_next_window_after_program();
  GLFWwindow* window = glfwCreateWindow(static_cast<int>(settings.size.width),
                                        static_cast<int>(settings.size.height),
                                        settings.title.c_str(), nullptr, nullptr);
  if (window == nullptr) {
    const std::string reason = glfw_error();
    if (window_count() == 0) glfwTerminate();
    return core::fail(core::ErrorCode::kNoDevice,
                      fmt::format("no window can be opened here: {}", reason));
  }
  if (const char* mappings = std::getenv("SDL_GAMECONTROLLERCONFIG"))
    (void)add_gamepad_mappings(mappings);
  std::unique_ptr<Window> made(new Window(std::make_unique<Implementation>(window)));
  made->set_raw_mouse_motion(true);
  return made;
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
  input.pointer_px = implementation_->pointer_px();
  input.focused = glfwGetWindowAttrib(implementation_->window, GLFW_FOCUSED) == GLFW_TRUE;
  const bool listens = input.focused || implementation_->background_gamepads;
  const auto read = [&](std::size_t slot) {
    auto reading = read_pad(slot);
    if (reading && !listens) *reading = {};
    return reading;
  };
  update_gamepads(read, input.pads);
  InputState result = input;
  clear_changes(input);
  return result;
}

void Window::capture_cursor(bool captured) {
  implementation_->input.captured = captured;
  implementation_->update_cursor();
}

bool Window::cursor_captured() const {
  return implementation_->input.captured;
}

void Window::set_background_gamepads(bool listens) {
  implementation_->background_gamepads = listens;
}

void Window::set_raw_mouse_motion(bool raw) {
  if (glfwRawMouseMotionSupported() == GLFW_TRUE)
    glfwSetInputMode(implementation_->window, GLFW_RAW_MOUSE_MOTION, raw ? GLFW_TRUE : GLFW_FALSE);
}

bool Window::add_gamepad_mappings(const std::string& text) {
  return glfwUpdateGamepadMappings(text.c_str()) == GLFW_TRUE;
}

void Window::set_right_button_looks(bool looks) {
  implementation_->right_looks = looks;
  implementation_->update_cursor();
}

std::string Window::label_of(Key key) const {
  const int number = glfw_key_of(key);
  const char* const label = number == GLFW_KEY_UNKNOWN ? nullptr : glfwGetKeyName(number, 0);
  if (label == nullptr || *label == 0) return std::string(name_of(key));
  std::string shown(label);
  if (shown.size() == 1 && shown[0] >= 'a' && shown[0] <= 'z')
    shown[0] = static_cast<char>(shown[0] - 'a' + 'A');
  return shown;
}

std::string Window::gamepad_name(std::size_t slot) const {
  const char* const name = slot < kGamepads ? glfwGetGamepadName(static_cast<int>(slot)) : nullptr;
  return name == nullptr ? "" : name;
}

std::string Window::clipboard() const {
  const char* const text = glfwGetClipboardString(implementation_->window);
  (void)glfwGetError(nullptr);  // an empty clipboard is no error
  return text == nullptr ? "" : text;
}

void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(implementation_->window, text.c_str());
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

void Window::cancel_close() {
  glfwSetWindowShouldClose(implementation_->window, GLFW_FALSE);
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
                      fmt::format("there is no monitor for full screen: {}", glfw_error()));
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
  PSYGEN_ASSERT(size.width > 0 && size.height > 0, "the size of a window must be positive");
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
