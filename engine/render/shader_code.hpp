// The compiled shaders. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/vertex_layout.hpp"

namespace psygen::render {

using ShaderCode = std::span<const std::uint32_t>;

// What a mesh's vertex shader hands on (shaders/surface_out.glsl).
enum class MeshLook : std::uint8_t { kColour, kLit, kDrawColour, kShadow };

// `pushed`: the draw's data is in push constants, else in the buffer of draws.
ShaderCode mesh_vertex_code(core::VertexLayout layout, MeshLook look, bool pushed);

// Of models that come or go (shaders/fading.glsl).
ShaderCode fading_vertex_code(MeshLook look, bool pushed);

struct OtherCode {
  ShaderCode surface_frag, surface_lit_frag, surface_fading_frag, surface_lit_fading_frag,
      shadow_fading_frag, water_vert, water_lit_vert, water_frag, line_vert, sky_vert, sky_frag,
      sky_dome_vert, sky_dome_frag, sky_below_vert, sun_vert, overlay_vert, overlay_frag;
};
const OtherCode& other_code();

}  // namespace psygen::render
