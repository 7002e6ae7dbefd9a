// The look of a model's vertex, as docs/models.md defines it: in double precision, before packing;
// and a comparison with the bytes of a packed vertex, rounded to nearest. The oracles of rocks,
// trees and grass return such looks. Reads bytes by the definition of the vertex layout
// (engine/core/vertex_layout.hpp), not with the engine's own unpacking.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "engine/core/vertex_layout.hpp"

namespace psygen::models::test {

struct Look {
  glm::dvec3 normal{0, 1, 0};    // of any length
  glm::dvec3 colour{0};          // stored colour, the root of albedo, in [0, 1]
  double ambient = 1, sway = 0;  // in [0, 1]
  int material = 0;
  bool inner = false;  // the base of a spray: less an eighth in colour, a quarter in ambient light
};

// Error of single precision beyond half a step of the packing: relative to the largest value of a
// byte, and to the length of a normal.
struct LookTolerance {
  double byte = 1e-5, normal = 1e-5;
};

// True if a byte is a number in [0, 1] rounded to nearest, minus ⌊1/part⌋ of it (0: minus nothing).
inline bool is_rounded(int byte, double value, int part, double tolerance) {
  const double steps = 255 * std::clamp(value, 0.0, 1.0);
  for (const double whole : {std::floor(steps), std::ceil(steps)}) {
    const int n = static_cast<int>(whole);
    if (std::abs(whole - steps) <= 0.5 + 255 * tolerance && byte == n - (part > 0 ? n / part : 0))
      return true;
  }
  return false;
}

// Returns the direction that a packed vertex stores, with |x| + |y| + |z| = 1.
inline glm::dvec3 unpacked_normal(const core::ModelVertex& v) {
  const double a = v.normal[0] / 32767.0, b = v.normal[1] / 32767.0;
  const double y = 1 - std::abs(a) - std::abs(b);
  if (y >= 0) return {a, y, b};
  return {std::copysign(1 - std::abs(b), a), y, std::copysign(1 - std::abs(a), b)};
}

// Half a step of both numbers moves the stored direction, whose |x| + |y| + |z| is 1, by at most
// √1.5 steps.
inline bool is_rounded_normal(const core::ModelVertex& v, const glm::dvec3& normal,
                              double tolerance) {
  const glm::dvec3 found = unpacked_normal(v);
  const double most = std::sqrt(1.5) / 32767 / glm::length(found) + tolerance;
  return glm::distance(glm::normalize(found), glm::normalize(normal)) <= most;
}

// Returns the faults of a packed vertex; empty if it looks as expected.
inline std::string fault_of(const core::ModelVertex& v, const Look& look,
                            const LookTolerance& tolerance = {}) {
  std::string faults;
  const auto note = [&](const char* what, double found, double expected) {
    faults += std::string(what) + " is " + std::to_string(found) + " instead of " +
              std::to_string(expected) + "; ";
  };
  for (int c = 0; c < 3; ++c) {
    if (!is_rounded(v.colour[c], look.colour[c], look.inner ? 8 : 0, tolerance.byte))
      note(std::array{"red", "green", "blue"}[static_cast<std::size_t>(c)], v.colour[c],
           look.colour[c] * (look.inner ? 255 * 7 / 8.0 : 255));
  }
  if (!is_rounded(v.ambient, look.ambient, look.inner ? 4 : 0, tolerance.byte))
    note("ambient", v.ambient, look.ambient * (look.inner ? 255 * 3 / 4.0 : 255));
  if (!is_rounded(v.sway, look.sway, 0, tolerance.byte)) note("sway", v.sway, 255 * look.sway);
  if (v.material != look.material) note("material", v.material, look.material);
  if (!is_rounded_normal(v, look.normal, tolerance.normal)) {
    const glm::dvec3 found = glm::normalize(unpacked_normal(v));
    const glm::dvec3 expected = glm::normalize(look.normal);
    for (int c = 0; c < 3; ++c)
      note(std::array{"normal.x", "normal.y", "normal.z"}[static_cast<std::size_t>(c)], found[c],
           expected[c]);
  }
  return faults;
}

}  // namespace psygen::models::test
