// The compiled shaders, embedded in the library. CMakeLists.txt has their list, and shaders.cmake
// makes `enum class Shader` of it. Constant data, any thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>

#include "shader_list.h"

namespace psygen::render {

// The SPIR-V words of a shader.
std::span<const std::uint32_t> code_of(Shader shader);

// The outputs of a mesh's vertex shader (shaders/surface_out.glsl).
enum class MeshLook : std::uint8_t { kColour, kLit, kDrawColour, kShadow };

// A variant of a vertex shader of meshes. `first` is the one for kColour without pushed data.
// `pushed`: the data of a draw is in push constants, else in the buffer of draws.
constexpr Shader mesh_shader(Shader first, MeshLook look, bool pushed) {
  return static_cast<Shader>(static_cast<unsigned>(first) + 2 * static_cast<unsigned>(look) +
                             (pushed ? 1U : 0U));
}
static_assert(mesh_shader(Shader::kModelObjectVert, MeshLook::kShadow, true) ==
              Shader::kModelObjectShadowDrawPushedVert);

}  // namespace psygen::render
