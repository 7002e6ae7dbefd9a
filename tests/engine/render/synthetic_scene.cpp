#include "tests/engine/render/synthetic_scene.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/core/geometry_memory.hpp"

namespace psygen::render::synthetic {

using core::GeometryMemory;
using core::GeometryRange;
using core::Result;

namespace {

std::int16_t snorm16(float v) {
  return static_cast<std::int16_t>(std::lround(v * 32767.0F));
}

core::ModelVertex model_vertex(glm::vec3 position, glm::vec3 normal, glm::vec3 albedo) {
  core::ModelVertex v{};
  for (int i = 0; i < 3; ++i) {
    v.position[i] = snorm16(position[i]);
    v.colour[i] = static_cast<std::uint8_t>(std::lround(std::sqrt(albedo[i]) * 255.0F));
  }
  v.ambient = 255;
  // Octahedral map of an axis-aligned normal; downwards is a corner.
  v.normal[0] = snorm16(normal.y < 0 ? 1.0F : normal.x);
  v.normal[1] = snorm16(normal.y < 0 ? 1.0F : normal.z);
  return v;
}

}  // namespace

core::Result<std::unique_ptr<Renderer>> open_renderer(Preset preset, core::Extent size) {
  RendererOptions options;
  options.validation = true;
  options.size = size;
  options.geometry_budget_bytes = 1 << 20;
  options.preset = preset;
  return Renderer::create(options);
}

std::vector<std::uint16_t> grid_indices(int side) {
  std::vector<std::uint16_t> indices;
  for (int z = 0; z + 1 < side; ++z) {
    for (int x = 0; x + 1 < side; ++x) {
      const int a = z * side + x;
      for (const int i : {a, a + side, a + 1, a + 1, a + side, a + side + 1})
        indices.push_back(static_cast<std::uint16_t>(i));
    }
  }
  return indices;
}

Result<GeometryRange> make_terrain(GeometryMemory& memory, int side, const HeightFunction& height) {
  const auto count = static_cast<std::uint32_t>(side * side);
  const auto reserved = memory.reserve(core::VertexLayout::kTerrain, count, 0);
  if (!reserved) return tl::unexpected(reserved.error());
  std::vector<core::TerrainVertex> vertices;
  for (int z = 0; z < side; ++z) {
    for (int x = 0; x < side; ++x) {
      const auto h = static_cast<std::uint16_t>(std::lround(height(x, z) * 65535.0F));
      vertices.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(z), h, h, 0, 0});
    }
  }
  std::memcpy(reserved->vertices.data(), vertices.data(), reserved->vertices.size());
  memory.commit(reserved->range);
  return reserved->range;
}

Result<GeometryRange> make_box(GeometryMemory& memory, glm::vec3 albedo, std::uint8_t material) {
  const auto reserved = memory.reserve(core::VertexLayout::kModel, 24, 36);
  if (!reserved) return tl::unexpected(reserved.error());
  std::vector<core::ModelVertex> vertices;
  std::vector<std::uint16_t> indices;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      glm::vec3 normal(0.0F), u(0.0F), v(0.0F);
      normal[axis] = sign;
      u[(axis + 1) % 3] = 1.0F;
      v[(axis + 2) % 3] = sign;
      const auto first = static_cast<std::uint16_t>(vertices.size());
      for (const glm::vec3& p : {normal - u - v, normal + u - v, normal + u + v, normal - u + v})
        vertices.push_back(model_vertex(p, normal, albedo));
      for (const int i : {0, 1, 2, 0, 2, 3})
        indices.push_back(static_cast<std::uint16_t>(first + i));
    }
  }
  for (core::ModelVertex& v : vertices)
    v.material = material;
  std::memcpy(reserved->vertices.data(), vertices.data(), reserved->vertices.size());
  std::copy(indices.begin(), indices.end(), reserved->indices.begin());
  memory.commit(reserved->range);
  return reserved->range;
}

Result<GeometryRange> make_sheet(GeometryMemory& memory, int side) {
  const std::vector<std::uint16_t> indices = grid_indices(side);
  const auto reserved =
      memory.reserve(core::VertexLayout::kModel, static_cast<std::uint32_t>(side * side),
                     static_cast<std::uint32_t>(indices.size()));
  if (!reserved) return tl::unexpected(reserved.error());
  std::vector<core::ModelVertex> vertices;
  const float step = 2.0F / static_cast<float>(side - 1);
  for (int z = 0; z < side; ++z) {
    for (int x = 0; x < side; ++x) {
      const glm::vec3 at{static_cast<float>(x) * step - 1.0F, 1.0F - static_cast<float>(z) * step,
                         0.0F};
      vertices.push_back(model_vertex(at, {0, 0, 1}, {0.2F, 0.3F, 0.1F}));
    }
  }
  std::memcpy(reserved->vertices.data(), vertices.data(), reserved->vertices.size());
  std::copy(indices.begin(), indices.end(), reserved->indices.begin());
  memory.commit(reserved->range);
  return reserved->range;
}

namespace {

// A mesh of the heap's as an object's, with whole textures on each four of its vertices.
Result<GeometryRange> as_object(core::HeapGeometryMemory& heap, const Result<GeometryRange>& mesh,
                                GeometryMemory& memory) {
  if (!mesh) return mesh;
  const auto from = core::vertices_of<core::ModelVertex>(heap.vertex_bytes(*mesh));
  std::vector<core::ObjectVertex> vertices;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const bool right = i % 4 == 1 || i % 4 == 2, down = i % 4 < 2;
    vertices.push_back({from[i], {right ? 1.0F : 0.0F, down ? 1.0F : 0.0F}});
  }
  const auto reserved =
      memory.reserve(core::VertexLayout::kObject, mesh->vertex_count, mesh->index_count);
  if (!reserved) return tl::unexpected(reserved.error());
  std::memcpy(reserved->vertices.data(), vertices.data(), reserved->vertices.size());
  std::ranges::copy(heap.indices(*mesh), reserved->indices.begin());
  memory.commit(reserved->range);
  heap.release(*mesh);
  return reserved->range;
}

}  // namespace

Result<GeometryRange> make_object_box(GeometryMemory& memory, glm::vec3 albedo) {
  core::HeapGeometryMemory heap(1 << 16);
  return as_object(heap, make_box(heap, albedo), memory);
}

Result<GeometryRange> make_object_sheet(GeometryMemory& memory, int side) {
  core::HeapGeometryMemory heap(1 << 24);
  return as_object(heap, make_sheet(heap, side), memory);
}

FrameInput look(double altitude_m, double pitch, core::Extent size) {
  FrameInput input;
  input.pose.position.local = {0.0, altitude_m, 0.0};
  input.pose.pitch = pitch;
  input.projection.aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  input.palette = {.grass = {0.085F, 0.125F, 0.030F},
                   .forest = {0.045F, 0.070F, 0.022F},
                   .dry = {0.200F, 0.165F, 0.075F},
                   .rock = {0.150F, 0.138F, 0.125F},
                   .snow = {0.74F, 0.78F, 0.84F},
                   .sand = {0.36F, 0.30F, 0.19F},
                   .sand_end_m = -1e6F,
                   .sand_blend_m = 2.0F,
                   .dry_start_m = 60.0F,
                   .dry_blend_m = 40.0F,
                   .snow_start_m = 1e6F,
                   .snow_blend_m = 15.0F,
                   .rock_slope_start = 0.16F,
                   .rock_slope_full = 0.34F,
                   .snow_slope_max = 0.40F};
  return input;
}

}  // namespace psygen::render::synthetic
