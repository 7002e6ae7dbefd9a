#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <tuple>

#include "engine/core/cancellation.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/curve.hpp"
#include "engine/world/ground_below.hpp"
#include "engine/world/water_shapes.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

using models::LakePiece;
using models::LakeSegment;

constexpr std::size_t kTileSegments = 10;  // a tile near more segments is split, if it is not small
constexpr double kSmallTile = 8;           // side of a small tile in cells
constexpr std::size_t kMaxTiles = 4096;
constexpr double kHighDamM = 5;  // higher dams get a warning

double doubled_area(const std::vector<glm::dvec2>& line) {
  double sum = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const glm::dvec2 a = line[i] - line[0], b = line[(i + 1) % line.size()] - line[0];
    sum += a.x * b.y - b.x * a.y;
  }
  return sum;
}

bool holds(const std::vector<LakeSegment>& outline, glm::dvec2 place_m) {
  bool inside = false;
  for (const LakeSegment& s : outline) {
    if ((s.from_m.y > place_m.y) == (s.to_m.y > place_m.y)) continue;
    const double share = (place_m.y - s.from_m.y) / (s.to_m.y - s.from_m.y);
    if (place_m.x < s.from_m.x + share * (s.to_m.x - s.from_m.x)) inside = !inside;
  }
  return inside;
}

// Makes one lake.
class LakeMaker {
 public:
  LakeMaker(const World& world, const models::EditLayer& below, const Lake& lake,
            const BodyName& name)
      : world_(world),
        below_(world, below),
        lake_(lake),
        name_(name),
        block_m_(world.block_size_m()) {}

  tl::expected<WaterEdits, WaterError> make() {
    for (const auto step :
         {&LakeMaker::check_values, &LakeMaker::draw_outline, &LakeMaker::check_outline,
          &LakeMaker::find_level, &LakeMaker::check_others}) {
      if (auto ok = (this->*step)(); !ok) return tl::unexpected(ok.error());
    }
    // Whole metres and powers of two, so that tiles meet exactly.
    double side_m = 1;
    while (side_m < std::max(box_.size().x, box_.size().y) + 2 * margin_m() + 1)
      side_m *= 2;
    if (auto ok = tile(glm::floor(box_.low - margin_m()), side_m, outline_); !ok)
      return tl::unexpected(ok.error());
    return std::move(made_);
  }

 private:
  using Done = tl::expected<void, WaterError>;

  std::string_view key() const { return lake_.points_m.empty() ? "radius_m" : "points_m"; }
  double edge_m() const { return 2 * world_.cell_m(); }
  double margin_m() const { return std::max(lake_.shore_m, edge_m()); }

  // Refuses values that no file could have, too.
  Done check_values() {
    if (!lake_.points_m.empty()) {
      if (auto ok = check_points(lake_.points_m, 3); !ok) return ok;
      if (length_of(lake_.points_m.back() - lake_.points_m.front()) < kMinWaterStepM)
        return water_error("points_m", fmt::format("the last point must be at least {:g} m from "
                                                   "the first one, because the outline closes by "
                                                   "itself",
                                                   kMinWaterStepM));
    } else if (auto in_range = check_range("radius_m", lake_.radius_m, 1, kMaxLakeM / 2);
               !in_range) {
      return in_range;
    } else if (auto ok = check_points({lake_.centre_m}, 1); !ok) {
      return water_error("centre_m", "the centre is not finite or too far away");
    }
    for (const auto& [name, value, most] : {std::tuple("depth_m", lake_.depth_m, kMaxLakeDepthM),
                                            std::tuple("shore_m", lake_.shore_m, kMaxShoreM)}) {
      if (auto ok = check_range(name, value, kMinDepthM, most); !ok) return ok;
    }
    return {};
  }

  // The outline with the outside at (z, −x) of its direction.
  Done draw_outline() {
    FlatBox rough;
    for (const glm::dvec2& point : lake_.points_m)
      rough.add(point);
    const glm::dvec2 size_m =
        lake_.points_m.empty() ? glm::dvec2(2 * lake_.radius_m) : rough.size();
    const double widest_m = std::max(size_m.x, size_m.y);
    if (widest_m > kMaxLakeM) return too_wide(widest_m);
    const double step_m = std::max(2 * world_.cell_m(), std::clamp(widest_m / 80, 3.0, 10.0));
    if (lake_.points_m.empty()) {
      constexpr double kAround = 6.283185307179586;
      const int corners = std::max(12, static_cast<int>(kAround * lake_.radius_m / step_m));
      for (int i = 0; i < corners; ++i) {
        const double angle = 360.0 * i / corners;
        line_.push_back(lake_.centre_m +
                        lake_.radius_m * glm::dvec2(models::exact_cos_degrees(angle),
                                                    models::exact_sin_degrees(angle)));
      }
    } else {
      line_ = closed_curve_through(lake_.points_m, step_m);
    }
    if (doubled_area(line_) < 0) std::ranges::reverse(line_);
    for (const glm::dvec2& point : line_)
      box_.add(point);
    const double wide_m = std::max(box_.size().x, box_.size().y);
    if (wide_m > 1.1 * kMaxLakeM) return too_wide(wide_m);
    return {};
  }
  Done too_wide(double wide_m) const {
    return water_error(
        key(),
        fmt::format("the lake is {:.0f} m wide, but at most {:g} m are allowed", wide_m, kMaxLakeM),
        core::ErrorCode::kOverBudget);
  }

  Done check_outline() {
    for (const auto& [blocks, wide_m] :
         {std::pair{world_.blocks_x, box_.size().x}, std::pair{world_.blocks_z, box_.size().y}}) {
      if (blocks != 0 && wide_m + 2 * lake_.shore_m >= static_cast<double>(blocks) * block_m_)
        return water_error(
            key(), fmt::format("the lake with its shore is as large as the world: "
                               "{:.0f} m of {:.0f} m",
                               wide_m + 2 * lake_.shore_m, static_cast<double>(blocks) * block_m_));
    }
    for (const glm::dvec2& point : line_) {
      for (const double x : {-margin_m(), margin_m()}) {
        for (const double z : {-margin_m(), margin_m()}) {
          if (!world_.contains(world_.position(point + glm::dvec2(x, z)).block))
            return water_error(key(), fmt::format("the lake with its shore leaves the world near "
                                                  "{:.1f}, {:.1f} m",
                                                  point.x, point.y));
        }
      }
    }
    if (std::min(box_.size().x, box_.size().y) < 4 * world_.cell_m())
      return water_error(key(),
                         fmt::format("a lake of {:.1f} x {:.1f} m is narrower than four cells "
                                     "of the ground, {:g} m",
                                     box_.size().x, box_.size().y, 4 * world_.cell_m()));
    if (const auto at = self_crossing(line_, true))
      return water_error(
          key(), fmt::format("the outline crosses itself near {:.1f}, {:.1f} m", at->x, at->y));
    return {};
  }

  Done find_level() {
    double lowest_m = std::numeric_limits<double>::infinity();
    glm::dvec2 lowest_at{0.0};
    for (const glm::dvec2& point : line_) {
      const double ground_m = below_.ground_m(point);
      if (ground_m < lowest_m) lowest_m = ground_m, lowest_at = point;
    }
    level_m_ = lake_.spill_m.value_or(lowest_m);
    const double relief_m = world_.terrain.real(models::kTerrainReliefM);
    if (!(level_m_ >= 0 && level_m_ <= relief_m))
      return water_error("spill_m",
                         fmt::format("a surface at {:g} m is not allowed: it must be 0 to "
                                     "{:g} m, the height range of the terrain (relief_m)",
                                     level_m_, relief_m));
    if (world_.water.exists() && level_m_ < world_.water.level_m)
      return water_error(lake_.spill_m ? "spill_m" : key(),
                         fmt::format("the surface at {:.2f} m would lie below the sea, {:g} m",
                                     level_m_, world_.water.level_m));
    if (level_m_ - lowest_m > kHighDamM)
      made_.warnings.push_back(
          fmt::format("{}: its surface at {:.1f} m needs a dam of {:.1f} m at {:.1f}, {:.1f} m",
                      name_.text, level_m_, level_m_ - lowest_m, lowest_at.x, lowest_at.y));
    return {};
  }

  Done check_others() {
    make_outline();
    std::vector<glm::dvec2> places = line_;
    constexpr int kGrid = 24;
    for (int z = 0; z <= kGrid; ++z) {
      for (int x = 0; x <= kGrid; ++x) {
        const glm::dvec2 at_m = box_.low + box_.size() * glm::dvec2(x, z) / double{kGrid};
        if (holds(outline_, at_m - line_.front())) places.push_back(at_m);
      }
    }
    for (const glm::dvec2& at_m : places) {
      const auto water = below_.water_over(at_m);
      if (!water) continue;
      if (water->is_river() && !water->is_of_network()) continue;
      return water_error(key(),
                         fmt::format("the lake overlaps {} near {:.1f}, {:.1f} m",
                                     water->is_of_network() ? "a river or lake of the river network"
                                                            : "another lake",
                                     at_m.x, at_m.y));
    }
    return {};
  }

  void make_outline() {
    const std::size_t n = line_.size();
    std::vector<glm::dvec2> normals(n);
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec2 along = line_[(i + 1) % n] - line_[i];
      normals[i] = glm::dvec2(along.y, -along.x) / std::max(length_of(along), 1e-9);
    }
    for (std::size_t i = 0; i < n; ++i)
      outline_.push_back({line_[i] - line_[0], line_[(i + 1) % n] - line_[0],
                          normals[(i + n - 1) % n] + normals[i],
                          normals[i] + normals[(i + 1) % n]});
  }

  // Adds the tiles of a square at a corner in metres of the world. `near` are segments around it.
  Done tile(glm::dvec2 corner_m, double side_m, const std::vector<LakeSegment>& near) {
    if (auto ok = core::check_cancelled(); !ok)
      return tl::unexpected(WaterError{key(), ok.error()});
    LakePiece piece;
    piece.low_m = corner_m - line_[0];
    piece.high_m = corner_m + side_m - line_[0];
    const FlatBox box = FlatBox::around(piece.low_m, piece.high_m);
    bool shapes = false;
    for (const LakeSegment& segment : near) {
      const FlatBox of = FlatBox::around(segment.from_m, segment.to_m);
      shapes = shapes || of.touches(box, margin_m());
      // Every place of the tile finds its nearest segment among these.
      if (of.touches(box, margin_m() + 1.4143 * side_m)) piece.segments.push_back(segment);
    }
    if (!shapes) piece.segments.clear();
    keep_nearest(piece.segments, box.centre(), 1.4143 * side_m);
    if (shapes && piece.segments.size() > kTileSegments && side_m > kSmallTile * world_.cell_m()) {
      const double half_m = side_m / 2;
      for (int q = 0; q < 4; ++q) {
        const glm::dvec2 at = corner_m + half_m * glm::dvec2(q & 1, q >> 1);
        if (auto ok = tile(at, half_m, piece.segments); !ok) return ok;
      }
      return {};
    }
    piece.inside = holds(outline_, box.centre());
    if (!shapes && !piece.inside) return {};
    if (made_.edits.size() >= kMaxTiles)
      return water_error(key(), "the outline of the lake has too many bends",
                         core::ErrorCode::kOverBudget);
    add_tile(std::move(piece), corner_m, corner_m + side_m);
    return {};
  }

  // Keeps the segments of which one may be nearest to a place of a square with this diagonal.
  static void keep_nearest(std::vector<LakeSegment>& segments, glm::dvec2 centre_m,
                           double diagonal_m) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const LakeSegment& segment : segments)
      nearest_m = std::min(nearest_m, distance_m(segment, centre_m));
    std::erase_if(segments, [&](const LakeSegment& segment) {
      return distance_m(segment, centre_m) > nearest_m + diagonal_m + 1e-6;
    });
  }
  static double distance_m(const LakeSegment& segment, glm::dvec2 place_m) {
    const double share = nearest_share(segment.from_m, segment.to_m, place_m);
    return length_of(place_m - segment.from_m - (segment.to_m - segment.from_m) * share);
  }

  // The square of the edit encloses the part of the tile that water or shore reach.
  void add_tile(LakePiece piece, glm::dvec2 low_m, glm::dvec2 high_m) {
    low_m = glm::max(low_m, box_.low - margin_m());
    high_m = glm::max(glm::min(high_m, box_.high + margin_m()), low_m);
    const glm::dvec2 half_m = (high_m - low_m) / 2.0;
    piece.origin = world_.position(line_[0]);
    piece.body = name_.body;
    piece.level_m = level_m_;
    piece.depth_m = lake_.depth_m;
    piece.shore_m = lake_.shore_m;
    piece.edge_m = edge_m();
    models::GroundEdit edit;
    edit.change = models::GroundChange::kLake;
    edit.square = true;
    edit.centre = world_.position(low_m + half_m);
    edit.radius_m = std::max(half_m.x, half_m.y) + 1e-6;
    seal(piece);
    edit.lake = std::make_shared<const LakePiece>(std::move(piece));
    edit.height_m = below_.max_moved_m(edit);
    made_.edits.push_back(std::move(edit));
  }

  const World& world_;
  GroundBelow below_;
  const Lake& lake_;
  const BodyName& name_;
  double block_m_;
  std::vector<glm::dvec2> line_;  // in metres of the world
  FlatBox box_;
  std::vector<LakeSegment> outline_;  // in metres from its first point
  double level_m_ = 0;
  WaterEdits made_;
};

}  // namespace

tl::expected<WaterEdits, WaterError> lake_edits(const World& world, const models::EditLayer& below,
                                                const Lake& lake, const BodyName& name) {
  return LakeMaker(world, below, lake, name).make();
}

}  // namespace psygen::world
