#include "editor/view/window_surface.hpp"

#include <xcb/xcb.h>
// After the window system's header, before Qt's.
#define VK_USE_PLATFORM_XCB_KHR
#include <vulkan/vulkan.h>

#include <QGuiApplication>
#include <QWindow>
#include <bit>

namespace psygen::editor {

std::vector<std::string> WindowSurface::required_instance_extensions() const {
  return {VK_KHR_SURFACE_EXTENSION_NAME, VK_KHR_XCB_SURFACE_EXTENSION_NAME};
}

core::Result<std::uint64_t> WindowSurface::create_surface(void* instance) {
  const auto* x11 = qGuiApp->nativeInterface<QNativeInterface::QX11Application>();
  if (x11 == nullptr)
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
