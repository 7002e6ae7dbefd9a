// Models for tests of handmade models.
#pragma once

#include <cmath>
#include <numbers>

#include "engine/handmade/shape.hpp"
#include "tests/engine/gltf/sample.hpp"

namespace psygen::handmade {

// A wavy ball of 2 · rows · columns triangles with a radius of about 1 m, of one material, as a
// file.
inline gltf::Sample ball(int rows, int columns) {
  gltf::Sample s;
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double v = std::numbers::pi * r / rows, u = 2 * std::numbers::pi * c / columns;
      const double radius = 1 + 0.05 * std::sin(5 * u) * std::sin(4 * v);
      positions.emplace_back(radius * std::sin(v) * std::cos(u), radius * std::cos(v),
                             radius * std::sin(v) * std::sin(u));
      const auto at = [&](int i, int k) {
        return static_cast<std::uint32_t>(i * columns + k % columns);
      };
      if (r == rows) continue;
      for (const std::uint32_t i :
           {at(r, c), at(r, c + 1), at(r + 1, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)})
        indices.push_back(i);
    }
  }
  const std::vector<glm::vec3> normals = positions;
  nlohmann::json primitive = {{"indices", s.accessor(indices, "SCALAR", gltf::kInts)},
                              {"material", 0}};
  primitive["attributes"] = {{"POSITION", s.accessor(positions, "VEC3", gltf::kFloats)},
                             {"NORMAL", s.accessor(normals, "VEC3", gltf::kFloats)}};
  s.add("materials",
        gltf::parsed(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.25, 1, 0, 1]}})"));
  s.add("meshes", {{"name", "ball"}, {"primitives", gltf::list(primitive)}});
  s.add("nodes", gltf::parsed(R"({"name": "ball", "mesh": 0})"));
  s.add("scenes", gltf::parsed(R"({"nodes": [0]})"));
  return s;
}

// The triangles of a sphere of radius 1 m; every quarter of it has another colour.
inline Triangles sphere(int rows, int columns) {
  Triangles t;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c <= columns; ++c) {
      const double v = std::numbers::pi * r / rows, u = 2 * std::numbers::pi * c / columns;
      const glm::vec3 p(std::sin(v) * std::cos(u), std::cos(v), std::sin(v) * std::sin(u));
      t.vertices.push_back(
          {p, p, {200, static_cast<std::uint8_t>(64 * (4 * c / columns % 4)), 0}, 0});
    }
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const auto a = static_cast<std::uint32_t>(r * (columns + 1) + c);
      const auto b = static_cast<std::uint32_t>(a + static_cast<std::uint32_t>(columns) + 1);
      t.indices.insert(t.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  }
  t.box = {glm::vec3(-1), glm::vec3(1)};
  return t;
}

}  // namespace psygen::handmade
