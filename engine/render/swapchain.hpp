// Surface and swapchain of a window: acquired, presented, made again when the window changes or the
// surface is lost. Pictures are copied into it, never drawn. Private to engine/render.
#pragma once

#include <optional>
#include <vector>

#include "engine/render/memory.hpp"

namespace psygen::render {

class UniqueSurface {
 public:
  UniqueSurface() = default;
  UniqueSurface(const Instance& instance, VkSurfaceKHR surface)
      : instance_(&instance), surface_(surface) {}
  UniqueSurface(UniqueSurface&& other) noexcept
      : instance_(other.instance_), surface_(std::exchange(other.surface_, VK_NULL_HANDLE)) {}
  UniqueSurface& operator=(UniqueSurface&& other) noexcept {
    std::swap(instance_, other.instance_);
    std::swap(surface_, other.surface_);
    return *this;
  }
  ~UniqueSurface() {
    if (surface_ == VK_NULL_HANDLE) return;
    instance_->surface_functions().destroy(instance_->get(), surface_, nullptr);
  }
  VkSurfaceKHR get() const { return surface_; }
  const SurfaceFunctions& functions() const { return instance_->surface_functions(); }

 private:
  const Instance* instance_ = nullptr;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

core::Result<UniqueSurface> make_surface(const Instance& instance, core::SurfaceProvider& provider);

// The format that pictures are drawn in so that they can be copied to the surface as they are.
core::Result<VkFormat> colour_format_for(const Device& device, const UniqueSurface& surface);

enum class SwapchainState : std::uint8_t { kReady, kNotNow, kStale, kSurfaceLost };

class Swapchain {
 public:
  // The device must be idle when one is replaced. `size` is used where the window system leaves
  // the choice. kNotNow when the surface has no pixels (minimised); then there is no swapchain.
  core::Result<SwapchainState> create(const Device& device, const UniqueSurface& surface,
                                      core::Extent size, bool vsync);
  void destroy();
  bool exists() const { return swapchain_.get() != VK_NULL_HANDLE; }
  core::Extent extent() const { return extent_; }

  // The next image; `ready` is signalled when it may be written. Waits up to a second.
  core::Result<SwapchainState> acquire(const Device& device, VkSemaphore ready);
  VkImage image() const { return images_[current_]; }
  VkSemaphore finished() const { return finished_[current_].get(); }
  // Shows the acquired image once `finished()` is signalled.
  core::Result<SwapchainState> present(const Device& device);

 private:
  UniqueSwapchain swapchain_;
  core::Extent extent_;
  std::vector<VkImage> images_;
  std::vector<UniqueSemaphore> finished_;
  std::uint32_t current_ = 0;
};

core::Result<UniqueSemaphore> make_semaphore(const Device& device);

}  // namespace psygen::render
