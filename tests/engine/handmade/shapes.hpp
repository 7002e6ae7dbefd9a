// Models for tests of handmade models.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "engine/handmade/shape.hpp"
#include "engine/image/image_io.hpp"
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

// A flat wall of 3 m by 3 m, which faces +Z, with 2 · cells² triangles; `paint` changes vertices.
template <class Paint>
Triangles wall(std::uint32_t cells, const Paint& paint) {
  Triangles t;
  for (std::uint32_t y = 0; y <= cells; ++y) {
    for (std::uint32_t x = 0; x <= cells; ++x) {
      Vertex v{
          3.0F / static_cast<float>(cells) * glm::vec3(x, y, 0), {0, 0, 1}, {150, 150, 150}, 0};
      paint(v);
      t.vertices.push_back(v);
      const std::uint32_t a = y * (cells + 1) + x, b = a + cells + 1;
      if (x < cells && y < cells) t.indices.insert(t.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  }
  t.box = {glm::vec3(0), glm::vec3(3, 3, 0)};
  return t;
}

// A disc of this many triangles around one vertex, with a radius of 1 m. It faces +Y.
inline Triangles fan(std::uint32_t triangles) {
  Triangles t;
  t.vertices.push_back({});
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const double angle = 2 * std::numbers::pi * i / triangles;
    t.vertices.push_back({{std::cos(angle), 0, std::sin(angle)}});
    t.indices.insert(t.indices.end(), {0, 1 + (i + 1) % triangles, 1 + i});
  }
  return t;
}

// Triangles of random ones of a few vertices.
inline Triangles tangle(std::size_t triangles, std::uint32_t vertices) {
  Triangles t;
  std::uint32_t state = 7;
  const auto random = [&state] { return (state = state * 1664525U + 1013904223U) >> 8; };
  for (std::uint32_t i = 0; i < vertices; ++i)
    t.vertices.push_back({0.001F * glm::vec3(random() % 1000, random() % 1000, random() % 1000)});
  while (t.indices.size() < 3 * triangles)
    t.indices.push_back(random() % vertices);
  return t;
}

// An image of a few leaves side by side: green inside, transparent magenta around them.
inline image::Image leaf_picture(std::uint32_t side = 64) {
  image::Image image = image::make_image(side, side, 255, 0, 255, 0);
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      // Three by three tilted ellipses.
      const double u = 3.0 * x / side, v = 3.0 * y / side;
      const double a = u - std::floor(u) - 0.5, b = v - std::floor(v) - 0.5;
      const double along = 0.8 * a + 0.6 * b, across = 0.8 * b - 0.6 * a;
      if (along * along / 0.2 + across * across / 0.05 > 1) continue;
      const auto green = static_cast<std::uint8_t>(110 + 40 * std::sin(40 * across));
      image.pixel(x, y)[0] = 50, image.pixel(x, y)[1] = green;
      image.pixel(x, y)[2] = 25, image.pixel(x, y)[3] = 255;
    }
  }
  return image;
}

// A typical tree by an artist: a trunk, and cards with a texture of leaves that is transparent
// between them. `leaves` is the texture's PNG.
inline gltf::Sample card_tree(std::string_view leaves, int cards = 160) {
  gltf::Sample s;
  struct Part {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    std::vector<std::uint32_t> indices;
    void quad(const std::array<glm::vec3, 4>& corners, const std::array<glm::vec3, 4>& up) {
      const auto first = static_cast<std::uint32_t>(positions.size());
      positions.insert(positions.end(), corners.begin(), corners.end());
      normals.insert(normals.end(), up.begin(), up.end());
      uvs.insert(uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
      for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U})
        indices.push_back(first + i);
    }
  };
  Part trunk, crown;
  constexpr int kSides = 8;
  for (int k = 0; k < kSides; ++k) {
    const auto out = [](int side) {
      const double angle = 2 * std::numbers::pi * side / kSides;
      return glm::vec3(std::sin(angle), 0, std::cos(angle));
    };
    const glm::vec3 a = out(k), b = out(k + 1), top{0, 6, 0};
    trunk.quad({0.3F * a, 0.3F * b, top + 0.1F * b, top + 0.1F * a}, {a, b, b, a});
  }
  std::uint32_t state = 7;
  const auto random = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<float>(state >> 8) / static_cast<float>(1 << 24);
  };
  for (int k = 0; k < cards; ++k) {
    const float turn = 6.2832F * random(), height = 2 * random() - 1,
                far = 0.55F + 0.45F * random();
    const float wide = std::sqrt(1 - height * height);
    const glm::vec3 out{wide * std::sin(turn), height, wide * std::cos(turn)};
    const glm::vec3 middle = glm::vec3(0, 5, 0) + far * glm::vec3(2.2F, 2.6F, 2.2F) * out;
    const float lean = 6.2832F * random(), rise = random() - 0.5F;
    const glm::vec3 right{0.8F * std::cos(lean), 0, 0.8F * std::sin(lean)};
    const glm::vec3 up{-0.8F * rise * std::sin(lean), 0.8F, 0.8F * rise * std::cos(lean)};
    crown.quad({middle - right - up, middle + right - up, middle + right + up, middle - right + up},
               {out, out, out, out});
  }
  const int picture = s.view(leaves);
  s.add("images", {{"bufferView", picture}, {"mimeType", "image/png"}});
  s.add("textures", {{"source", 0}});
  s.add("materials",
        gltf::parsed(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.13, 0.08, 1]}})"));
  s.add("materials", gltf::parsed(R"({"alphaMode": "MASK", "doubleSided": true,
      "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})"));
  nlohmann::json primitives = nlohmann::json::array();
  for (const auto& [part, material] : {std::pair{&trunk, 0}, {&crown, 1}}) {
    nlohmann::json primitive = {{"indices", s.accessor(part->indices, "SCALAR", gltf::kInts)},
                                {"material", material}};
    primitive["attributes"] = {{"POSITION", s.accessor(part->positions, "VEC3", gltf::kFloats)},
                               {"NORMAL", s.accessor(part->normals, "VEC3", gltf::kFloats)},
                               {"TEXCOORD_0", s.accessor(part->uvs, "VEC2", gltf::kFloats)}};
    primitives.push_back(primitive);
  }
  s.add("meshes", {{"name", "tree"}, {"primitives", primitives}});
  s.add("nodes", gltf::parsed(R"({"mesh": 0})"));
  s.add("scenes", gltf::parsed(R"({"nodes": [0]})"));
  return s;
}

// Writes that tree with its leaves into a folder.
inline void write_card_tree(const std::filesystem::path& file) {
  const std::filesystem::path leaves = file.parent_path() / "leaves.png";
  EXPECT_TRUE(image::write_png(leaves, leaf_picture()));
  std::ifstream stream(leaves, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  gltf::write_bytes(file, card_tree(bytes).glb());
}

}  // namespace psygen::handmade
