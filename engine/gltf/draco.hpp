// Decompresses primitives with KHR_draco_mesh_compression by libdraco, if this build has it.
// Private to engine/gltf.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/gltf/reading.hpp"

namespace psygen::gltf {

#ifdef PSYGEN_DRACO
inline constexpr bool kReadsDraco = true;
#else
inline constexpr bool kReadsDraco = false;
#endif

struct Unpacked {
  struct Attribute {
    std::vector<std::uint8_t> bytes;  // the elements, one after the other
    Elements elements;                // without their place: elements_of() fills it in
  };
  std::vector<std::uint32_t> indices;
  std::map<std::string, Attribute> attributes;
};

// The triangles of a primitive and those of its attributes that psygen reads. Fails with kParse for
// damaged bytes, kOverBudget for more vertices, triangles or bytes of attributes than the limits,
// and kInvalidArgument in a build without libdraco. `name` is that of the primitive.
core::Result<Unpacked> unpack_draco(Reading& reading, const PrimitiveJson& primitive,
                                    const std::string& name);
core::Result<Elements> elements_of(const Unpacked& unpacked, const std::string& attribute);

}  // namespace psygen::gltf
