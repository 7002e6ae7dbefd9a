#include "editor/view/grid_overlay.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr int kCells = 20;  // on each side of the camera
constexpr int kPieces = 2;  // per line and cell, so that lines follow the ground
constexpr int kMoved = 5;   // cells from the anchor until lines are recomputed
constexpr int kMajorEvery = 10;
// Height of lines above the ground, so that it does not cover them; it grows with the distance.
constexpr double kLiftM = 0.03, kLiftShare = 0.004;
const glm::vec3 kMinor{0.85F, 0.88F, 0.95F}, kMajor{1.0F, 0.72F, 0.25F};

}  // namespace

void GridOverlay::set_spacing(double spacing_m) {
  spacing_m_ = spacing_m;
  stale_ = true;
}

std::span<const render::Line> GridOverlay::lines(const world::World& world,
                                                 const core::WorldPosition& eye) {
  if (spacing_m_ == 0) return {};
  const double block_m = world.block_size_m();
  const double cell_m = spacing_m_ < 0 ? block_m : spacing_m_;
  glm::dvec3 from_eye = core::offset_m(anchor_.block, eye, block_m) + anchor_.local;
  if (std::exchange(world_is_new_, false)) stale_ = differs_from(world, cell_m) || stale_;
  if (stale_ || std::max(std::abs(from_eye.x), std::abs(from_eye.z)) > kMoved * cell_m) {
    make(world, eye, cell_m);
    from_eye = core::offset_m(anchor_.block, eye, block_m) + anchor_.local;
  }
  shown_ = kept_;
  for (render::Line& line : shown_) {
    for (glm::vec3* end : {&line.from, &line.to}) {
      *end += glm::vec3(from_eye);
      end->y += static_cast<float>(kLiftM + kLiftShare * static_cast<double>(glm::length(*end)));
    }
  }
  return shown_;
}

// True if the ground under the grid has changed.
bool GridOverlay::differs_from(const world::World& world, double cell_m) {
  const SurfaceShape now(world);
  const auto before = std::exchange(ground_, now);
  if (!before || !before->has_base_of(now)) return true;
  if (*before == now) return false;
  const double block_m = world.block_size_m(), reach_m = kCells * cell_m;
  const auto block_of = [&](double x_m, double z_m) {
    return core::normalised({anchor_.block, anchor_.local + glm::dvec3(x_m, 0, z_m)}, block_m)
        .block;
  };
  const core::BlockCoord first = block_of(-reach_m, -reach_m), last = block_of(reach_m, reach_m);
  SurfaceDifference differs(*before, now);
  for (std::int64_t x = first.x; x <= last.x; ++x) {
    for (std::int64_t z = first.z; z <= last.z; ++z) {
      if (differs.at({static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)})) return true;
    }
  }
  return false;
}

void GridOverlay::make(const world::World& world, const core::WorldPosition& eye, double cell_m) {
  stale_ = false;
  ++times_made_;
  kept_.clear();
  const double block_m = world.block_size_m();
  // The crossing of lines nearest to the camera, in cells from the world's origin.
  const auto nearest = [&](std::int32_t block, double local) {
    return std::round((block * block_m + local) / cell_m);
  };
  const double middle_x = nearest(eye.block.x, eye.local.x);
  const double middle_z = nearest(eye.block.z, eye.local.z);
  anchor_ = {
      eye.block,
      {middle_x * cell_m - eye.block.x * block_m, 0, middle_z * cell_m - eye.block.z * block_m}};
  const auto point = [&](double x_cells, double z_cells) {
    const glm::dvec3 at{x_cells * cell_m, 0, z_cells * cell_m};
    const double height_m = world::surface_height_m(world, {anchor_.block, anchor_.local + at});
    return glm::vec3(at.x, height_m, at.z);
  };
  const auto colour = [](double cells) {
    return std::fmod(std::abs(cells), kMajorEvery) == 0 ? kMajor : kMinor;
  };
  constexpr int kSide = kCells * kPieces;
  for (int line = -kCells; line <= kCells; ++line) {
    glm::vec3 east = point(-kCells, line), south = point(line, -kCells);
    for (int piece = 1 - kSide; piece <= kSide; ++piece) {
      const double along = static_cast<double>(piece) / kPieces;
      const glm::vec3 next_east = point(along, line), next_south = point(line, along);
      kept_.push_back({east, next_east, colour(middle_z + line)});
      kept_.push_back({south, next_south, colour(middle_x + line)});
      east = next_east;
      south = next_south;
    }
  }
}

}  // namespace psygen::editor
