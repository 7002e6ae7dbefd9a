#include <array>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/models/terrain.hpp"
#include "engine/models/terrain_shape.hpp"

namespace psygen::models {
namespace {

glm::vec3 unit_normal(double slope_x, double slope_z) {
  const double scale = 1 / std::sqrt(slope_x * slope_x + 1 + slope_z * slope_z);
  return {static_cast<float>(-slope_x * scale), static_cast<float>(scale),
          static_cast<float>(-slope_z * scale)};
}

GroundPoint ground_at(const TerrainShape& shape, core::BlockCoord block, glm::dvec2 local) {
  const glm::dvec2 cells = local / shape.cell_m;
  const double x = std::floor(cells.x), z = std::floor(cells.y);
  const double u = cells.x - x, v = cells.y - z;
  const auto world = [&](std::int32_t index, double cell) {
    const auto origin = static_cast<std::uint64_t>(shape.block_origin(index));
    const auto first = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell));
    return std::array<std::int64_t, 2>{
        static_cast<std::int64_t>(origin + (first << shape.node_level)),
        static_cast<std::int64_t>(origin + ((first + 1) << shape.node_level))};
  };
  std::array<float, 4> noise;
  shape.noise.evaluate(world(block.x, x), world(block.z, z), noise, 2);
  std::array<double, 4> h;
  for (std::size_t i = 0; i < 4; ++i)
    h[i] = static_cast<double>(shape.relief_m) * shape.quantise(noise[i]) / 65535.0;

  GroundPoint ground;
  if (u + v <= 1) {
    ground.height_m = h[0] + u * (h[1] - h[0]) + v * (h[2] - h[0]);
    ground.normal = unit_normal((h[1] - h[0]) / shape.cell_m, (h[2] - h[0]) / shape.cell_m);
  } else {
    ground.height_m = h[3] + (1 - u) * (h[2] - h[3]) + (1 - v) * (h[1] - h[3]);
    ground.normal = unit_normal((h[3] - h[2]) / shape.cell_m, (h[3] - h[1]) / shape.cell_m);
  }
  return ground;
}

}  // namespace

void sample_ground(const Parameters& terrain, core::BlockCoord block,
                   std::span<const glm::dvec2> local_xz, std::span<GroundPoint> ground) {
  PSYGEN_CHECK(ground.size() == local_xz.size(), "there is room for every point");
  const TerrainShape shape(terrain);
  for (std::size_t i = 0; i < local_xz.size(); ++i)
    ground[i] = ground_at(shape, block, local_xz[i]);
}

double ground_height_m(const Parameters& terrain, core::BlockCoord block, double local_x,
                       double local_z) {
  return ground_at(TerrainShape(terrain), block, {local_x, local_z}).height_m;
}

glm::vec3 ground_normal(const Parameters& terrain, core::BlockCoord block, double local_x,
                        double local_z) {
  return ground_at(TerrainShape(terrain), block, {local_x, local_z}).normal;
}

}  // namespace psygen::models
