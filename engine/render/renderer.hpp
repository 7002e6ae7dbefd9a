// The renderer: draws lists of meshes from its geometry memory, into a window or headless, with
// Vulkan 1.3. It knows nothing of entities, models or synthesis. It leaves out only meshes that are
// not visible, and chooses no levels of detail. Main thread; two frames are in flight. The paper's
// Renderer (section 4). docs/gpu.md.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/render/types.hpp"

struct ImFontAtlas;

namespace psygen::render {

// One device with its pictures. All functions are for the main thread.
class Renderer {
 public:
  // Creates a renderer with all pipelines; those of the landscape have drawn once. Fails with
  // kNoDevice (no loader, no device, a name that fits none or several, a device that lacks
  // something, or no GPU path although it is required; the message lists the devices),
  // kOutOfMemory, kInvalidArgument, or kInterrupted.
  static core::Result<std::unique_ptr<Renderer>> create(const RendererOptions& options);
  virtual ~Renderer() = default;
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // The memory for meshes, mapped or copied to the device (Upload). Lives as long as the renderer.
  virtual core::GeometryMemory& geometry() = 0;

  // Stores an index list that many meshes share and returns its id for draws. It is kept as long as
  // the renderer. Fails with kInvalidArgument for an empty list, and with kOutOfMemory when the
  // 4 MiB for such lists, outside the geometry budget, are full.
  virtual core::Result<std::uint32_t> upload_shared_indices(
      std::span<const std::uint16_t> indices) = 0;

  // Stores a texture for materials, with mip levels. It is kept as long as the renderer, and waited
  // for. Fails with kInvalidArgument for a size of 0, above 8192 or that does not match the bytes;
  // kOverBudget beyond RendererOptions::texture_budget_bytes; kOutOfMemory, kDeviceLost.
  virtual core::Result<TextureId> add_texture(const TexturePixels& pixels) = 0;
  // Stores a material of objects. It is kept as long as the renderer. Fails with kInvalidArgument
  // for numbers that are not finite or colours below 0, and for unknown textures; kOverBudget
  // beyond 4096 materials.
  virtual core::Result<MaterialId> add_material(const Material& material) = 0;
  // Creates the pipelines of a feature, if they do not exist. Otherwise the first frame that needs
  // them does. Takes up to a second. Fails with kOutOfMemory or kDeviceLost.
  virtual core::Result<void> prepare(Feature feature) = 0;
  // The pictures of models (MeshDraw::pictured), by number, for the scene that is drawn. Replaces
  // all. Waits for the device. Fails, and changes nothing, with kOverBudget for more than
  // core::kMaxImpostors or beyond the budget of textures; kInvalidArgument for other sizes than
  // core::impostor_bytes(); kOutOfMemory, kDeviceLost.
  virtual core::Result<void> set_model_pictures(
      std::span<const core::ImpostorTexture> pictures) = 0;
  // Replaces one of them. kInvalidArgument for one that does not exist.
  virtual core::Result<void> set_model_picture(std::size_t number,
                                               const core::ImpostorTexture& picture) = 0;
  // Bytes of all textures of materials and pictures.
  virtual std::uint64_t texture_bytes() const = 0;

  // Draws and submits one frame. Waits at most for the frame before the last. While the window is
  // minimised it does nothing and presents nothing. Fails with kInvalidArgument for a camera that
  // FrameInput does not allow, with kDeviceLost, and with kOutOfMemory if there is no memory for
  // the draws.
  virtual core::Result<FrameResult> render(const FrameInput& input) = 0;

  // Draws a picture without a scene, for example while there is none yet, and waits for it: the
  // HUD, then the panels. Shows nothing while the window is minimised. Fails like render().
  virtual core::Result<void> show(std::span<const TextPanel> panels, float text_scale = 1,
                                  const HudDrawing& hud = {}) = 0;

  // The font atlas for an ImGui context whose draw data is drawn (FrameInput::gui).
  virtual ImFontAtlas& font_atlas() = 0;

  // Recreates everything that depends on the preset and waits for it. This takes seconds if the
  // driver has not cached the pipelines. Meshes stay. There is no picture to capture until the next
  // frame. After an error (kOutOfMemory, kDeviceLost, or kInterrupted by `progress`) the old preset
  // is in use. `progress` may only call show().
  virtual core::Result<void> set_preset(Preset preset, const Progress& progress = {}) = 0;
  virtual Preset preset() const = 0;  // the one in use

  // The picture of the last frame; waits for it. Fails with kInvalidArgument before the first
  // frame.
  virtual core::Result<Picture> capture() = 0;

  // Headless: sets the size of the picture in pixels; kInvalidArgument if the device does not
  // support it. With a surface: a hint that the window has changed (0 × 0: it is minimised).
  virtual core::Result<void> resize(core::Extent size) = 0;
  virtual core::Extent size() const = 0;  // 0 × 0: there is no picture

  // The device in use.
  virtual const DeviceInfo& device() const = 0;

  // All messages of validation so far; empty without RendererOptions::validation.
  virtual std::vector<std::string> validation_messages() const = 0;

  // The floor: median wall time in ms per frame of drawing the last frame's lists again, with
  // nothing else running. No range of that frame may have been released since. `repeats` >= 1,
  // which is checked. Fails with kInvalidArgument if there is no such frame.
  virtual core::Result<double> replay_floor_ms(int repeats) = 0;

  // The meshes that the last frame drew, in any order; waits for it. For tests and views. Fails
  // with kInvalidArgument before the first frame.
  virtual core::Result<std::vector<DrawnMesh>> drawn_meshes() = 0;

  // The path in use for RendererOptions::path: kCpu or kGpu.
  virtual RenderPath path() const = 0;
  // True if meshes cast shadows into cascades. Then draws outside the picture matter too.
  virtual bool casts_shadows() const = 0;
  // True if the preset has special pipelines for near models (MeshDraw::near).
  virtual bool has_near_models() const = 0;

  // Waits until the device has finished everything. Released ranges are free afterwards.
  virtual void wait_idle() = 0;

 protected:
  // For its implementation.
  Renderer() = default;
};

// All devices in the order of the driver, which is that of their indices, also those that lack
// something. Fails with kNoDevice if there is no loader or no driver.
core::Result<std::vector<DeviceInfo>> list_devices();

}  // namespace psygen::render
