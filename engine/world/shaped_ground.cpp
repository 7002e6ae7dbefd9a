#include "engine/world/shaped_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/cancellation.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/curve.hpp"
#include "engine/world/moved_ground.hpp"
#include "engine/world/water.hpp"
#include "engine/world/water_shapes.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

using models::GroundChange;
using models::GroundEdit;
using models::RoadPiece;
using models::RoadSegment;

// Maximum number of segments of a piece.
constexpr std::size_t kPieceSegments = 12;
// Maximum number of segments of a road near one of its pieces: a road may cross itself but not
// cover an area.
constexpr std::size_t kMaxNear = 1000;

FlatBox box_of(const RoadSegment& segment) {
  FlatBox box;
  box.add(segment.from_m);
  box.add(segment.to_m);
  return box;
}

tl::unexpected<ShapeError> refused(std::string_view key, core::Error error) {
  return tl::unexpected(ShapeError{{}, key, 0, std::move(error)});
}
tl::unexpected<ShapeError> refused(std::string_view key, std::string sentence) {
  return refused(key, {core::ErrorCode::kInvalidArgument, std::move(sentence)});
}

using Shaped = tl::expected<void, ShapeError>;

// Builds the layer of one world, edit by edit.
class Shaper {
 public:
  explicit Shaper(const World& world)
      : world_(world),
        block_m_(world.block_size_m()),
        relief_m_(world.terrain.real(models::kTerrainReliefM)) {}

  Shaped add(const Stamp& stamp) {
    const bool sets = stamp.mode == "set";
    const double lowest = sets ? 0 : -relief_m_;
    const bool in_metres = stamp.is_in_metres();
    const auto [least, largest] = in_metres ? numbers_of(stamp) : std::pair{0.0F, 0.0F};
    const double high_m = in_metres ? double{largest} : stamp.height_m;
    for (const double height_m : {stamp.base_m + double{least}, stamp.base_m + high_m}) {
      if (height_m >= lowest && height_m <= relief_m_) continue;
      return refused(
          in_metres ? "image" : "height_m",
          fmt::format("the stamp reaches {:g} m, but must stay within {:g} to {:g} m: the "
                      "height range of the terrain (relief_m)",
                      height_m, lowest, relief_m_));
    }
    const auto centre = inside(stamp.centre_m);
    if (!centre) return refused("centre_m", centre.error());
    GroundEdit edit;
    edit.change = sets ? GroundChange::kStampSet : GroundChange::kStampAdd;
    edit.square = true;
    edit.centre = *centre;
    const glm::dvec2 half_m = stamp.size_m / 2.0;
    edit.radius_m = std::max(half_m.x, half_m.y);
    edit.sides = half_m / edit.radius_m;
    edit.falloff = std::min({stamp.border_m, half_m.x, half_m.y}) / edit.radius_m;
    edit.map = map_of(stamp);
    if (stamp.turn_deg != 0)
      edit.turn = {models::exact_cos_degrees(stamp.turn_deg),
                   models::exact_sin_degrees(stamp.turn_deg)};
    return add(std::move(edit), "centre_m");
  }

  // The network that fits the world: its finest nodes are 16 to 512 cells apart, and its coast lies
  // within the relief.
  Shaped add(models::RiverSettings network) {
    constexpr double kMinCells = 16, kMaxCells = 512, kMinCoast = 0.02, kMaxCoast = 0.9;
    network.seed = world_.seed;
    const auto node_cells = [&] {
      return std::ldexp(network.root_spacing_m, -network.halvings) / world_.cell_m();
    };
    while (network.halvings > 1 && node_cells() < kMinCells)
      --network.halvings;
    while (network.halvings < 8 && node_cells() > kMaxCells)
      ++network.halvings;
    const models::RiverFrame frame{
        .cell_m = world_.cell_m(),
        .cells_per_block = world_.terrain.integer(models::kTerrainSize) - 1,
        .relief_m = relief_m_,
        .sea_level_m =
            std::clamp(world_.water.level_m, kMinCoast * relief_m_, kMaxCoast * relief_m_)};
    auto made =
        models::RiverNetwork::create(network, frame, std::make_shared<models::NetworkStore>());
    if (!made) return refused("root_spacing_m", std::move(made.error()));
    layer_.ground.network = std::move(*made);
    return {};
  }

  void add(const models::Erosion& erosion) {
    layer_.ground.erosion = std::make_shared<const models::Erosion>(erosion);
  }

  Shaped add(const Road& road) {
    for (const glm::dvec2& point : road.points_m) {
      if (const auto at = inside(point); !at) return refused("points_m", at.error());
    }
    length_m_ += chords_m(road.points_m);
    if (length_m_ > kMaxRoadsM)
      return refused("points_m", {core::ErrorCode::kOverBudget,
                                  fmt::format("all roads together are longer than the "
                                              "allowed {:g} m",
                                              kMaxRoadsM)});
    models::Parameters terrain = world_.terrain;
    const models::EditLayer before = layer_;
    terrain.set_edits(&before, 0);
    const double step_m = std::max(world_.cell_m(), std::clamp(road.width_m / 3, 1.0, 10.0));
    const auto line = road_line(road, step_m, [&](glm::dvec2 at_m) {
      const core::WorldPosition at = position(at_m);
      return models::ground_height_m(terrain, at.block, at.local.x, at.local.z);
    });
    std::vector<RoadPiece> pieces = pieces_of(road, line);
    for (RoadPiece& piece : pieces) {
      if (piece.segments.size() > kMaxNear) return too_much("points_m");
      if (auto ok = add_piece(std::move(piece), terrain); !ok) return ok;
    }
    return {};
  }

  // Adds a lake or a river. `make` is lake_edits or river_edits.
  template <class Body, class Make>
  Shaped add(const Body& body, const BodyName& name, const Make& make) {
    auto made = make(world_, layer_, body, name);
    if (!made) return refused(made.error().key, made.error().error);
    for (GroundEdit& edit : made->edits) {
      if (auto ok = add(std::move(edit), "points_m"); !ok) return ok;
    }
    for (std::string& warning : made->warnings)
      warnings_.push_back(std::move(warning));
    return {};
  }

  // Warns where a road leads into water: it has no bridge.
  void check_roads() {
    for (std::size_t i = 0; i < world_.shaped.roads.size(); ++i) {
      const Road& road = world_.shaped.roads[i];
      const auto line = road_line(road, road.width_m, [](glm::dvec2) { return 0.0; });
      for (const RoadPoint& point : line) {
        const core::WorldPosition at = position(point.at_m);
        const auto water = layer_.ground.water_over(at.block, {at.local.x, at.local.z}, block_m_);
        if (!water || water->widths > 0.5) continue;
        warnings_.push_back(
            fmt::format("road {}: it leads into {} at {:.1f}, {:.1f} m, and has no "
                        "bridge there",
                        i + 1, text_of(*water), point.at_m.x, point.at_m.y));
        break;
      }
    }
  }

  models::EditLayer take() {
    constexpr std::size_t kHeightBytes = std::size_t{16} << 20;  // 2,000 blocks
    if (layer_.ground.has_fixed_part())
      layer_.ground.heights = std::make_shared<core::ValueCache>(kHeightBytes);
    return std::move(layer_);
  }
  std::vector<std::string> take_warnings() { return std::move(warnings_); }

 private:
  core::WorldPosition position(glm::dvec2 at_m) const { return world_.position(at_m); }
  core::Result<core::WorldPosition> inside(glm::dvec2 at_m) const {
    const core::WorldPosition at = position(at_m);
    if (world_.contains(at.block)) return at;
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{:g}, {:g} m is outside the world", at_m.x, at_m.y));
  }

  std::string text_of(const models::BodySurface& water) const {
    if (water.body >= kFirstAdded) return "water of the river network";
    const std::size_t lakes = world_.shaped.lakes.size(), number = water.body - kSea;
    return water.is_river ? fmt::format("river {}", number - lakes)
                          : fmt::format("lake {}", number);
  }

  static std::shared_ptr<const models::Heightmap> map_of(const Stamp& stamp) {
    auto map = std::make_shared<models::Heightmap>();
    map->columns = stamp.picture->width, map->rows = stamp.picture->height;
    map->heights_m.reserve(stamp.picture->pixels());
    const bool in_metres = stamp.is_in_metres();
    for (std::size_t i = 0; i < stamp.picture->pixels(); ++i) {
      const float number = stamp.picture->number(i);
      const bool is_height = stamp.is_height(number);
      const double above_m =
          in_metres ? double{number} : stamp.height_m * (double{number} / stamp.picture->white);
      map->has_holes = map->has_holes || !is_height;
      map->heights_m.push_back(is_height ? static_cast<float>(stamp.base_m + above_m)
                                         : std::numeric_limits<float>::quiet_NaN());
    }
    return map;
  }

  Shaped add(GroundEdit edit, std::string_view key) {
    if (auto ok = core::check_cancelled(); !ok) return refused(key, ok.error());
    edit.id = layer_.next_id++;
    seal(edit);
    if (layer_.ground.shapes.add(std::make_shared<const GroundEdit>(std::move(edit)), block_m_))
      return {};
    return too_much(key);
  }

  static tl::unexpected<ShapeError> too_much(std::string_view key) {
    return refused(
        key,
        {core::ErrorCode::kOverBudget,
         fmt::format("more than {} stamps and pieces of roads or water overlap there", kMaxNear)});
  }

  // The pieces of a road. Each has the segments of other pieces that may be nearest to its points.
  std::vector<RoadPiece> pieces_of(const Road& road, const std::vector<RoadPoint>& line) const {
    const core::WorldPosition origin = position(line.front().at_m);
    const glm::dvec2 from = line.front().at_m;
    std::vector<RoadSegment> segments;
    for (std::size_t i = 1; i < line.size(); ++i)
      segments.push_back(
          {line[i - 1].at_m - from, line[i].at_m - from, line[i - 1].height_m, line[i].height_m});
    std::vector<FlatBox> boxes;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (i % kPieceSegments == 0) boxes.emplace_back();
      boxes.back().add(segments[i].from_m);
      boxes.back().add(segments[i].to_m);
    }
    const double within_m = 2 * (road.width_m / 2 + road.border_m) + 1e-6;
    std::vector<RoadPiece> pieces;
    for (std::size_t p = 0; p < boxes.size(); ++p) {
      RoadPiece piece{origin, road.width_m / 2, road.border_m, road.clear_m, {}, 0, 0};
      for (std::size_t q = 0; q < boxes.size(); ++q) {
        if (q == p) piece.first = piece.segments.size();
        if (!boxes[q].touches(boxes[p], within_m)) continue;
        const std::size_t end = std::min((q + 1) * kPieceSegments, segments.size());
        for (std::size_t i = q * kPieceSegments; i < end; ++i) {
          if (q == p || box_of(segments[i]).touches(boxes[p], within_m))
            piece.segments.push_back(segments[i]);
        }
        if (piece.segments.size() > kMaxNear) break;
        if (q == p) piece.end = piece.segments.size();
      }
      pieces.push_back(std::move(piece));
      if (pieces.back().segments.size() > kMaxNear) break;
    }
    return pieces;
  }

  Shaped add_piece(RoadPiece piece, const models::Parameters& before) {
    FlatBox box;
    for (std::size_t i = piece.first; i < piece.end; ++i) {
      box.add(piece.segments[i].from_m);
      box.add(piece.segments[i].to_m);
    }
    GroundEdit edit;
    edit.change = GroundChange::kRoad;
    edit.square = true;
    core::WorldPosition centre = piece.origin;
    centre.local.x += box.centre().x;
    centre.local.z += box.centre().y;
    edit.centre = core::normalised(centre, block_m_);
    edit.radius_m = std::max(box.size().x, box.size().y) / 2 + piece.reach_m();
    edit.road = std::make_shared<const RoadPiece>(std::move(piece));
    edit.height_m = max_moved_m(world_, edit, before);
    return add(std::move(edit), "points_m");
  }

  const World& world_;
  double block_m_, relief_m_;
  double length_m_ = 0;  // total length of all roads so far
  std::vector<std::string> warnings_;
  models::EditLayer layer_;
};

tl::unexpected<ShapeError> wrong_at(std::string_view place, std::size_t number, ShapeError error) {
  error.place = place, error.number = number;
  return tl::unexpected(std::move(error));
}

// Adds all shapes of one type.
template <class Shapes>
Shaped add_all(const Shapes& shapes, std::string_view place, Shaper& shaper) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (auto ok = shaper.add(shapes[i]); !ok) {
      return wrong_at(place, i, std::move(ok.error()));
    }
  }
  return {};
}

// Adds lakes, then rivers, each after those in which it begins or ends.
Shaped add_water(const World& world, Shaper& shaper) {
  const ShapedGround& shaped = world.shaped;
  WaterBody body = kSea + 1;
  for (std::size_t i = 0; i < shaped.lakes.size(); ++i, ++body) {
    const BodyName name{body, fmt::format("lake {}", i + 1), false};
    if (auto ok = shaper.add(shaped.lakes[i], name, lake_edits); !ok)
      return wrong_at("lake", i, std::move(ok.error()));
  }
  double length_m = 0;
  for (std::size_t i = 0; i < shaped.rivers.size(); ++i) {
    length_m += chords_m(shaped.rivers[i].points_m);
    if (length_m > kMaxRiversM)
      return wrong_at(
          "river", i,
          {{},
           "points_m",
           0,
           {core::ErrorCode::kOverBudget,
            fmt::format("all rivers together are longer than the allowed {:g} m", kMaxRiversM)}});
  }
  const RiverOrder rivers = river_order(world, shaped.rivers);
  if (rivers.order.size() < shaped.rivers.size())
    return wrong_at("river", 0,
                    {{},
                     "points_m",
                     0,
                     {core::ErrorCode::kInvalidArgument, "rivers end in each other in a circle"}});
  for (const std::size_t i : rivers.order) {
    const BodyName name{body + static_cast<WaterBody>(i), fmt::format("river {}", i + 1),
                        rivers.flows_on[i]};
    if (auto ok = shaper.add(shaped.rivers[i], name, river_edits); !ok)
      return wrong_at("river", i, std::move(ok.error()));
  }
  return {};
}

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

}  // namespace

bool operator==(const Stamp& a, const Stamp& b) {
  const auto content = [](const Stamp& s) { return s.picture ? s.picture->hash : 0; };
  return a.image == b.image && content(a) == content(b) && a.centre_m == b.centre_m &&
         a.size_m == b.size_m && a.turn_deg == b.turn_deg && a.base_m == b.base_m &&
         a.height_m == b.height_m && a.border_m == b.border_m && a.no_data == b.no_data &&
         a.mode == b.mode && a.unit == b.unit;
}

std::pair<float, float> numbers_of(const Stamp& stamp) {
  constexpr float kEnd = std::numeric_limits<float>::infinity();
  std::pair range{kEnd, -kEnd};
  for (std::size_t i = 0; i < stamp.picture->pixels(); ++i) {
    const float number = stamp.picture->number(i);
    if (!stamp.is_height(number)) continue;
    range = {std::min(range.first, number), std::max(range.second, number)};
  }
  return range;
}

tl::expected<void, ShapeError> shape_ground(World& world) {
  world.shaped.layer = nullptr;
  set_edits(world, nullptr);
  world.shaped.warnings.clear();
  const models::Erosion& erosion = world.shaped.erosion;
  const bool erodes = erosion.strength > 0;
  if (!erodes && !world.shaped.network && world.shaped.empty()) return {};
  Shaper shaper(world);
  if (world.shaped.network) {
    if (auto ok = shaper.add(*world.shaped.network); !ok) {
      ok.error().place = "rivers";
      return ok;
    }
  }
  if (erodes) shaper.add(erosion);
  if (auto ok = add_all(world.shaped.stamps, "stamp", shaper); !ok) return ok;
  if (auto ok = add_all(world.shaped.roads, "road", shaper); !ok) return ok;
  if (auto ok = add_water(world, shaper); !ok) return ok;
  if (world.shaped.has_water()) shaper.check_roads();
  world.shaped.warnings = shaper.take_warnings();
  world.shaped.layer = std::make_shared<const models::EditLayer>(shaper.take());
  set_edits(world, nullptr);
  return {};
}

std::uint64_t shape_hash(const World& world) {
  if (!world.shaped.layer) return 0;
  return world.shaped.layer->ground.hash_of({models::QuadCoord::kMaxLevel, 0, 0}, 0,
                                            world.block_size_m());
}

std::vector<RoadPoint> road_line(const Road& road, double step_m,
                                 const std::function<double(glm::dvec2)>& height_at) {
  std::vector<RoadPoint> line;
  for (const CurvePoint& point : curve_through(road.points_m, step_m))
    line.push_back({point.at_m, point.along_m, height_at(point.at_m), point.after});
  // Two passes with a tent make a smooth bell.
  smooth(line, road.smoothing_m / 2);
  smooth(line, road.smoothing_m / 2);
  return line;
}

}  // namespace psygen::world
