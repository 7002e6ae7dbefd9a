// A pass: a part of a frame that owns its pipelines, its own descriptor set and its buffers, and
// records its draws. Passes are plain classes with the functions of the concept `Pass`; passes.hpp
// lists them in the order of a frame. "Rendering" is Vulkan's word for the scope in which a pass
// draws; record.cpp begins and ends it. Private to engine/render.
#pragma once

#include <concepts>
#include <string_view>

#include "engine/render/frame/frame_slot.hpp"
#include "engine/render/frame/setup.hpp"
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

struct PassInfo {
  std::string_view name;
  Stage stage = Stage::kLandscape;
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

// A step of the warm-up: draws of triangles that cover nothing, with some of a feature's pipelines,
// so that the driver compiles them before the first frame. Each step is one submission. Vertex,
// index and texture bindings are valid, and the data of a draw is pushed.
struct WarmUpStep {
  Feature feature = Feature::kLandscape;
  bool lamps = false;  // with point lights
  int number = 0;      // 0 … warm_up_steps(feature) − 1
};

// The functions of every pass.
template <class P>
concept Pass = std::movable<P> && std::default_initializable<P> &&
    requires(P& pass, const P& made, const PassSetup& setup, const Recording& to) {
  { P::kInfo } -> std::convertible_to<const PassInfo&>;
  // Creates what setup.features lacks. Called again for further features.
  { pass.create(setup) } -> std::same_as<core::Result<void>>;
  // Binds and draws; begins no rendering.
  { made.record(to) } -> std::same_as<void>;
  // Steps that draw the pipelines of a feature; 0 if it has none.
  { P::warm_up_steps(Feature{}) } -> std::same_as<int>;
  { made.warm_up(to, WarmUpStep{}) } -> std::same_as<void>;
};
// Optional members:
//   static constexpr Feature kFeature; static bool needs_feature(const FrameInput&)
//                                                     the feature that create() waits for, and true
//                                                     for frames that need it
//   void list(const FrameInput&, const FrameFacts&)   keeps what the frame shows
//   Result<void> write(const Device&, std::size_t)    copies it into the buffers of a slot
//   void use(const Device&, const FrameSlot&, const Targets&)  names images of new targets in a
//                                                     slot's set

}  // namespace psygen::render
