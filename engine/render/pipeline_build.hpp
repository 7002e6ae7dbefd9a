// Creates one graphics pipeline from a short description. Owns nothing. Main thread. Private to
// engine/render.
#pragma once

#include <array>

#include "engine/core/vertex_layout.hpp"
#include "engine/render/memory.hpp"
#include "engine/render/shader_code.hpp"

namespace psygen::render {

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

// What a pipeline draws. Vertex input, topology, blending and depth test follow from it.
enum class PipelineKind : std::uint8_t {
  kTerrain,
  kModel,
  kObject,
  kWater,
  kSky,
  kDome,
  kSun,
  kParticles,
  kLines,
  kScaleUp,
  kOverlay
};

// The description of a pipeline.
struct PipelineShape {
  PipelineKind kind = PipelineKind::kSky;
  ShaderCode vert, frag;
  VkFormat colour_format = VK_FORMAT_UNDEFINED;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  // Of both shaders; those that they lack are ignored: fine grain or waves, shadows, point lights.
  std::array<VkBool32, 3> constants{};
  bool wireframe = false;  // needs DeviceInfo::wireframe
  bool flat = false;       // in a pass without depth and with one sample per pixel
  bool shadow = false;     // only depth, of a cascade; `frag` may be empty
};

// Creates a pipeline. Takes milliseconds to seconds, if the driver has to compile the shaders.
core::Result<UniquePipeline> make_pipeline(const Device& device, VkPipelineLayout layout,
                                           const PipelineShape& shape);

}  // namespace psygen::render
