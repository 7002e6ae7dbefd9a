// What solid surfaces of models are made of, for their textures.
#pragma once

#include <cstdint>

namespace psygen::core {

// Of all of a model but its leaves. The numbers are those of the shaders (PSYGEN_SURFACE_…).
enum class SurfaceKind : std::uint8_t {
  kPlain = 0,  // the colours of the vertices alone
  kStone = 1,
  kBark = 2,
};

}  // namespace psygen::core
