// A pass: a part of a frame that records its draws. It owns the pipelines, the descriptor set and
// the buffers that no other part has. Passes are plain classes under the concept `Pass`; passes.hpp
// lists them in the order of a frame. "Rendering" is Vulkan's word for the scope in which draws are
// recorded; record.cpp begins and ends it for all passes but those that say so. Private to
// engine/render.
#pragma once

#include <concepts>

#include "engine/render/frame/frame_slot.hpp"
#include "engine/render/frame/pass_set.hpp"
#include "engine/render/frame/targets.hpp"
#include "engine/render/meshes/draw_list.hpp"
#include "engine/render/meshes/mesh_tables.hpp"

namespace psygen::render {

class GpuCulling;

// The place of a pass in a frame. Stages are recorded in this order.
enum class Stage : std::uint8_t {
  kBefore,     // outside a rendering
  kLandscape,  // colour and depth of the landscape; its first pass begins the rendering
  kSurface,    // the same attachments, after reflections can be read
  kPicture,    // all pixels of the picture, after a landscape of fewer pixels was scaled up
};

// Facts about a frame that passes need for their lists. Valid during list().
struct FrameFacts {
  const shaders::FrameData& frame;
  MaterialKinds materials;
  const OverlayLayout& overlay;
  core::Extent size;  // of the picture in pixels
};

// The buffers that meshes are drawn from.
struct SceneBuffers {
  std::span<const Buffer> pool_blocks;
  VkBuffer shared_indices = VK_NULL_HANDLE;  // starts with zeroed bytes
};

// A frame in recording. References are valid during record() and warm_up().
struct Recording {
  const Device& device;
  FrameSlot& slot;
  const FrameSets& sets;
  Targets& targets;
  SceneBuffers buffers;
  const MaterialTable& materials;
  const MeshTables& meshes;
  const DrawList& list;
  GpuCulling* culling = nullptr;  // on the GPU path; it chooses draws instead of the list
  View view = View::kNormal;
  bool lamps = false;  // there are point lights

  VkCommandBuffer commands() const { return slot.commands(); }
  void bind_pipeline(VkPipeline pipeline) const {
    device.vk.vkCmdBindPipeline(commands(), VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  }
  void draw(std::uint32_t vertices, std::uint32_t first_vertex = 0) const {
    device.vk.vkCmdDraw(commands(), vertices, 1, first_vertex, 0);
  }
};

// Binds the textures of a material, unless they are bound.
class TextureBinder {
 public:
  explicit TextureBinder(const Recording& to) : to_(to) {}
  void bind(MaterialId material) {
    if (material == bound_ || material == kPlainMaterial) return;
    to_.sets.bind_textures(to_.device, to_.commands(), to_.materials.set(material));
    bound_ = material;
  }

 private:
  const Recording& to_;
  MaterialId bound_ = kPlainMaterial;
};

// A step of the warm-up: draws with some of a feature's pipelines, so that the driver compiles them
// before a frame needs them. Each step is one submission on targets that are never shown. Buffers
// of vertices and indices are bound whose triangles cover nothing, and the data of a draw is
// pushed; for features that are added later, a material's textures are bound as well.
struct WarmUpStep {
  Feature feature = Feature::kLandscape;
  bool lamps = false;  // with point lights
  int number = 0;      // 0 … warm_up_steps(feature) − 1
};

// The members that a pass may have. A member with one of these names has this signature.
// Creates what setup.features lacks. Called again for further features.
template <class P>
concept Creates = requires(P& pass, const PassSetup& setup) {
  { pass.create(setup) } -> std::same_as<core::Result<void>>;
};
// The feature that create() waits for, and true for frames that need it.
template <class P>
concept NeedsFeature = requires(const FrameInput& input) {
  { P::kFeature } -> std::convertible_to<Feature>;
  { P::needs_feature(input) } -> std::same_as<bool>;
};
// Keeps what the frame shows.
template <class P>
concept Lists = requires(P& pass, const FrameInput& input, const FrameFacts& facts) {
  { pass.list(input, facts) } -> std::same_as<void>;
};
// Copies what is kept into the buffers of a slot.
template <class P>
concept Writes = requires(P& pass, const Device& device, std::size_t slot) {
  { pass.write(device, slot) } -> std::same_as<core::Result<void>>;
};
// Names images of new targets in a slot's set; also called before create().
template <class P>
concept UsesTargets = requires(P& pass, const Device& device, const FrameSlot& slot,
                               const Targets& targets) {
  { pass.use(device, slot, targets) } -> std::same_as<void>;
};
// The number of steps that draw the pipelines of a feature, 0 if it has none, and one of them.
template <class P>
concept WarmsUp = requires(const P& made, const Recording& to) {
  { P::warm_up_steps(Feature{}) } -> std::same_as<int>;
  { made.warm_up(to, WarmUpStep{}) } -> std::same_as<void>;
};

// Every pass has a stage and record(), which binds and draws.
template <class P>
concept Pass = std::movable<P> && std::default_initializable<P> &&
    requires(const P& made, const Recording& to) {
  { P::kStage } -> std::convertible_to<Stage>;
  { made.record(to) } -> std::same_as<void>;
} &&(Creates<P> || !requires { &P::create; }) && (Lists<P> || !requires { &P::list; }) &&
    (NeedsFeature<P> || !requires { &P::needs_feature; }) &&
    (Writes<P> || !requires { &P::write; }) && (UsesTargets<P> || !requires { &P::use; }) &&
    (WarmsUp<P> || !(
                       requires { &P::warm_up; } || requires { &P::warm_up_steps; }));

}  // namespace psygen::render
