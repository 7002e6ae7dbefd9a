#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/cancellation.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/world/curve.hpp"
#include "engine/world/ground_below.hpp"
#include "engine/world/river_course.hpp"
#include "engine/world/water_shapes.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

tl::expected<void, WaterError> check_range(std::string_view key, double value, double least,
                                           double most) {
  if (value >= least && value <= most) return {};
  return water_error(
      key, fmt::format("{:g} is not allowed: it must be {:g} to {:g}", value, least, most));
}

tl::expected<void, WaterError> check_points(const std::vector<glm::dvec2>& points,
                                            std::size_t least) {
  if (points.size() < least || points.size() > kMaxWaterPoints)
    return water_error("points_m", fmt::format("it must be {} to {} points, not {}", least,
                                               kMaxWaterPoints, points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto usable = [](double v) { return std::abs(v) <= kFarthestShapeM; };  // not NaN
    if (!usable(points[i].x) || !usable(points[i].y))
      return water_error("points_m", fmt::format("point {} is not finite or too far away", i));
    if (i > 0 && length_of(points[i] - points[i - 1]) < kMinWaterStepM)
      return water_error("points_m", fmt::format("point {} must be at least {:g} m from the "
                                                 "previous one",
                                                 i, kMinWaterStepM));
  }
  return {};
}

namespace {

using models::RiverPiece;
using models::RiverPoint;

constexpr std::size_t kRiverSegments = 12;
// Maximum number of segments of a river near one of its pieces: a river may bend but not cover an
// area.
constexpr std::size_t kMaxRiverNear = 1000;
constexpr double kDeepCutM = 20;      // deeper cuts get a warning
constexpr double kFreeboardM = 0.15;  // of the surface below the lowest ground across, at least
constexpr double kFreeboard = 0.1;    // of the depth, in addition
constexpr double kGentleCut = 1.2;    // width of the bank over the depth of a cut
constexpr double kMaxBankM = 80;
constexpr double kFastestM_S = 12;

// Means weighted by a tent over `reach_m` on both sides of each point. Ends continue as they are,
// so values that never rise still never rise.
std::vector<double> smoothed(const std::vector<CurvePoint>& curve,
                             const std::vector<double>& values, double reach_m) {
  if (!(reach_m > 0)) return values;
  std::vector<double> means;
  const double end_m = curve.back().along_m;
  std::size_t first = 0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double here_m = curve[i].along_m;
    while (curve[first].along_m < here_m - reach_m)
      ++first;
    double sum = 0, weights = 0;
    const auto add = [&](double at_m, double value) {
      const double weight = 1 - std::abs(at_m - here_m) / reach_m;
      if (weight <= 0) return;
      sum += weight * value;
      weights += weight;
    };
    for (std::size_t k = first; k < curve.size() && curve[k].along_m <= here_m + reach_m; ++k)
      add(curve[k].along_m, values[k]);
    const double step_m = end_m / static_cast<double>(curve.size() - 1);
    for (double at_m = -step_m; at_m > here_m - reach_m; at_m -= step_m)
      add(at_m, values.front());
    for (double at_m = end_m + step_m; at_m < here_m + reach_m; at_m += step_m)
      add(at_m, values.back());
    means.push_back(sum / weights);
  }
  return means;
}

void never_rise(std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    values[i] = std::min(values[i], values[i - 1]);
}

// Makes one river.
class RiverMaker {
 public:
  RiverMaker(const World& world, const models::EditLayer& below, const River& river,
             const BodyName& name)
      : world_(world), below_(world, below), river_(river), name_(name) {}

  tl::expected<WaterEdits, WaterError> make() {
    if (auto ok = check(); !ok) return tl::unexpected(ok.error());
    measure();
    if (auto ok = meet_others(); !ok) return tl::unexpected(ok.error());
    lay_surface();
    describe();
    return cut_in_pieces();
  }

 private:
  // Measurements at a point of the curve.
  struct Sample {
    double half_m = 0, depth_m = 0;
    glm::dvec2 direction{1, 0};
    double middle_m = 0;  // ground under the middle
    double bound_m = 0;   // highest surface that its surroundings allow
    bool in_lake = false;
    bool in_river = false;
  };

  // Refuses a list that has neither one number nor one for each point, or numbers out of range.
  tl::expected<void, WaterError> check_list(std::string_view key, const std::vector<double>& list,
                                            double least, double most) const {
    if (list.size() != 1 && list.size() != river_.points_m.size())
      return water_error(key, fmt::format("a river of {} points needs one number or as many, not "
                                          "{}",
                                          river_.points_m.size(), list.size()));
    for (const double number : list) {
      if (auto ok = check_range(key, number, least, most); !ok) return ok;
    }
    return {};
  }
  // Refuses values that no file could have, too.
  tl::expected<void, WaterError> check_values() const {
    if (auto ok = check_points(river_.points_m, 2); !ok) return ok;
    if (auto ok = check_list("width_m", river_.width_m, kMinRiverM, kMaxRiverWidthM); !ok)
      return ok;
    if (auto ok = check_list("depth_m", river_.depth_m, kMinDepthM, kMaxRiverDepthM); !ok)
      return ok;
    if (!river_.discharge_m3_s.empty()) {
      if (auto ok = check_list("discharge_m3_s", river_.discharge_m3_s, 0, kMaxDischarge); !ok)
        return ok;
    }
    if (auto ok = check_range("bank_m", river_.bank_m, kMinRiverM, kMaxRiverBankM); !ok) return ok;
    if (auto ok = check_range("smoothing_m", river_.smoothing_m, 0, kMaxSmoothingM); !ok) return ok;
    if (const double length_m = chords_m(river_.points_m); length_m > kMaxRiversM)
      return water_error("points_m",
                         fmt::format("the river is {:.0f} m long, but at most {:g} m are allowed",
                                     length_m, kMaxRiversM),
                         core::ErrorCode::kOverBudget);
    return {};
  }

  tl::expected<void, WaterError> check() {
    if (auto ok = check_values(); !ok) return ok;
    const double narrowest_m = *std::ranges::min_element(river_.width_m);
    if (narrowest_m < 2 * world_.cell_m())
      return water_error("width_m", fmt::format("a river {:g} m wide is narrower than two cells of "
                                                "the ground, {:g} m",
                                                narrowest_m, 2 * world_.cell_m()));
    curve_ = river_curve(world_, river_);
    std::vector<glm::dvec2> line;
    for (const CurvePoint& point : curve_) {
      if (!world_.contains(world_.position(point.at_m).block))
        return water_error("points_m", fmt::format("the river leaves the world at {:.1f}, {:.1f} m",
                                                   point.at_m.x, point.at_m.y));
      line.push_back(point.at_m);
    }
    if (const auto at = self_crossing(line, false))
      return water_error(
          "points_m", fmt::format("the river crosses itself near {:.1f}, {:.1f} m", at->x, at->y));
    return {};
  }

  void measure() {
    samples_.resize(curve_.size());
    for (std::size_t i = 0; i < curve_.size(); ++i) {
      Sample& s = samples_[i];
      s.half_m = value_at(river_.width_m, curve_[i]) / 2;
      s.depth_m = value_at(river_.depth_m, curve_[i]);
      const glm::dvec2 along =
          curve_[std::min(i + 1, curve_.size() - 1)].at_m - curve_[i > 0 ? i - 1 : 0].at_m;
      const double length_m = length_of(along);
      s.direction = length_m > 0 ? along / length_m : glm::dvec2(1, 0);
      measure_across(curve_[i].at_m, s);
    }
  }

  // Looks at the ground across the water and a little beyond.
  void measure_across(glm::dvec2 at_m, Sample& s) const {
    const glm::dvec2 side{-s.direction.y, s.direction.x};
    const double cell_m = world_.cell_m();
    const int steps = std::clamp(static_cast<int>(std::ceil(s.half_m / (2 * cell_m))), 1, 4);
    s.middle_m = below_.ground_m(at_m);
    double lowest_m = s.middle_m;
    for (int k = -steps - 1; k <= steps + 1; ++k) {
      if (k == 0) continue;
      double across_m = s.half_m * k / steps;
      if (std::abs(k) > steps) across_m = (k < 0 ? -1 : 1) * (s.half_m + 2 * cell_m);
      lowest_m = std::min(lowest_m, below_.ground_m(at_m + side * across_m));
    }
    s.bound_m = lowest_m - kFreeboardM - kFreeboard * s.depth_m;
  }

  // True for a narrower river of the network, which this one takes up on its way.
  bool takes_up(const models::BodySurface& water, std::size_t i) const {
    return water.is_river() && water.is_of_network() && water.width_m <= 2 * samples_[i].half_m;
  }
  // Finds the lakes and rivers on the way. Other rivers may only be at its ends.
  tl::expected<void, WaterError> meet_others() {
    const std::size_t n = curve_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto water = below_.water_over(curve_[i].at_m);
      if (!water) continue;
      if (i > 0 && i + 1 < n && takes_up(*water, i)) {
        samples_[i].bound_m = std::min(samples_[i].bound_m, water->surface_m);
        continue;
      }
      samples_[i].in_river = water->is_river();
      samples_[i].in_lake = !water->is_river();
      samples_[i].bound_m = water->surface_m;
    }
    std::size_t first = 0, end = n;
    while (first < n && samples_[first].in_river)
      ++first;
    if (first == n) return water_error("points_m", "the whole river lies in another river");
    while (samples_[end - 1].in_river)
      --end;
    for (std::size_t i = first; i < end; ++i) {
      const auto at_m = river_before(i, first);
      if (!at_m) continue;
      const bool of_network = below_.water_over(*at_m)->is_of_network();
      return water_error(
          "points_m",
          fmt::format("the river crosses {} near {:.1f}, {:.1f} m; it may only begin or end in one",
                      of_network ? "a wider river of the network" : "another river", at_m->x,
                      at_m->y));
    }
    return {};
  }
  // A place in another river from behind the point before `i`, if that is not before `first`, to
  // point `i`.
  std::optional<glm::dvec2> river_before(std::size_t i, std::size_t first) const {
    if (samples_[i].in_river) return curve_[i].at_m;
    if (i == first) return std::nullopt;
    const glm::dvec2 from_m = curve_[i - 1].at_m, way = curve_[i].at_m - from_m;
    const int steps = static_cast<int>(std::ceil(length_of(way) / world_.cell_m()));
    for (int k = 1; k < steps; ++k) {
      const glm::dvec2 at_m = from_m + way * (static_cast<double>(k) / steps);
      const auto water = below_.water_over(at_m);
      if (water && water->is_river() && !takes_up(*water, i)) return at_m;
    }
    return std::nullopt;
  }

  // The height of the water at each point: it never rises, and meets lakes, rivers and the sea.
  void lay_surface() {
    const std::size_t n = curve_.size();
    const double sea_m =
        world_.water.exists() ? world_.water.level_m : -std::numeric_limits<double>::infinity();
    std::vector<double> bound(n), floor(n);
    double highest_m = sea_m;
    bool at_end = true;  // from here on in another river
    for (std::size_t i = n; i-- > 0;) {
      at_end = at_end && samples_[i].in_river;
      if (samples_[i].in_lake || at_end) highest_m = std::max(highest_m, samples_[i].bound_m);
      floor[i] = std::max(highest_m, 0.0);
      bound[i] = std::max(samples_[i].bound_m, sea_m);
    }
    warn_of_climb(bound, floor);
    surface_ = bound;
    never_rise(surface_);
    surface_ = smoothed(curve_, surface_, river_.smoothing_m);
    for (std::size_t i = 0; i < n; ++i)
      surface_[i] = std::max(std::min(surface_[i], bound[i]), floor[i]);
    never_rise(surface_);
    bed_.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      bed_[i] = std::max(surface_[i] - samples_[i].depth_m, 0.0);
    never_rise(bed_);
  }

  void warn_of_climb(const std::vector<double>& bound, const std::vector<double>& floor) {
    double worst_m = 1;
    std::optional<std::size_t> at;
    double lowest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < bound.size(); ++i) {
      lowest_m = std::min(lowest_m, bound[i]);
      if (floor[i] - lowest_m > worst_m) worst_m = floor[i] - lowest_m, at = i;
    }
    if (at)
      warn(
          "the ground at {:.1f}, {:.1f} m lies {:.1f} m below the water in which it ends or "
          "through which it passes",
          curve_[*at].at_m.x, curve_[*at].at_m.y, worst_m);
  }

  void describe() {
    const std::size_t n = curve_.size();
    std::vector<double> banks(n);
    std::size_t deepest = 0;
    const auto cut_m = [&](std::size_t i) { return samples_[i].middle_m - surface_[i]; };
    for (std::size_t i = 0; i < n; ++i) {
      banks[i] = river_.bank_m + kGentleCut * std::max(cut_m(i) - river_.bank_m / 2, 0.0);
      banks[i] = std::min(banks[i], std::max(river_.bank_m, kMaxBankM));
      if (cut_m(i) > cut_m(deepest)) deepest = i;
    }
    if (cut_m(deepest) > kDeepCutM)
      warn("it cuts {:.0f} m into the ground at {:.1f}, {:.1f} m, because its course climbs there",
           cut_m(deepest), curve_[deepest].at_m.x, curve_[deepest].at_m.y);
    banks = smoothed(curve_, banks, 3 * river_.bank_m);
    const glm::dvec2 origin_m = curve_.front().at_m;
    double foam = 0;
    for (std::size_t i = 0; i < n; ++i) {
      RiverPoint p;
      p.at_m = curve_[i].at_m - origin_m;
      p.direction = samples_[i].direction;
      p.half_width_m = samples_[i].half_m;
      p.surface_m = surface_[i];
      p.bed_m = bed_[i];
      p.bank_m = banks[i];
      const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, n - 1);
      const double run_m = curve_[after].along_m - curve_[before].along_m;
      p.fall = run_m > 0 ? (surface_[before] - surface_[after]) / run_m : 0;
      p.discharge_m3_s = discharge_m3_s(i);
      p.speed_m_s = std::min(p.discharge_m3_s / models::cross_section_m2(p), kFastestM_S);
      const double drift_m = i > 0 ? curve_[i].along_m - curve_[i - 1].along_m : 0;
      foam = std::max(models::foam_of_fall(p.fall), foam - drift_m / 15);  // drifts 15 m
      p.foam = std::max(foam, 0.0);
      points_.push_back(p);
    }
    warn_of_end();
  }

  double discharge_m3_s(std::size_t i) const {
    if (!river_.discharge_m3_s.empty()) return value_at(river_.discharge_m3_s, curve_[i]);
    const double width_m = 2 * samples_[i].half_m;
    // Manning: √0.001 / 0.035 times the mean depth to the power of 2/3.
    const double mean_m = samples_[i].depth_m * 2 / 3;
    return 0.9035 * models::exact_pow(mean_m, 2.0 / 3) * mean_m * width_m;
  }

  void warn_of_end() {
    const glm::dvec2 end_m = curve_.back().at_m;
    const Sample& last = samples_.back();
    if (last.in_river || last.in_lake || name_.flows_on) return;
    if (world_.water.exists() && last.middle_m <= world_.water.level_m) return;
    const double near_m = 2 * last.half_m + 2 * world_.cell_m();
    for (const glm::dvec2& beyond : {glm::dvec2(near_m, 0), glm::dvec2(-near_m, 0),
                                     glm::dvec2(0, near_m), glm::dvec2(0, -near_m)}) {
      if (!world_.contains(world_.position(end_m + beyond).block)) return;
    }
    warn(
        "it ends on dry land at {:.1f}, {:.1f} m, not in a lake, the sea or another river, nor at "
        "the world's border",
        end_m.x, end_m.y);
  }

  template <class... Values>
  void warn(fmt::format_string<Values&...> sentence, Values&&... values) {
    made_.warnings.push_back(name_.text + ": " + fmt::format(sentence, values...));
  }

  tl::expected<WaterEdits, WaterError> cut_in_pieces() {
    const core::WorldPosition origin = world_.position(curve_.front().at_m);
    const std::size_t segments = points_.size() - 1;
    std::vector<FlatBox> boxes((segments + kRiverSegments - 1) / kRiverSegments);
    for (std::size_t i = 0; i < segments; ++i) {
      boxes[i / kRiverSegments].add(points_[i].at_m);
      boxes[i / kRiverSegments].add(points_[i + 1].at_m);
    }
    for (std::size_t p = 0; p < boxes.size(); ++p) {
      if (auto ok = core::check_cancelled(); !ok)
        return tl::unexpected(WaterError{"points_m", ok.error()});
      RiverPiece piece;
      piece.origin = origin;
      piece.body = name_.body;
      piece.edge_m = 2 * world_.cell_m();
      const std::size_t first = p * kRiverSegments;
      const std::size_t end = std::min(first + kRiverSegments, segments);
      for (std::size_t i = first; i <= end; ++i)
        piece.points.push_back(points_[i]);
      seal(piece);
      const double within_m = 2 * piece.reach_m + 1e-6;
      for (std::size_t q = 0; q < boxes.size(); ++q) {
        if (q == p || !boxes[q].touches(boxes[p], within_m)) continue;
        for (std::size_t i = q * kRiverSegments; i < std::min((q + 1) * kRiverSegments, segments);
             ++i) {
          if (FlatBox::around(points_[i].at_m, points_[i + 1].at_m).touches(boxes[p], within_m))
            piece.near.push_back({points_[i].at_m, points_[i + 1].at_m, q < p});
        }
        if (piece.near.size() > kMaxRiverNear)
          return tl::unexpected(WaterError{
              "points_m",
              {core::ErrorCode::kOverBudget,
               fmt::format("more than {} pieces of the river are close together", kMaxRiverNear)}});
      }
      add_piece(std::move(piece), boxes[p]);
    }
    return std::move(made_);
  }

  void add_piece(RiverPiece piece, const FlatBox& box) {
    seal(piece);
    models::GroundEdit edit = below_.square_around(box, piece.origin, piece.reach_m);
    edit.change = models::GroundChange::kRiver;
    edit.river = std::make_shared<const RiverPiece>(std::move(piece));
    edit.height_m = below_.max_moved_m(edit);
    made_.edits.push_back(std::move(edit));
  }

  const World& world_;
  GroundBelow below_;
  const River& river_;
  const BodyName& name_;
  std::vector<CurvePoint> curve_;
  std::vector<Sample> samples_;
  std::vector<double> surface_, bed_;
  std::vector<RiverPoint> points_;
  WaterEdits made_;
};

}  // namespace

tl::expected<WaterEdits, WaterError> river_edits(const World& world, const models::EditLayer& below,
                                                 const River& river, const BodyName& name) {
  return RiverMaker(world, below, river, name).make();
}

}  // namespace psygen::world
