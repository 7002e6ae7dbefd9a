#include "engine/world/road_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/core/cancellation.hpp"
#include "engine/world/curve.hpp"
#include "engine/world/ground_below.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

using models::GroundEdit;
using models::RoadPiece;
using models::RoadSegment;

// Maximum number of a piece's own segments.
constexpr std::size_t kPieceSegments = 12;
// Maximum number of segments of a road near one of its pieces: a road may cross itself but not
// cover an area.
constexpr std::size_t kMaxNear = 1000;

// Averages the heights, weighted by a tent over `smoothing_m` on both sides, or less at the ends.
void smooth(std::vector<RoadPoint>& line, double smoothing_m) {
  std::vector<double> means;
  const double end_m = line.back().along_m;
  std::size_t first = 0;
  for (const RoadPoint& point : line) {
    const double wide_m = std::min({smoothing_m, point.along_m, end_m - point.along_m});
    while (first > 0 && line[first - 1].along_m > point.along_m - wide_m)
      --first;
    while (line[first].along_m < point.along_m - wide_m)
      ++first;
    double sum = 0, weights = 0;
    for (std::size_t i = first; i < line.size() && line[i].along_m <= point.along_m + wide_m; ++i) {
      const double away = std::abs(line[i].along_m - point.along_m);
      const double weight = wide_m > 0 ? 1 - away / wide_m : 1;
      sum += weight * line[i].height_m;
      weights += weight;
    }
    means.push_back(weights > 0 ? sum / weights : point.height_m);
  }
  for (std::size_t i = 0; i < line.size(); ++i)
    line[i].height_m = means[i];
}

// The segments of a road, in groups of kPieceSegments: one for each piece.
struct Segments {
  std::vector<RoadSegment> all;
  std::vector<FlatBox> boxes;  // of the groups

  explicit Segments(const std::vector<RoadPoint>& line) {
    const glm::dvec2 origin_m = line.front().at_m;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const RoadPoint &from = line[i - 1], &to = line[i];
      if (all.size() % kPieceSegments == 0) boxes.emplace_back();
      all.push_back({from.at_m - origin_m, to.at_m - origin_m, from.height_m, to.height_m});
      boxes.back().add(all.back().from_m);
      boxes.back().add(all.back().to_m);
    }
  }

  // Sets a piece's own segments, those of group `p`, and all others that may be nearest to its
  // points. Stops at more than kMaxNear.
  void give(RoadPiece& piece, std::size_t p) const {
    const double within_m = 2 * (piece.half_width_m + piece.border_m) + 1e-6;
    for (std::size_t q = 0; q < boxes.size() && piece.segments.size() <= kMaxNear; ++q) {
      if (q == p) piece.first = piece.segments.size();
      if (!boxes[q].touches(boxes[p], within_m)) continue;
      const std::size_t end = std::min((q + 1) * kPieceSegments, all.size());
      for (std::size_t i = q * kPieceSegments; i < end; ++i) {
        if (q == p || FlatBox::around(all[i].from_m, all[i].to_m).touches(boxes[p], within_m))
          piece.segments.push_back(all[i]);
      }
      if (q == p) piece.end = piece.segments.size();
    }
  }
};

}  // namespace

std::vector<RoadPoint> road_line(const Road& road, double step_m,
                                 const std::function<double(glm::dvec2)>& height_at) {
  std::vector<RoadPoint> line;
  for (const CurvePoint& point : curve_through(road.points_m, step_m))
    line.push_back({point.at_m, point.along_m, height_at(point.at_m)});
  // Two passes with a tent make a smooth bell.
  smooth(line, road.smoothing_m / 2);
  smooth(line, road.smoothing_m / 2);
  return line;
}

core::Result<std::vector<GroundEdit>> road_edits(const World& world, const models::EditLayer& below,
                                                 const Road& road) {
  const GroundBelow ground(world, below);
  const double step_m = std::max(world.cell_m(), std::clamp(road.width_m / 3, 1.0, 10.0));
  const Segments segments(
      road_line(road, step_m, [&](glm::dvec2 at_m) { return ground.ground_m(at_m); }));
  std::vector<GroundEdit> edits;
  for (std::size_t p = 0; p < segments.boxes.size(); ++p) {
    if (auto ok = core::check_cancelled(); !ok) return tl::unexpected(ok.error());
    RoadPiece piece;
    piece.origin = world.position(road.points_m.front());
    piece.half_width_m = road.width_m / 2;
    piece.border_m = road.border_m;
    piece.clear_m = road.clear_m;
    segments.give(piece, p);
    if (piece.segments.size() > kMaxNear)
      return core::fail(
          core::ErrorCode::kOverBudget,
          fmt::format("more than {} pieces of the road are close together", kMaxNear));
    GroundEdit edit = ground.square_around(segments.boxes[p], piece.origin, piece.reach_m());
    edit.change = models::GroundChange::kRoad;
    edit.road = std::make_shared<const RoadPiece>(std::move(piece));
    edit.height_m = ground.max_moved_m(edit);
    edits.push_back(std::move(edit));
  }
  return edits;
}

}  // namespace psygen::world
