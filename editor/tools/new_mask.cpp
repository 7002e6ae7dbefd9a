#include "editor/tools/new_mask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr double kWholeWorldM = 4096;    // larger worlds get a square around a point
constexpr double kDefaultPixels = 1024;  // a side, at most
constexpr double kGridFraction = 1.0 / 16;
constexpr double kMinFall = 0.01;  // slope of a view below the horizon that meets the ground

glm::dvec2 size_m(const world::World& world) {
  return glm::dvec2(double(world.blocks_x), double(world.blocks_z)) * world.block_size_m();
}

core::Result<std::uint32_t> pixels_of(double side_m, double pixel_m) {
  const double pixels = std::max(std::ceil(side_m / pixel_m), double{NewMask::kMinPixels});
  if (pixels <= NewMask::kMaxPixels) return static_cast<std::uint32_t>(pixels);
  return core::fail(core::ErrorCode::kOverBudget,
                    fmt::format("A mask of {:.0f} m with {:g} m per pixel has {:.0f} pixels a side "
                                "(allowed: {}). Make the area smaller or the pixels larger.",
                                side_m, pixel_m, pixels, NewMask::kMaxPixels));
}

}  // namespace

NewMask default_new_mask(const world::World& world) {
  NewMask mask;
  const glm::dvec2 size = size_m(world);
  double side_m = mask.side_m;
  mask.whole_world = !world.is_endless() && std::max(size.x, size.y) <= kWholeWorldM;
  if (mask.whole_world) side_m = std::max(size.x, size.y);
  while (side_m / mask.pixel_m > kDefaultPixels)
    mask.pixel_m *= 2;
  return mask;
}

std::array<double, 4> area_of(const NewMask& mask, const world::World& world, glm::dvec2 around_m) {
  if (mask.whole_world && !world.is_endless()) {
    const glm::dvec2 size = size_m(world);
    return {0, 0, size.x, size.y};
  }
  const double step_m = std::max(1.0, std::round(mask.side_m * kGridFraction));
  const auto corner = [&](double at_m) {
    return std::round((at_m - mask.side_m / 2) / step_m) * step_m;
  };
  const glm::dvec2 low(corner(around_m.x), corner(around_m.y));
  return {low.x, low.y, low.x + mask.side_m, low.y + mask.side_m};
}

core::Result<MaskPlan> plan_of(const NewMask& mask, const world::World& world,
                               glm::dvec2 around_m) {
  const auto out_of_range = [](const char* name, double value, double least, double most) {
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("A new mask's {} is {:g} m (allowed: {:g} to {:g} m).", name,
                                  value, least, most));
  };
  // Rejects NaN too.
  const auto within = [](double value, double least, double most) {
    return value >= least && value <= most;
  };
  if (!within(mask.side_m, NewMask::kMinSideM, NewMask::kMaxSideM))
    return out_of_range("side", mask.side_m, NewMask::kMinSideM, NewMask::kMaxSideM);
  if (!within(mask.pixel_m, NewMask::kMinPixelM, NewMask::kMaxPixelM))
    return out_of_range("pixel", mask.pixel_m, NewMask::kMinPixelM, NewMask::kMaxPixelM);
  MaskPlan plan{area_of(mask, world, around_m)};
  const auto width = pixels_of(plan.area_m[2] - plan.area_m[0], mask.pixel_m);
  if (!width) return tl::unexpected(width.error());
  const auto height = pixels_of(plan.area_m[3] - plan.area_m[1], mask.pixel_m);
  if (!height) return tl::unexpected(height.error());
  plan.width = *width, plan.height = *height;
  return plan;
}

glm::dvec2 middle_of_view(const core::CameraPose& pose, const world::World& world, double max_m) {
  const double above_m =
      std::max(0.0, pose.position.local.y - world::surface_height_m(world, pose.position));
  const double fall = -std::tan(pose.pitch);
  const double away_m = fall > kMinFall ? std::min(above_m / fall, max_m) : max_m;
  return world.metres(pose.position) + away_m * glm::dvec2(std::sin(pose.yaw), -std::cos(pose.yaw));
}

}  // namespace psygen::editor
