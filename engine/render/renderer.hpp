// The renderer: draws lists of meshes that lie in its geometry memory, into a window or headless,
// with Vulkan 1.3. It knows nothing of entities, models or synthesis. Of the lists it leaves out
// only what cannot be seen, and takes other levels only where they offer some (FrameInput::choose).
// Main thread; two frames are in flight. The paper's Renderer (section 4).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

class RendererImpl;

class Renderer {
 public:
  // Fails with kNoDevice (no loader, no device, unknown name: the sentence lists the names there
  // are; or that has no GPU path where that is demanded), kOutOfMemory, kInvalidArgument, or
  // kInterrupted. All pipelines exist afterwards, and those of the landscape have drawn once.
  static core::Result<std::unique_ptr<Renderer>> create(const RendererOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Where meshes are written, mapped or to be copied (Upload). Lives as long as the renderer.
  core::GeometryMemory& geometry();

  // Keeps an index list that many meshes use; the name that draws give. Fails with kOutOfMemory
  // when the 4 MiB for such lists (outside the geometry budget) are full. Kept for good.
  core::Result<std::uint32_t> upload_shared_indices(std::span<const std::uint16_t> indices);

  // Draws and submits one frame. Waits at most for the frame before the last. Not presented (and
  // no work done) while the window is minimised. An invalid camera keeps the last valid one.
  // Fails with kDeviceLost, and with kOutOfMemory when a draw list cannot be held.
  core::Result<FrameResult> render(const FrameInput& input);

  // A picture that is nothing but text, for when there is no scene to be drawn yet; waits until it
  // is there. Nothing is shown while the window is minimised. Fails as render() does.
  core::Result<void> show(std::span<const TextPanel> panels, float text_scale = 1);

  // Makes everything anew that depends on the preset, and waits for it: seconds where the driver
  // has not kept it from before. Meshes stay. There is no picture to capture until the next frame.
  // Where it fails (kOutOfMemory, kDeviceLost; kInterrupted by `progress`, in which only show() may
  // be called) the old preset stays.
  core::Result<void> set_preset(Preset preset, const Progress& progress = {});
  Preset preset() const;  // the one in use

  // The last frame's picture; waits for it. Fails with kInvalidArgument before the first frame.
  core::Result<Picture> capture();

  // A new size of the picture; with a surface, a hint that the window changed. 0 × 0: minimised.
  core::Result<void> resize(core::Extent size);
  core::Extent size() const;

  const DeviceInfo& device() const;

  // What validation has said so far; empty without `validation`.
  std::vector<std::string> validation_messages() const;

  // The floor: median wall time in ms of drawing the last frame's lists again, one at a time, with
  // nothing else running. No range of that frame may have been released since. `repeats` >= 1.
  core::Result<double> replay_floor_ms(int repeats);

  // The meshes that the last frame drew, in any order; waits for it. For tests and views. Fails
  // with kInvalidArgument before the first frame.
  core::Result<std::vector<DrawnMesh>> drawn_meshes();

  // What RendererOptions::path has come to: kCpu or kGpu.
  RenderPath path() const;
  // Whether what is drawn casts shadows into cascades: then draws out of the picture matter too.
  bool casts_shadows() const;

  // Returns when the device has finished everything; released ranges are free afterwards.
  void wait_idle();

 private:
  explicit Renderer(std::unique_ptr<RendererImpl> impl);
  static void leave(std::unique_ptr<RendererImpl> impl);
  std::unique_ptr<RendererImpl> impl_;
};

// The devices that could be used, best first. Fails with kNoDevice when there are none.
core::Result<std::vector<DeviceInfo>> list_devices();

}  // namespace psygen::render
