// The implementation of renderer.hpp. Owns every Vulkan object, in order of creation. Main thread.
// Private to engine/render.
#pragma once

#include <array>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "engine/render/device/device.hpp"
#include "engine/render/frame/frame_slot.hpp"
#include "engine/render/frame/swapchain.hpp"
#include "engine/render/memory/geometry_pool.hpp"
#include "engine/render/memory/shared_index_lists.hpp"
#include "engine/render/memory/staged_geometry.hpp"
#include "engine/render/meshes/contact_shadow_map.hpp"
#include "engine/render/passes/gpu_culling.hpp"
#include "engine/render/passes/passes.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/text/overlay_layout.hpp"
#include "engine/render/textures/model_pictures.hpp"

namespace psygen::render {

// The choices of a preset, and the objects that are created for it.
struct Looks {
  Preset preset = Preset::kLow;
  PresetTraits traits;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;  // of the preset, if the device has them
  bool reflections = false;                               // water reflects the land
  Features features;                                      // that can be drawn
  FrameSets sets;
  MeshTables meshes;
  Passes passes;
};

// Its parts are in renderer_create.cpp, renderer_impl.cpp (frames), renderer_preset.cpp,
// renderer_readback.cpp and renderer_window.cpp.
class RendererImpl final : public Renderer {
 public:
  static constexpr std::size_t kFramesInFlight = 2;

  // Only stores the options.
  explicit RendererImpl(const RendererOptions& options);
  // Waits for the device, or leaks its objects if it hangs: destroying them would wait for ever.
  ~RendererImpl() override;

  // Creates everything. Call it once, before all others; during it, `progress` may call show().
  // After an error only destruction is allowed.
  core::Result<void> create_all(const Progress& progress);

  // Renderer.
  core::GeometryMemory& geometry() override { return *pool_; }
  core::Result<std::uint32_t> upload_shared_indices(
      std::span<const std::uint16_t> indices) override {
    return shared_.add(indices);
  }
  core::Result<TextureId> add_texture(const TexturePixels& pixels) override {
    return noted(materials_.add_texture(*device_, pixels));
  }
  core::Result<MaterialId> add_material(const Material& material) override {
    return materials_.add(*device_, material);
  }
  core::Result<void> prepare(Feature feature) override;
  core::Result<void> set_model_pictures(std::span<const core::ImpostorTexture> pictures) override;
  core::Result<void> set_model_picture(std::size_t number,
                                       const core::ImpostorTexture& picture) override;
  std::uint64_t texture_bytes() const override {
    return materials_.texture_bytes() + pictures_.bytes();
  }
  core::Result<FrameResult> render(const FrameInput& input) override;
  core::Result<void> show(std::span<const TextPanel> panels, float text_scale,
                          const HudDrawing& hud) override;
  ImFontAtlas& font_atlas() override { return overlay_.font_atlas(); }
  core::Result<void> set_preset(Preset preset, const Progress& progress) override;
  Preset preset() const override { return looks_.preset; }
  core::Result<Picture> capture() override;
  core::Result<void> resize(core::Extent size) override;
  core::Extent size() const override {
    return targets_.empty() ? core::Extent{} : targets_[0].extent;
  }
  const DeviceInfo& device() const override { return device_->info; }
  std::vector<std::string> validation_messages() const override { return instance_->messages(); }
  core::Result<double> replay_floor_ms(int repeats) override;
  core::Result<std::vector<DrawnMesh>> drawn_meshes() override;
  RenderPath path() const override { return culling_ ? RenderPath::kGpu : RenderPath::kCpu; }
  bool casts_shadows() const override { return looks_.traits.cascades > 0; }
  bool has_near_models() const override { return !looks_.traits.pixel_light; }  // models.cpp
  void wait_idle() override;

 private:
  enum class WindowState : std::uint8_t { kReady, kNotNow };

  core::Result<void> create_device();
  core::Result<void> create_targets(core::Extent extent);
  core::Result<void> create_geometry();
  core::Result<void> create_culling();
  core::Result<void> create_looks(Preset preset, const Progress& progress);
  core::Result<void> create_overlay();
  core::Result<void> create_passes(Features features, const Progress& progress);
  PassSetup pass_setup(PipelineMaker& pipelines, Features features) const;
  void use_sets();
  void use_targets();
  void use_targets(const FrameSlot& slot, const Targets& targets);
  core::Result<Targets> make_small_targets();
  core::Result<void> warm_up(const Progress& progress);
  core::Result<void> warm_up_later(Feature feature, bool lamps);
  core::Result<void> draw_step(FrameSlot& slot, Targets& small, const WarmUpStep& step,
                               VkDescriptorSet textures);
  core::Result<void> warm_up_culling(FrameSlot& slot, Targets& small);
  core::Result<void> write_frame(FrameSlot& slot);
  void list_frame(const FrameInput& input);
  void list_draws(const FrameInput& input);
  core::Result<void> prepare_for(const FrameInput& input);
  // The recording of a frame; the GPU path adds its culling.
  Recording recording(FrameSlot& slot, Targets& targets) const {
    return {.device = *device_,
            .slot = slot,
            .sets = looks_.sets,
            .targets = targets,
            .buffers = {pool_blocks_, shared_.buffer()},
            .materials = materials_,
            .meshes = looks_.meshes,
            .list = list_};
  }
  Targets& targets_of(const FrameSlot& slot) { return targets_[slot.number() % targets_.size()]; }
  // The slot of the frame with this timeline value.
  FrameSlot& slot_of(std::uint64_t value) { return slots_[value % kFramesInFlight]; }
  core::Result<std::byte*> add_pool_block(std::uint64_t bytes);

  core::Result<void> wait_for(FrameSlot& slot);
  core::Result<bool> prepare_window();
  core::Result<void> recreate_surface();
  core::Result<WindowState> acquire_window(FrameSlot& slot);
  core::Result<void> record(FrameSlot& slot, bool windowed);
  core::Result<void> submit(FrameSlot& slot, bool windowed);
  core::Result<bool> present();
  core::Result<bool> settle_present();
  core::Result<bool> note_presented(const core::Result<SwapchainState>& shown);
  core::Result<FrameResult> draw_frame(const FrameInput& input, FrameSlot& slot);
  Apart apart_now();
  core::Extent landscape_size(float resolution);
  // Stores in lost_ that the device was lost. After that nothing more is submitted.
  template <class T>
  core::Result<T> noted(core::Result<T> result) {
    if (!result && result.error().code == core::ErrorCode::kDeviceLost) lost_ = true;
    return result;
  }

  RendererOptions options_;
  OverlayLayout overlay_;
  std::unique_ptr<Instance> instance_;
  UniqueSurface surface_;
  std::unique_ptr<Device> device_;
  VkFormat colour_format_ = VK_FORMAT_B8G8R8A8_UNORM;
  std::uint32_t pushed_from_ = 0;  // meshes with at least this many indices are pushed
  std::vector<Buffer> pool_blocks_;
  std::unique_ptr<GeometryPool> pool_;
  StagedGeometry* staged_ = nullptr;  // pool_, or null if the CPU writes the blocks directly
  SharedIndexLists shared_;
  MaterialTable materials_;
  ImpostorTextures pictures_;
  Looks looks_;
  std::array<FrameSlot, kFramesInFlight> slots_;
  std::unique_ptr<GpuCulling> culling_;  // null on the CPU path
  UniqueSemaphore timeline_;
  std::vector<Targets> targets_;  // one per slot on the CPU path; one for all on the GPU path
  Swapchain swapchain_;
  core::Extent seen_framebuffer_;  // the window's size when the swapchain was created
  bool swapchain_stale_ = true;
  // Of the last frame, on software devices: there it waits until the picture is drawn. Valid until
  // settle_present(), before which the swapchain is not touched.
  std::future<core::Result<SwapchainState>> presenting_;

  std::uint64_t frame_value_ = 0;    // last value submitted to the timeline
  std::uint64_t idle_value_ = 0;     // frame_value_ when the device was last known to be idle
  std::uint64_t warm_up_value_ = 0;  // frame_value_ before the first frame
  bool resized_ = false;             // since the last frame
  core::Extent drawn_;               // of the landscape, in the last frame
  bool scales_up_ = true;            // false: the device or its memory does not allow it
  bool has_picture_ = false;
  bool has_list_ = false;
  bool lost_ = false;
  DrawList list_;  // on the CPU path
  shaders::FrameData frame_{};
  ContactShadowMap shade_;
  View view_ = View::kNormal;
  std::optional<GpuTime> gpu_;
};

}  // namespace psygen::render
