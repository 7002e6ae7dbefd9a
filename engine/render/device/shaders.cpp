#include "engine/render/device/shaders.hpp"

namespace psygen::render {

namespace {

using ShaderCode = std::span<const std::uint32_t>;
#include "shader_code.h"

}  // namespace

std::span<const std::uint32_t> code_of(Shader shader) {
  return kShaders[static_cast<std::size_t>(shader)];
}

}  // namespace psygen::render
