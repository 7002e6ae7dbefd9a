#include "editor/view/window_surface.hpp"

#include <xcb/xcb.h>
// After the window system's header, before Qt's.
#define VK_USE_PLATFORM_WAYLAND_KHR
#define VK_USE_PLATFORM_XCB_KHR
#include <vulkan/vulkan.h>

#include <QGuiApplication>
#include <QWindow>
#include <bit>
#include <filesystem>
#include <string_view>
#ifdef PSYGEN_EDITOR_WAYLAND
#include <qpa/qplatformnativeinterface.h>
#endif

namespace psygen::editor {
namespace {

// The value of a variable of the environment; empty if it is not set.
std::string variable(const char* name) {
  return qgetenv(name).toStdString();
}

// True if this build can draw into windows of Wayland and the compositor's socket exists.
bool has_compositor() {
#ifndef PSYGEN_EDITOR_WAYLAND
  return false;
#endif
  const std::string name = variable("WAYLAND_DISPLAY");
  if (name.empty()) return false;
  std::error_code ignored;
  return std::filesystem::is_socket(std::filesystem::path(variable("XDG_RUNTIME_DIR")) / name,
                                    ignored);
}

// Null if the X server cannot be reached.
std::shared_ptr<xcb_connection_t> connect_to_x11(const char* display) {
  std::shared_ptr<xcb_connection_t> connection(xcb_connect(display, nullptr), &xcb_disconnect);
  return xcb_connection_has_error(connection.get()) == 0 ? connection : nullptr;
}

// `display`: an X11 display that the arguments name, or null.
core::Error no_display(bool may_use_x11, const char* display) {
  std::string name = display == nullptr ? variable("DISPLAY") : display;
  if (name.empty() || !may_use_x11) name = variable("WAYLAND_DISPLAY");
  std::string message = "the editor needs a display of Wayland or X11, and ";
  if (!name.empty()) {
    message += '"' + name + "\" cannot be opened";
  } else {
    message +=
        may_use_x11 ? "neither WAYLAND_DISPLAY nor DISPLAY is set" : "WAYLAND_DISPLAY is not set";
  }
  return {core::ErrorCode::kNoDevice, message};
}

// Creates a surface with a function of the driver's instance.
template <typename Create, typename Info>
core::Result<std::uint64_t> create_with(const char* function, VkInstance vulkan, const Info& info,
                                        const char* windows) {
  const auto create = reinterpret_cast<Create>(vkGetInstanceProcAddr(vulkan, function));
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (create == nullptr || create(vulkan, &info, nullptr, &surface) != VK_SUCCESS)
    return core::fail(core::ErrorCode::kNoDevice,
                      std::string("the driver cannot create a surface for windows of ") + windows);
  return std::bit_cast<std::uint64_t>(surface);
}

// Only Qt's private interface has the objects of Wayland.
core::Result<std::uint64_t> create_on_wayland([[maybe_unused]] VkInstance vulkan,
                                              [[maybe_unused]] QWindow& window) {
#ifdef PSYGEN_EDITOR_WAYLAND
  QPlatformNativeInterface& native = *QGuiApplication::platformNativeInterface();
  VkWaylandSurfaceCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_WAYLAND_SURFACE_CREATE_INFO_KHR;
  info.display = static_cast<wl_display*>(native.nativeResourceForIntegration("wl_display"));
  info.surface = static_cast<wl_surface*>(native.nativeResourceForWindow("surface", &window));
  if (info.display == nullptr || info.surface == nullptr)
    return core::fail(core::ErrorCode::kNoDevice, "the view has no surface while it is hidden");
  return create_with<PFN_vkCreateWaylandSurfaceKHR>("vkCreateWaylandSurfaceKHR", vulkan, info,
                                                    "Wayland");
#else
  return core::fail(core::ErrorCode::kNoDevice,
                    "this editor is built for X11 only; start it with -platform xcb");
#endif
}

}  // namespace

bool runs_on_wayland() {
  return QGuiApplication::platformName().startsWith("wayland");
}

core::Result<std::shared_ptr<void>> require_display(std::span<const char* const> arguments) {
  if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM"))
    qputenv("QT_QPA_PLATFORM", has_compositor() ? "wayland;xcb" : "xcb");
  const std::string chosen = variable("QT_QPA_PLATFORM");
  std::string_view platform = chosen;
  const char* display = nullptr;  // $DISPLAY
  for (std::size_t i = 1; i + 1 < arguments.size(); ++i) {
    const std::string_view option = arguments[i];
    if (option == "-platform" || option == "--platform") platform = arguments[i + 1];
    if (option == "-display" || option == "--display") display = arguments[i + 1];
  }
  if (!platform.starts_with("xcb") && !platform.starts_with("wayland"))
    return core::fail(core::ErrorCode::kNoDevice,
                      "the editor needs Wayland or X11, and the chosen Qt platform is \"" +
                          std::string(platform) + "\"; unset QT_QPA_PLATFORM");
  // Qt tries the platforms of a list in turn.
  const auto may_use = [&](std::string_view name) { return platform.find(name) != platform.npos; };
  if (platform.starts_with("wayland") && has_compositor()) return nullptr;
  const bool may_use_x11 = may_use("xcb");
  if (const auto connection = may_use_x11 ? connect_to_x11(display) : nullptr) return connection;
  if (may_use("wayland") && has_compositor()) return nullptr;
  return tl::unexpected(no_display(may_use_x11, display));
}

std::vector<std::string> WindowSurface::required_instance_extensions() const {
  return {VK_KHR_SURFACE_EXTENSION_NAME, runs_on_wayland() ? VK_KHR_WAYLAND_SURFACE_EXTENSION_NAME
                                                           : VK_KHR_XCB_SURFACE_EXTENSION_NAME};
}

core::Result<std::uint64_t> WindowSurface::create_surface(void* instance) {
  const auto vulkan = static_cast<VkInstance>(instance);
  if (runs_on_wayland()) return create_on_wayland(vulkan, window_);
  const auto* x11 = qGuiApp->nativeInterface<QNativeInterface::QX11Application>();
  if (x11 == nullptr || x11->connection() == nullptr)
    return core::fail(core::ErrorCode::kNoDevice,
                      "the editor needs Wayland or X11; start it with -platform xcb");
  VkXcbSurfaceCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_XCB_SURFACE_CREATE_INFO_KHR;
  info.connection = x11->connection();
  info.window = static_cast<xcb_window_t>(window_.winId());
  return create_with<PFN_vkCreateXcbSurfaceKHR>("vkCreateXcbSurfaceKHR", vulkan, info, "X11");
}

core::Extent WindowSurface::framebuffer_size() const {
  if (!window_.isExposed()) return {};
  const QSize size = window_.size() * window_.devicePixelRatio();
  return {static_cast<std::uint32_t>(size.width()), static_cast<std::uint32_t>(size.height())};
}

}  // namespace psygen::editor
