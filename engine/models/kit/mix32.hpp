// The 32-bit hash of docs/models.md, "mix32". mix32-inl.hpp has the same function for vectors.
// Pure, constant time. Not for hash tables that an attacker can fill.
#pragma once

#include <cstdint>

namespace psygen::models {

// Bijective mixing of 32 bits in two rounds (constants: Wellons 2018, "Prospecting for hash
// functions", public domain).
constexpr std::uint32_t mix32(std::uint32_t h) {
  h = (h ^ (h >> 16)) * 0x7FEB352DU;
  h = (h ^ (h >> 15)) * 0x846CA68BU;
  return h ^ (h >> 16);
}

}  // namespace psygen::models
