#include "engine/exchange/unpack.hpp"

#include <fmt/format.h>

#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

#include "engine/core/out_of_memory.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/ground_blends.hpp"

namespace psygen::exchange {
namespace {

struct Vertex {
  glm::vec3 position{0.0F}, normal{0.0F}, colour{0.0F};
  std::uint8_t material = kSolid;
};

template <class Packed>
Packed packed_at(const models::MeshView& mesh, std::uint32_t i) {
  Packed vertex;
  std::memcpy(&vertex, mesh.vertices.data() + i * sizeof(Packed), sizeof vertex);
  return vertex;
}

Vertex model_vertex(const models::MeshView& mesh, std::uint32_t i, const core::Bounds& box) {
  const auto v = packed_at<core::ModelVertex>(mesh, i);
  const auto albedo = [&v](int c) {
    const float root = static_cast<float>(v.colour[c]) * (1.0F / 255.0F);
    return root * root;
  };
  const glm::vec2 octahedral = glm::vec2(v.normal[0], v.normal[1]) * (1.0F / 32767.0F);
  return {models::unpack_position(v, box), models::decode_octahedral(octahedral),
          glm::vec3(albedo(0), albedo(1), albedo(2)), v.material};
}

// Values shared by all vertices of one terrain mesh.
struct Ground {
  const world::Palette& palette;
  core::BlockCoord block;
  double block_size_m;
  float cell_m;
  core::Bounds box;
  float skirt_m;
};

Vertex terrain_vertex(const models::MeshView& mesh, std::uint32_t i, const Ground& ground) {
  const auto v = packed_at<core::TerrainVertex>(mesh, i);
  const glm::vec2 plane = glm::vec2(v.grid_x & 0x7F, v.grid_z) * ground.cell_m;
  const float height_m = ground.box.min.y + static_cast<float>(v.height) * (1.0F / 65535.0F) *
                                                (ground.box.max.y - ground.box.min.y);
  const glm::vec3 normal =
      models::decode_octahedral(glm::vec2(v.normal_x, v.normal_z) * (1.0F / 127.0F));
  const glm::vec2 place = world::pattern_place(ground.block, ground.block_size_m, plane);
  const float hangs_m = (v.grid_x & 0x80) != 0 ? ground.skirt_m : 0.0F;
  return {{plane.x, height_m - hangs_m, plane.y},
          normal,
          ground_albedo(ground.palette, height_m, normal, place, v.height,
                        static_cast<float>(v.road) * (1.0F / 255.0F)),
          kGround};
}

// Distributes vertices to the parts of an object by material, at their first use by a triangle.
class Builder {
 public:
  Builder(Object& object, std::size_t vertices) : object_(object), places_(vertices) {}

  void add(const std::array<std::uint32_t, 3>& triangle, std::span<const Vertex> vertices) {
    const std::size_t part = part_of(vertices[triangle[0]].material);
    for (const std::uint32_t i : triangle) {
      Place& place = places_[i];
      Part& to = object_.parts[part];
      if (place.part != part) {  // new, or used before by a triangle of another material
        place = {part, static_cast<std::uint32_t>(to.positions.size())};
        to.positions.push_back(vertices[i].position);
        to.normals.push_back(vertices[i].normal);
        to.colours.push_back(vertices[i].colour);
      }
      to.indices.push_back(place.index);
    }
  }

 private:
  static constexpr std::size_t kNone = SIZE_MAX;
  struct Place {
    std::size_t part = kNone;
    std::uint32_t index = 0;
  };
  std::size_t part_of(std::uint8_t material) {
    std::size_t i = 0;
    while (i < object_.parts.size() && object_.parts[i].material != material)
      ++i;
    if (i == object_.parts.size()) object_.parts.push_back({material, {}, {}, {}, {}});
    return i;
  }
  Object& object_;
  std::vector<Place> places_;
};

std::vector<Vertex> vertices_of(const models::ModelType& type, const models::Parameters& p,
                                const models::MeshSize& size, const models::MeshView& mesh,
                                const world::Palette& palette, float skirt_m) {
  const core::Bounds box = type.bounds(p);
  std::vector<Vertex> vertices(size.vertex_count);
  if (size.layout == core::VertexLayout::kModel) {
    for (std::uint32_t i = 0; i < size.vertex_count; ++i)
      vertices[i] = model_vertex(mesh, i, box);
    return vertices;
  }
  const double block_size_m = models::terrain_block_size_m(p);
  const auto cells = static_cast<double>(p.integer(models::kTerrainSize) - 1);
  const Ground ground{palette,
                      {static_cast<std::int32_t>(p.integer(models::kTerrainBlockX)),
                       static_cast<std::int32_t>(p.integer(models::kTerrainBlockZ))},
                      block_size_m,
                      static_cast<float>(block_size_m / cells),
                      box,
                      skirt_m};
  for (std::uint32_t i = 0; i < size.vertex_count; ++i)
    vertices[i] = terrain_vertex(mesh, i, ground);
  return vertices;
}

core::Result<Object> object_of(const models::ModelType& type, const models::Parameters& p,
                               int level, const models::MeshSize& size,
                               const models::MeshView& mesh, const world::Palette& palette,
                               float skirt_m) {
  std::vector<std::uint16_t> shared;
  std::span<const std::uint16_t> indices = mesh.indices;
  if (size.shared_indices != 0) {
    shared.resize(size.index_count);
    type.write_shared_indices(size.shared_indices, shared);
    indices = shared;
  }
  // The surface comes first, then the skirt.
  if (size.layout == core::VertexLayout::kTerrain && !(skirt_m > 0))
    indices = indices.first(std::size_t{3} * models::terrain_surface_triangles(p, level));

  const std::vector<Vertex> vertices = vertices_of(type, p, size, mesh, palette, skirt_m);
  Object object{std::string(type.name()), glm::vec3(0.0F), {}};
  Builder builder(object, vertices.size());
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> triangle{indices[i], indices[i + 1], indices[i + 2]};
    for (const std::uint32_t vertex : triangle) {
      if (vertex < vertices.size()) continue;
      return core::fail(core::ErrorCode::kSynthesisFailed,
                        fmt::format("{} level {}: an index names vertex {} of {}", type.name(),
                                    level, vertex, vertices.size()));
    }
    builder.add(triangle, vertices);
  }
  return object;
}

}  // namespace

core::Result<Object> unpack(const models::ModelType& type, const models::Parameters& p, int level,
                            const models::MeshSize& size, const models::MeshView& mesh,
                            const world::Palette& palette, float skirt_m) {
  Object object;
  // User types may throw; our own code throws only when memory is exhausted.
  return core::catch_exceptions(
             core::ErrorCode::kSynthesisFailed,
             [&] { return fmt::format("{} level {}", type.name(), level); },
             "threw while it was unpacked",
             [&]() -> core::Result<void> {
               auto made = object_of(type, p, level, size, mesh, palette, skirt_m);
               if (!made) return tl::unexpected(made.error());
               object = std::move(*made);
               return {};
             })
      .map([&object] { return std::move(object); });
}

glm::vec3 ground_albedo(const world::Palette& palette, float height_m, const glm::vec3& normal,
                        glm::vec2 pattern_place_m, std::uint16_t packed_height, float road) {
  const world::GroundBlends blends =
      world::ground_blends(palette, height_m, normal, pattern_place_m, road);
  const glm::vec3* const kinds[world::kGroundKinds] = {
      &palette.grass, &palette.forest, &palette.dry, &palette.sand, &palette.rock, &palette.snow};
  glm::vec3 c = *kinds[0];
  for (std::size_t i = 1; i < world::kGroundKinds; ++i)
    c = glm::mix(c, *kinds[i], blends[i]);
  const std::uint32_t grain = (packed_height * 0x9E3779B1u) >> 24;
  return c * (0.9F + 0.2F * static_cast<float>(grain) * (1.0F / 255.0F));
}

}  // namespace psygen::exchange
