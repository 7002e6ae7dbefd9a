// The compiled shaders (shaders/CMakeLists.txt), embedded in the library. Constant data, any
// thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/vertex_layout.hpp"

namespace psygen::render {

// SPIR-V words.
using ShaderCode = std::span<const std::uint32_t>;

// The outputs of a mesh's vertex shader (shaders/surface_out.glsl).
enum class MeshLook : std::uint8_t { kColour, kLit, kDrawColour, kShadow };

// The vertex shader of meshes. `pushed`: the data of a draw is in push constants, else in the
// buffer of draws.
ShaderCode mesh_vertex_code(core::VertexLayout layout, MeshLook look, bool pushed);

// The vertex shader of models that fade in or out (shaders/fading.glsl).
ShaderCode fading_vertex_code(MeshLook look, bool pushed);

// The same of models with pictures (shaders/pictures.glsl).
ShaderCode picture_vertex_code(MeshLook look, bool pushed);

// The vertex shader of objects.
ShaderCode object_vertex_code(MeshLook look, bool pushed);

// All other shaders, named after their files and defines.
struct OtherCode {
  ShaderCode surface_frag, surface_lit_frag, surface_fading_frag, surface_lit_fading_frag,
      shadow_fading_frag, water_vert, water_lit_vert, water_colour_frag, water_frag,
      water_mirror_frag, line_vert, sky_vert, sky_frag, sky_dome_vert, sky_dome_frag,
      sky_below_vert, sun_vert, scale_up_vert, scale_up_frag, overlay_vert, overlay_frag,
      object_frag, object_fading_frag, object_textured_frag, object_textured_fading_frag,
      object_shadow_frag, particle_vert, particle_frag, particle_textured_frag, model_detail_vert,
      model_detail_pushed_vert, model_detail_frag, terrain_detail_vert, terrain_detail_pushed_vert,
      ground_detail_frag, ground_lit_frag, ground_lit_near_frag, surface_picture_frag,
      surface_lit_picture_frag, surface_coloured_picture_frag, shadow_picture_frag;
};
// The other shaders; static data.
const OtherCode& other_code();

}  // namespace psygen::render
