// Surface and swapchain of a window: creating, acquiring, presenting. The caller recreates them
// when the window changes or the surface is lost (renderer_window.cpp). Pictures are copied into
// the images, never drawn. Main thread. Private to engine/render.
#pragma once

#include <optional>
#include <vector>

#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// An owning handle of a surface. The instance must outlive it.
class UniqueSurface {
 public:
  // Empty, or the owner of `surface`. Move-only.
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
  // The handle, and the functions of its instance.
  VkSurfaceKHR get() const { return surface_; }
  const SurfaceFunctions& functions() const { return instance_->surface_functions(); }

 private:
  const Instance* instance_ = nullptr;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

// Creates the surface of a window. Fails with the provider's error.
core::Result<UniqueSurface> make_surface(const Instance& instance, core::SurfaceProvider& provider);

// The format of pictures that can be copied to the surface without conversion. Fails with kNoDevice
// if there is none.
core::Result<VkFormat> colour_format_for(const Device& device, const UniqueSurface& surface);

// The result of an operation: done; not possible now; the swapchain or the surface must be
// recreated.
enum class SwapchainState : std::uint8_t { kReady, kNotNow, kStale, kSurfaceLost };

// A swapchain, or none. The device must outlive it.
class Swapchain {
 public:
  // Creates the swapchain or replaces it; then the device must be idle. `size` is used if the
  // window system leaves the choice. Returns kNotNow, without a swapchain, if the surface has no
  // pixels (minimised).
  core::Result<SwapchainState> create(const Device& device, const UniqueSurface& surface,
                                      core::Extent size, bool vsync);
  // Destroys the swapchain, if any. True if it exists, and its size in pixels.
  void destroy();
  bool exists() const { return swapchain_.get() != VK_NULL_HANDLE; }
  core::Extent extent() const { return extent_; }

  // Acquires the next image. `ready` is signalled when it may be written. Waits up to a second,
  // then returns kNotNow.
  core::Result<SwapchainState> acquire(const Device& device, VkSemaphore ready);
  // The acquired image, and the semaphore that the frame signals when it has written it.
  VkImage image() const { return images_[current_]; }
  VkSemaphore finished() const { return finished_[current_].get(); }
  // Presents the acquired image when finished() is signalled.
  core::Result<SwapchainState> present(const Device& device);

 private:
  UniqueSwapchain swapchain_;
  core::Extent extent_;
  std::vector<VkImage> images_;
  std::vector<UniqueSemaphore> finished_;
  std::uint32_t current_ = 0;
};

}  // namespace psygen::render
