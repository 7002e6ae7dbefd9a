#include "editor/view/window_surface.hpp"

#include <xcb/xcb.h>
// After the window system's header, before Qt's.
#define VK_USE_PLATFORM_XCB_KHR
#include <vulkan/vulkan.h>

#include <QGuiApplication>
#include <QWindow>
#include <bit>
#include <cstdlib>
#include <string_view>

namespace psygen::editor {

core::Result<std::shared_ptr<void>> require_x11(std::span<const char* const> arguments) {
  if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "xcb");
  std::string_view platform = std::getenv("QT_QPA_PLATFORM");
  const char* display = nullptr;  // $DISPLAY
  for (std::size_t i = 1; i + 1 < arguments.size(); ++i) {
    const std::string_view option = arguments[i];
    if (option == "-platform" || option == "--platform") platform = arguments[i + 1];
    if (option == "-display" || option == "--display") display = arguments[i + 1];
  }
  if (!platform.starts_with("xcb"))
    return core::fail(core::ErrorCode::kNoDevice,
                      "the editor needs X11, and the chosen Qt platform is \"" +
                          std::string(platform) + "\"; unset QT_QPA_PLATFORM");
  const std::shared_ptr<xcb_connection_t> connection(xcb_connect(display, nullptr),
                                                     &xcb_disconnect);
  if (xcb_connection_has_error(connection.get()) == 0) return connection;
  if (display == nullptr) display = std::getenv("DISPLAY");
  return core::fail(core::ErrorCode::kNoDevice,
                    display == nullptr ? "the editor needs an X11 display, and DISPLAY is not set"
                                       : "the editor needs an X11 display, and \"" +
                                             std::string(display) + "\" cannot be opened");
}

std::vector<std::string> WindowSurface::required_instance_extensions() const {
  return {VK_KHR_SURFACE_EXTENSION_NAME, VK_KHR_XCB_SURFACE_EXTENSION_NAME};
}

core::Result<std::uint64_t> WindowSurface::create_surface(void* instance) {
  const auto* x11 = qGuiApp->nativeInterface<QNativeInterface::QX11Application>();
  if (x11 == nullptr || x11->connection() == nullptr)
    return core::fail(core::ErrorCode::kNoDevice,
                      "the editor needs X11; start it with -platform xcb");
  const auto vulkan = static_cast<VkInstance>(instance);
  const auto create = reinterpret_cast<PFN_vkCreateXcbSurfaceKHR>(
      vkGetInstanceProcAddr(vulkan, "vkCreateXcbSurfaceKHR"));
  VkXcbSurfaceCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_XCB_SURFACE_CREATE_INFO_KHR;
  info.connection = x11->connection();
  info.window = static_cast<xcb_window_t>(window_.winId());
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (create == nullptr || create(vulkan, &info, nullptr, &surface) != VK_SUCCESS)
    return core::fail(core::ErrorCode::kNoDevice,
                      "the driver cannot create a surface for X11 windows");
  return std::bit_cast<std::uint64_t>(surface);
}

core::Extent WindowSurface::framebuffer_size() const {
  if (!window_.isExposed()) return {};
  const QSize size = window_.size() * window_.devicePixelRatio();
  return {static_cast<std::uint32_t>(size.width()), static_cast<std::uint32_t>(size.height())};
}

}  // namespace psygen::editor
