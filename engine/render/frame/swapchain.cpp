#include "engine/render/frame/swapchain.hpp"

#include <algorithm>
#include <array>

namespace psygen::render {

using core::ErrorCode;
using core::Result;

namespace {

constexpr std::uint64_t kAcquireTimeoutNs = 1'000'000'000;

// Formats of the surface that store the picture's bytes unchanged, best first.
constexpr std::array kSurfaceFormats{VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM,
                                     VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_SRGB};

Result<VkSurfaceFormatKHR> choose_format(const Device& device, const UniqueSurface& surface) {
  const auto offered = all_of<VkSurfaceFormatKHR>([&](auto* count, auto* out) {
    return surface.functions().formats(device.physical, surface.get(), count, out);
  });
  for (const VkFormat wanted : kSurfaceFormats) {
    for (const VkSurfaceFormatKHR& format : offered) {
      if (format.format == wanted) return format;
    }
  }
  return core::fail(ErrorCode::kNoDevice, "the window system offers no picture of 8 bits a colour");
}

VkPresentModeKHR choose_mode(const Device& device, const UniqueSurface& surface, bool vsync) {
  if (vsync) return VK_PRESENT_MODE_FIFO_KHR;
  const auto modes = all_of<VkPresentModeKHR>([&](auto* count, auto* out) {
    return surface.functions().present_modes(device.physical, surface.get(), count, out);
  });
  for (const VkPresentModeKHR wanted :
       {VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR}) {
    if (std::find(modes.begin(), modes.end(), wanted) != modes.end()) return wanted;
  }
  return VK_PRESENT_MODE_FIFO_KHR;
}

VkSwapchainCreateInfoKHR swapchain_info(const VkSurfaceCapabilitiesKHR& able, VkSurfaceKHR surface,
                                        VkSurfaceFormatKHR format, core::Extent extent) {
  VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                .surface = surface,
                                .minImageCount = able.minImageCount + 1};
  if (able.maxImageCount != 0)
    info.minImageCount = std::min(info.minImageCount, able.maxImageCount);
  info.imageFormat = format.format;
  info.imageColorSpace = format.colorSpace;
  info.imageExtent = {extent.width, extent.height};
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = able.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  if ((able.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) == 0) {
    info.compositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  }
  info.clipped = VK_TRUE;
  return info;
}

core::Extent extent_of(const VkSurfaceCapabilitiesKHR& able, core::Extent wished) {
  if (able.currentExtent.width != UINT32_MAX) {
    return {able.currentExtent.width, able.currentExtent.height};
  }
  return {std::clamp(wished.width, able.minImageExtent.width, able.maxImageExtent.width),
          std::clamp(wished.height, able.minImageExtent.height, able.maxImageExtent.height)};
}

Result<SwapchainState> state_after(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return SwapchainState::kReady;
  if (result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR)
    return SwapchainState::kStale;
  if (result == VK_ERROR_SURFACE_LOST_KHR) return SwapchainState::kSurfaceLost;
  return vulkan_failure(result, what);
}

}  // namespace

Result<UniqueSurface> make_surface(const Instance& instance, core::SurfaceProvider& provider) {
  const Result<std::uint64_t> made = provider.create_surface(instance.get());
  if (!made) return tl::unexpected(made.error());
  return UniqueSurface(instance, reinterpret_cast<VkSurfaceKHR>(*made));
}

Result<VkFormat> colour_format_for(const Device& device, const UniqueSurface& surface) {
  const Result<VkSurfaceFormatKHR> format = choose_format(device, surface);
  if (!format) return tl::unexpected(format.error());
  const bool blue_first =
      format->format == VK_FORMAT_B8G8R8A8_UNORM || format->format == VK_FORMAT_B8G8R8A8_SRGB;
  return blue_first ? VK_FORMAT_B8G8R8A8_UNORM : VK_FORMAT_R8G8B8A8_UNORM;
}

Result<SwapchainState> Swapchain::create(const Device& device, const UniqueSurface& surface,
                                         core::Extent size, bool vsync) {
  VkSurfaceCapabilitiesKHR able{};
  VkResult result = surface.functions().capabilities(device.physical, surface.get(), &able);
  if (result == VK_ERROR_SURFACE_LOST_KHR) return SwapchainState::kSurfaceLost;
  if (result != VK_SUCCESS) return vulkan_failure(result, "asking for the window's abilities");
  const core::Extent extent = extent_of(able, size);
  if (extent.width == 0 || extent.height == 0) {
    destroy();
    return SwapchainState::kNotNow;
  }
  const Result<VkSurfaceFormatKHR> format = choose_format(device, surface);
  if (!format) return tl::unexpected(format.error());
  if ((able.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0) {
    return core::fail(ErrorCode::kNoDevice, "pictures cannot be copied into this window");
  }
  VkSwapchainCreateInfoKHR info = swapchain_info(able, surface.get(), *format, extent);
  info.presentMode = choose_mode(device, surface, vsync);
  info.oldSwapchain = swapchain_.get();
  VkSwapchainKHR made = VK_NULL_HANDLE;
  result = device.vk.vkCreateSwapchainKHR(device.handle, &info, nullptr, &made);
  if (result == VK_ERROR_SURFACE_LOST_KHR) return SwapchainState::kSurfaceLost;
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a swapchain");
  destroy();
  swapchain_ = UniqueSwapchain(device.vk, device.handle, made);
  extent_ = extent;

  images_ = all_of<VkImage>([&](auto* count, auto* out) {
    return device.vk.vkGetSwapchainImagesKHR(device.handle, made, count, out);
  });
  while (finished_.size() < images_.size()) {
    Result<UniqueSemaphore> semaphore = make_semaphore(device);
    if (!semaphore) return tl::unexpected(semaphore.error());
    finished_.push_back(std::move(*semaphore));
  }
  return SwapchainState::kReady;
}

void Swapchain::destroy() {
  swapchain_ = {};
  finished_.clear();
  images_.clear();
  extent_ = {};
}

Result<SwapchainState> Swapchain::acquire(const Device& device, VkSemaphore ready) {
  const VkResult result = device.vk.vkAcquireNextImageKHR(
      device.handle, swapchain_.get(), kAcquireTimeoutNs, ready, VK_NULL_HANDLE, &current_);
  if (result == VK_SUBOPTIMAL_KHR) return SwapchainState::kReady;
  if (result == VK_TIMEOUT || result == VK_NOT_READY) return SwapchainState::kNotNow;
  return state_after(result, "acquiring a picture of the window");
}

Result<SwapchainState> Swapchain::present(const Device& device) {
  const VkSemaphore wait = finished();
  const VkSwapchainKHR swapchain = swapchain_.get();
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &wait,
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain,
                              .pImageIndices = &current_};
  return state_after(device.present(info), "presenting a picture");
}

}  // namespace psygen::render
