// The renderer's part for the window: creates and recreates the swapchain.
#include "engine/render/renderer_impl.hpp"

namespace psygen::render {

using core::Result;

// True if the last picture was shown, as far as is known.
Result<bool> RendererImpl::note_presented(const Result<SwapchainState>& shown) {
  if (!shown) return tl::unexpected(shown.error());
  if (*shown == SwapchainState::kStale) swapchain_stale_ = true;
  if (*shown != SwapchainState::kSurfaceLost) return true;
  if (Result<void> again = recreate_surface(); !again) return tl::unexpected(again.error());
  return false;
}

// Waits for the end of a present() that goes on in its thread.
Result<bool> RendererImpl::settle_present() {
  return presenting_.valid() ? note_presented(presenting_.get()) : Result<bool>(true);
}

// Presents the acquired image. On a software device that takes as long as drawing does, so that it
// is done beside the next tick. Where no thread can be had, settle_present() does it.
Result<bool> RendererImpl::present() {
  if (!device_->info.software()) return note_presented(swapchain_.present(*device_));
  presenting_ = std::async([this] { return swapchain_.present(*device_); });
  return true;
}

// True if there is a swapchain with targets of its size; false while the window has no pixels.
Result<bool> RendererImpl::prepare_window() {
  const core::Extent size = options_.surface->framebuffer_size();
  if (size.width == 0 || size.height == 0) return false;
  if (swapchain_.exists() && !swapchain_stale_ && size == seen_framebuffer_) return true;
  wait_idle();
  resized_ = true;
  Result<SwapchainState> made = swapchain_.create(*device_, surface_, size, options_.vsync);
  if (made && *made == SwapchainState::kSurfaceLost) {
    if (Result<void> again = recreate_surface(); !again) return tl::unexpected(again.error());
    made = swapchain_.create(*device_, surface_, size, options_.vsync);
  }
  if (!made) return tl::unexpected(made.error());
  if (*made != SwapchainState::kReady) return false;
  seen_framebuffer_ = size;
  swapchain_stale_ = false;
  if (this->size() == swapchain_.extent()) return true;
  if (Result<void> targets = create_targets(swapchain_.extent()); !targets) {
    swapchain_stale_ = true;
    return tl::unexpected(targets.error());
  }
  return true;
}

Result<void> RendererImpl::recreate_surface() {
  wait_idle();
  swapchain_.destroy();
  surface_ = {};
  return make_surface(*instance_, *options_.surface).map(into(surface_)).map([this] {
    swapchain_stale_ = true;
  });
}

// If the swapchain is stale, this frame is not shown, and the next one recreates it.
Result<RendererImpl::WindowState> RendererImpl::acquire_window(FrameSlot& slot) {
  const Result<SwapchainState> acquired = swapchain_.acquire(*device_, slot.acquired());
  if (!acquired) return tl::unexpected(acquired.error());
  switch (*acquired) {
    case SwapchainState::kReady:
      return WindowState::kReady;
    case SwapchainState::kNotNow:
      return WindowState::kNotNow;
    case SwapchainState::kStale:
      swapchain_stale_ = true;
      return WindowState::kNotNow;
    case SwapchainState::kSurfaceLost:
      break;
  }
  if (Result<void> again = recreate_surface(); !again) return tl::unexpected(again.error());
  return WindowState::kNotNow;
}

}  // namespace psygen::render
