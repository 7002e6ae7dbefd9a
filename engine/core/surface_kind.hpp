// Materials of models' solid surfaces, which choose their textures.
#pragma once

#include <cstdint>

namespace psygen::core {

// Applies to all of a model except its leaves. The shaders use the same numbers (PSYGEN_SURFACE_…).
enum class SurfaceKind : std::uint8_t {
  kPlain = 0,  // vertex colours only
  kStone = 1,
  kBark = 2,
};

}  // namespace psygen::core
