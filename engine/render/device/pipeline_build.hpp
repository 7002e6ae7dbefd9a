// Creates graphics pipelines from short descriptions. Owns none of them. Main thread. Private to
// engine/render.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/core/error.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/render/device/descriptors.hpp"
#include "engine/render/device/device.hpp"
#include "engine/render/types.hpp"
#include "shader_list.h"

namespace psygen::render {

// The compiled shaders are embedded in the library. CMakeLists.txt has their list, and
// shaders.cmake makes `enum class Shader` of it.

// The outputs of a mesh's vertex shader (shaders/surface_out.glsl).
enum class MeshLook : std::uint8_t { kColour, kLit, kDrawColour, kShadow };

// A variant of a vertex shader of meshes. `first` is the one for kColour.
constexpr Shader mesh_shader(Shader first, MeshLook look) {
  return static_cast<Shader>(static_cast<unsigned>(first) + 2 * static_cast<unsigned>(look));
}
// The variant that takes the data of a draw from push constants instead of the buffer of draws.
constexpr Shader pushed_shader(Shader vert) {
  return static_cast<Shader>(static_cast<unsigned>(vert) + 1);
}
static_assert(pushed_shader(mesh_shader(Shader::kModelObjectVert, MeshLook::kShadow)) ==
              Shader::kModelObjectShadowDrawPushedVert);
static_assert(pushed_shader(Shader::kTerrainGroundDetailVert) ==
              Shader::kTerrainGroundDetailDrawPushedVert);
static_assert(pushed_shader(Shader::kModelFadingModelDetailVert) ==
              Shader::kModelFadingModelDetailDrawPushedVert);

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

// The attachments that a pipeline draws to.
enum class DrawTarget : std::uint8_t {
  kLandscape,  // colour and depth, with the samples of the preset
  kPicture,    // colour only, one sample per pixel
  kShadowMap,  // depth only
};
// Combination of colours with those of the target. kAlpha multiplies them by their opacity;
// kPremultiplied expects multiplied ones.
enum class Blend : std::uint8_t { kNone, kAlpha, kPremultiplied };
// Use of depth: none, test against it (equal depths pass), or test and write.
enum class DepthUse : std::uint8_t { kNone, kTest, kWrite };

// The description of a pipeline.
struct PipelineShape {
  Shader vert{};
  std::optional<Shader> frag = {};                  // none: it writes only depth
  std::optional<core::VertexLayout> vertices = {};  // none: the shader makes them
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  Blend blend = Blend::kNone;
  DepthUse depth = DepthUse::kTest;
  DrawTarget target = DrawTarget::kLandscape;
  // Specialisation constants of both shaders, by number; those that they lack are ignored.
  std::array<VkBool32, 8> constants{};
  bool wireframe = false;  // needs DeviceInfo::wireframe
};

// A specialisation constant.
constexpr VkBool32 on(bool yes) {
  return yes ? VK_TRUE : VK_FALSE;
}

// The attachments of all pipelines of a preset.
struct PipelineTargets {
  VkFormat colour_format = VK_FORMAT_UNDEFINED;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;  // of DrawTarget::kLandscape
};

// Creates the pipelines of a preset and reports the progress. The device must outlive it.
class PipelineMaker {
 public:
  // `progress` may be empty.
  PipelineMaker(const Device& device, PipelineTargets targets, const Progress& progress = {})
      : device_(device), targets_(targets), progress_(progress) {}

  // Creates a pipeline in `out`. Takes milliseconds to seconds, if the driver has to compile the
  // shaders. Fails as vulkan_error() says, and with kInterrupted by the progress.
  core::Result<void> make(VkPipelineLayout layout, const PipelineShape& shape, UniquePipeline& out);

 private:
  const Device& device_;
  PipelineTargets targets_;
  Progress progress_;
  int made_ = 0;
};

// The module of a shader, which only has to live while pipelines are made of it, and a stage of a
// pipeline with it. Fails as vulkan_error() says.
core::Result<UniqueShaderModule> make_module(const Device& device, Shader shader);
VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage, VkShaderModule shader);

// Reports `fraction` in [0, 1]. Fails with kInterrupted if `progress` returns false; an empty one
// never does.
inline core::Result<void> go_on(const Progress& progress, double fraction) {
  if (!progress || progress(fraction)) return {};
  return core::fail(core::ErrorCode::kInterrupted, "the renderer was given up while it was made");
}

// A compute shader with the layout of its one descriptor set, and a fixed number of such sets. Owns
// its Vulkan objects and records no barriers. Empty until create(). The device must outlive it.
class ComputePipeline {
 public:
  // Creates everything. Binding i of the set has the type types[i]. Push constants have
  // `push_bytes` from offset 0. The sets are numbered 0 … sets − 1. Fails as vulkan_error() says.
  core::Result<void> create(const Device& device, Shader shader,
                            std::span<const VkDescriptorType> types, std::uint32_t push_bytes,
                            std::size_t sets);
  // The sets, to name buffers and images in.
  const DescriptorSets& sets() const { return sets_; }

  // Records the binding of the pipeline and a set.
  void bind(const Device& device, VkCommandBuffer commands, std::size_t set) const;
  // Records a dispatch of groups_x · groups_y workgroups. `push` points to push_bytes; requires
  // bind() before.
  void dispatch(const Device& device, VkCommandBuffer commands, const void* push,
                std::uint32_t groups_x, std::uint32_t groups_y) const;

 private:
  DescriptorSets sets_;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
  std::uint32_t push_bytes_ = 0;
};

}  // namespace psygen::render
