#include "engine/models/water/water_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"

namespace psygen::models {
namespace {

constexpr std::int32_t kLastNode = std::numeric_limits<std::int32_t>::max();
constexpr std::array kSchema{
    placed(integer_parameter("x", "nodes", 0, {-2147483648.0, kLastNode}, {0, 511},
                             "index of the node along x, in nodes of its level")),
    placed(integer_parameter("z", "nodes", 0, {-2147483648.0, kLastNode}, {0, 511},
                             "index of the node along z, in nodes of its level")),
    placed(integer_parameter("node_level", "1", 0, {0, 30}, {0, 13},
                             "the node has 2^this blocks along each side")),
    placed(real_parameter("block_m", "m", 63, {1, 1e6}, {16, 512}, "side of a block")),
};

// Places across a river, in halves of its width; the outermost ones reach under the banks.
constexpr double kBeyond = 2;  // stands for the edge beyond the width
constexpr std::array kFineAcross{-kBeyond, -1.0, -0.6, 0.0, 0.6, 1.0, kBeyond};
constexpr std::array kCoarseAcross{-kBeyond, 0.0, kBeyond};
std::span<const double> across_of(int node_level) {
  return node_level == 0 ? std::span<const double>(kFineAcross)
                         : std::span<const double>(kCoarseAcross);
}

// Rivers narrower than this fraction of a node's cell are thinner than a pixel where it is drawn.
constexpr double kThinnest = 0.06, kCellsPerBlock = 64;
constexpr int kMinBorderCells = 4, kMaxTileCells = 8;
constexpr double kTileCellM = 8;  // of lakes at node level 0
constexpr std::size_t kMaxVertices = 60'000;

// A surface point in metres from the node's corner.
struct SurfacePoint {
  glm::dvec3 at_m{0.0};
  double depth_m = 0, foam = 0;
  glm::dvec2 flow_m_s{0.0}, slope{0.0};
};

core::WaterVertex packed(const SurfacePoint& point, const core::Bounds& box) {
  const glm::vec3 centre = box.centre(), half = glm::max(box.half_extent(), glm::vec3(1e-3F));
  const auto snorm = [](double value, double largest) {
    return std::round(std::clamp(value, -1.0, 1.0) * largest);
  };
  const auto unorm8 = [](double value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0, 1.0) * 255 + 0.5);
  };
  core::WaterVertex v;
  for (int i = 0; i < 3; ++i)
    v.position[i] = static_cast<std::int16_t>(
        snorm((point.at_m[i] - double{centre[i]}) / double{half[i]}, 32767));
  v.depth = unorm8(std::sqrt(std::max(point.depth_m, 0.0) / double{core::kWaterVertexDepthM}));
  v.foam = unorm8(point.foam);
  for (int i = 0; i < 2; ++i) {
    v.flow[i] = static_cast<std::int16_t>(
        snorm(point.flow_m_s[i] / double{core::kWaterVertexSpeed}, 32767));
    v.slope[i] = static_cast<std::int8_t>(snorm(point.slope[i], 127));
  }
  return v;
}

// The node of a mesh.
struct WaterNode {
  QuadCoord at;
  core::BlockCoord block;  // at its corner
  int level;
  double block_m;
  const GroundStack* ground;  // null: no water

  explicit WaterNode(const Parameters& p)
      : at(QuadCoord::of({static_cast<std::int32_t>(p.integer(kWaterX)),
                          static_cast<std::int32_t>(p.integer(kWaterZ))},
                         static_cast<std::uint32_t>(p.integer(kWaterNodeLevel)))),
        block(at.corner()),
        level(static_cast<int>(at.level)),
        block_m(p.real(kWaterBlockM)),
        ground(p.edits() != nullptr ? &p.edits()->ground : nullptr) {}

  double side_m() const { return std::ldexp(block_m, level); }
  double cell_m() const { return side_m() / kCellsPerBlock; }
  // True for the one node of its level that has a point, in metres from a position.
  bool owns(const core::WorldPosition& origin, glm::dvec2 from_m) const {
    const auto inside = [&](std::int32_t first, std::int32_t from, double local_m) {
      const auto away = static_cast<std::int64_t>(std::floor(local_m / block_m)) + from - first;
      return away >= 0 && away < std::int64_t{1} << level;
    };
    return inside(block.x, origin.block.x, origin.local.x + from_m.x) &&
           inside(block.z, origin.block.z, origin.local.z + from_m.y);
  }
  // From the node's corner to a position.
  glm::dvec2 corner_to_m(const core::WorldPosition& origin) const {
    return -from_origin_m(origin, block, {0.0, 0.0}, block_m);
  }
};

// A strip of a river: its points `first`, `first` + `stride` … `last`.
struct Strip {
  const RiverPiece* river;
  std::size_t first, last;
};

// A tile of a lake, divided into cells · cells squares.
struct Tile {
  const LakePiece* lake;
  int cells;
};

// All surfaces of a node, without their vertices.
struct Surfaces {
  std::vector<Strip> strips;
  std::vector<Tile> tiles;
};

double width_m(const RiverPiece& river) {
  double half_m = 0;
  for (const RiverPoint& point : river.points)
    half_m = std::max(half_m, point.half_width_m);
  return 2 * half_m;
}

// True where another body of water owns the middle of a river: it flows into it there.
bool is_foreign(const WaterNode& node, const RiverPiece& river, const RiverPoint& point) {
  core::WorldPosition at = river.origin;
  at.local.x += point.at_m.x;
  at.local.z += point.at_m.y;
  at = core::normalised(at, node.block_m);
  const auto owner = node.ground->water_over(at.block, {at.local.x, at.local.z}, node.block_m);
  return owner && owner->body != river.body;
}

Surfaces surfaces_of(const WaterNode& node) {
  Surfaces out;
  if (node.ground == nullptr) return out;
  std::vector<const GroundEdit*> pieces = node.ground->water_in(node.at, node.block_m);
  std::ranges::sort(pieces, {}, &GroundEdit::order);
  const std::size_t stride = std::size_t{1} << std::min(node.level, 16);
  std::size_t vertices = 0;
  for (const GroundEdit* piece : pieces) {
    if (piece->lake) {
      const LakePiece& lake = *piece->lake;
      if (!node.owns(lake.origin, (lake.low_m + lake.high_m) / 2.0)) continue;
      if (lake.segments.empty() && !lake.inside) continue;
      const double cells = std::max(lake.high_m.x - lake.low_m.x, lake.high_m.y - lake.low_m.y) /
                           std::ldexp(kTileCellM, node.level);
      const int fewest = lake.segments.empty() ? 1 : kMinBorderCells;
      out.tiles.push_back(
          {&lake, std::clamp(static_cast<int>(std::ceil(cells)), fewest, kMaxTileCells)});
      vertices += 6 * static_cast<std::size_t>(out.tiles.back().cells * out.tiles.back().cells);
    } else if (piece->river && width_m(*piece->river) >= kThinnest * node.cell_m()) {
      const RiverPiece& river = *piece->river;
      for (std::size_t first = 0; first + 1 < river.points.size(); first += stride) {
        const std::size_t last = std::min(first + stride, river.points.size() - 1);
        const glm::dvec2 middle_m = (river.points[first].at_m + river.points[last].at_m) / 2.0;
        if (!node.owns(river.origin, middle_m)) continue;
        if (is_foreign(node, river, river.points[first]) &&
            is_foreign(node, river, river.points[last]))
          continue;
        out.strips.push_back({&river, first, last});
        vertices += 2 * across_of(node.level).size();
      }
    }
    if (vertices > kMaxVertices) break;
  }
  return out;
}

// Receives triangles: counts them, or writes them.
class SurfaceWriter {
 public:
  SurfaceWriter() = default;
  SurfaceWriter(const core::Bounds& box, const MeshView& out) : box_(box), out_(&out) {}

  std::uint32_t add(const SurfacePoint& point) {
    tight_.min = glm::min(tight_.min, glm::vec3(point.at_m));
    tight_.max = glm::max(tight_.max, glm::vec3(point.at_m));
    if (out_ != nullptr) {
      const core::WaterVertex v = packed(point, box_);
      std::memcpy(out_->vertices.data() + vertices_ * sizeof v, &v, sizeof v);
    }
    return vertices_++;
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (out_ != nullptr) {
      std::uint16_t* const to = out_->indices.data() + indices_;
      to[0] = static_cast<std::uint16_t>(a);
      to[1] = static_cast<std::uint16_t>(b);
      to[2] = static_cast<std::uint16_t>(c);
    }
    indices_ += 3;
  }
  std::uint32_t vertices() const { return vertices_; }
  std::uint32_t indices() const { return indices_; }
  // Of all vertices; a point at the corner without any.
  core::Bounds tight() const { return vertices_ == 0 ? core::Bounds{} : tight_; }

 private:
  core::Bounds box_;
  const MeshView* out_ = nullptr;
  core::Bounds tight_{glm::vec3(1e30F), glm::vec3(-1e30F)};
  std::uint32_t vertices_ = 0, indices_ = 0;
};

SurfacePoint point_of(const RiverPiece& river, const RiverPoint& point, double across,
                      glm::dvec2 corner_to_m) {
  const bool beyond = std::abs(across) >= kBeyond;
  const double out_m = beyond ? (across > 0 ? 1 : -1) * (point.half_width_m + river.edge_m)
                              : across * point.half_width_m;
  const glm::dvec2 aside(-point.direction.y, point.direction.x);
  const glm::dvec2 at_m = corner_to_m + point.at_m + aside * out_m;
  const double inner = beyond ? 0 : 1 - across * across;
  SurfacePoint surface;
  surface.at_m = {at_m.x, point.surface_m, at_m.y};
  surface.depth_m = (point.surface_m - point.bed_m) * inner;
  surface.foam = point.foam;
  surface.flow_m_s = point.direction * (1.25 * point.speed_m_s * std::max(inner, 0.2));
  surface.slope = point.direction * -point.fall;
  return surface;
}

void add(const WaterNode& node, const Strip& strip, SurfaceWriter& to) {
  const std::span<const double> across = across_of(node.level);
  const glm::dvec2 corner_to_m = node.corner_to_m(strip.river->origin);
  std::uint32_t before = 0;
  for (const std::size_t i : {strip.first, strip.last}) {
    const std::uint32_t row = to.vertices();
    for (const double place : across)
      to.add(point_of(*strip.river, strip.river->points[i], place, corner_to_m));
    for (std::uint32_t k = 0; i == strip.last && k + 1 < across.size(); ++k) {
      to.triangle(before + k, row + k, before + k + 1);
      to.triangle(before + k + 1, row + k, row + k + 1);
    }
    before = row;
  }
}

// Writes the part of a ring of four places, in turn, where `beyond` is at most 0: it is below 0 in
// the water, and 0 at its border. add_point(i, j, share): a vertex between places i and j.
template <class AddPoint>
void add_ring(const std::array<double, 4>& beyond, const AddPoint& add_point, SurfaceWriter& to) {
  std::array<std::uint32_t, 8> ring;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const double a = beyond[i], b = beyond[j];
    if (a <= 0) ring[count++] = add_point(i, i, 0.0);
    if ((a <= 0) != (b <= 0)) ring[count++] = add_point(i, j, a / (a - b));
  }
  for (std::size_t i = 1; i + 1 < count; ++i)
    to.triangle(ring[0], ring[i], ring[i + 1]);
}
constexpr std::array<std::array<std::size_t, 2>, 4> kCorners{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};

// Writes the part of a tile within the lake: each square of its cells, cut by the border of the
// water.
void add(const WaterNode& node, const Tile& tile, SurfaceWriter& to) {
  const LakePiece& lake = *tile.lake;
  const glm::dvec2 corner_to_m = node.corner_to_m(lake.origin);
  const glm::dvec2 cell_m = (lake.high_m - lake.low_m) / static_cast<double>(tile.cells);
  const auto side = static_cast<std::size_t>(tile.cells) + 1;
  std::array<double, (kMaxTileCells + 1) * (kMaxTileCells + 1)> outside;
  const auto place_m = [&](std::size_t x, std::size_t z) {
    return lake.low_m + cell_m * glm::dvec2(static_cast<double>(x), static_cast<double>(z));
  };
  for (std::size_t z = 0; z < side; ++z) {
    for (std::size_t x = 0; x < side; ++x)
      outside[z * side + x] = outside_m(lake, place_m(x, z)) - lake.edge_m;
  }
  for (std::size_t z = 0; z + 1 < side; ++z) {
    for (std::size_t x = 0; x + 1 < side; ++x) {
      std::array<double, 4> beyond;
      std::array<glm::dvec2, 4> places;
      for (std::size_t c = 0; c < 4; ++c) {
        beyond[c] = outside[(z + kCorners[c][1]) * side + x + kCorners[c][0]];
        places[c] = place_m(x + kCorners[c][0], z + kCorners[c][1]);
      }
      add_ring(
          beyond,
          [&](std::size_t i, std::size_t j, double share) {
            const glm::dvec2 at_m = corner_to_m + places[i] + (places[j] - places[i]) * share;
            SurfacePoint surface;
            surface.at_m = {at_m.x, lake.level_m, at_m.y};
            surface.depth_m =
                depth_of(lake, beyond[i] + (beyond[j] - beyond[i]) * share + lake.edge_m);
            return to.add(surface);
          },
          to);
    }
  }
}

// Nodes above this level show no rivers and lakes of a network: they are smaller than pixels there.
constexpr int kMaxNetworkLevel = 8;
// Vertices along a side of a node, for the lakes of a network.
constexpr std::size_t kLakeSide = 17;

// The channels of a network whose nodes lie in a node of the quadtree.
class NetworkSurface {
 public:
  NetworkSurface(const WaterNode& node, const RiverNetwork& network)
      : node_(node),
        network_(network),
        detail_(GroundDetail::of_node(node.level)),
        cells_(network.frame().cells_per_block),
        x0_(std::int64_t{node.block.x} * cells_),
        z0_(std::int64_t{node.block.z} * cells_),
        side_(cells_ << node.level) {}

  void add_channels(SurfaceWriter& to) const {
    constexpr auto kUnits = network::kUnitsPerCell;
    for (std::int64_t z = z0_, next_z = 0; z < z0_ + side_; z = next_z) {
      for (std::int64_t x = x0_, next_x = 0; x < x0_ + side_; x = next_x) {
        const auto patch = network_.patch(network_.tile_of(x, z, detail_));
        const auto end_of = [&](std::int64_t corner, std::int64_t from, std::int64_t end) {
          const std::int64_t served = (corner + patch->square.side) / kUnits;
          return std::min(std::max(served, from + 1), end);
        };
        next_x = end_of(patch->square.x, x, x0_ + side_);
        next_z = end_of(patch->square.z, z, z0_ + side_);
        for (const network::Curve& curve : patch->curves) {
          const std::int64_t at_x = patch->x + curve.x, at_z = patch->z + curve.z;
          if (at_x < x * kUnits || at_x >= next_x * kUnits || at_z < z * kUnits ||
              at_z >= next_z * kUnits)
            continue;
          add(*patch, curve, {metres(at_x - x0_ * kUnits), metres(at_z - z0_ * kUnits)}, to);
        }
      }
    }
  }

  void add_lakes(SurfaceWriter& to) const {
    std::array<std::int64_t, kLakeSide> xs, zs;
    for (std::size_t i = 0; i < kLakeSide; ++i) {
      const std::int64_t away = side_ * static_cast<std::int64_t>(i) / (kLakeSide - 1);
      xs[i] = x0_ + away;
      zs[i] = z0_ + away;
    }
    constexpr std::size_t kCount = kLakeSide * kLakeSide;
    std::vector<float> rows(4 * kCount);
    float *const height = rows.data(), *const water = height + kCount,
                 *const flow_x = water + kCount, *const flow_z = flow_x + kCount;
    std::vector<std::uint32_t> body(kCount);
    network_.evaluate({xs, zs}, detail_,
                      {.height_m = height,
                       .water_m = water,
                       .flow_x = flow_x,
                       .flow_z = flow_z,
                       .body = body.data(),
                       .stride = kLakeSide});
    // Channels run through lakes, at their level.
    const auto patch = network_.patch(network_.tile_of(x0_ + side_ / 2, z0_ + side_ / 2, detail_));
    const auto is_lake = [&](std::size_t i) {
      constexpr float kEqualM = 0.02F;
      if (!(water[i] > height[i]) ||
          water[i] < static_cast<float>(network_.frame().sea_level_m) + kEqualM)
        return false;
      return (flow_x[i] == 0 && flow_z[i] == 0) ||
             std::ranges::any_of(patch->lakes, [&](const network::Lake& lake) {
               return std::abs(lake.level_m - water[i]) < kEqualM;
             });
    };
    for (std::size_t z = 0; z + 1 < kLakeSide; ++z) {
      for (std::size_t x = 0; x + 1 < kLakeSide; ++x) {
        std::array<std::size_t, 4> at;
        double level_m = -1;
        for (std::size_t c = 0; c < 4; ++c) {
          at[c] = (z + kCorners[c][1]) * kLakeSide + x + kCorners[c][0];
          if (is_lake(at[c])) level_m = std::max(level_m, double{water[at[c]]});
        }
        if (level_m < 0) continue;
        std::array<double, 4> beyond;
        for (std::size_t c = 0; c < 4; ++c) {
          const double above_m = double{height[at[c]]} - level_m;
          beyond[c] = is_lake(at[c]) ? std::min(above_m, 0.0) : std::max(above_m, 0.2);
        }
        add_ring(
            beyond,
            [&](std::size_t i, std::size_t j, double share) {
              const auto along = [&](std::size_t axis) {
                const auto& lines = axis == 0 ? xs : zs;
                const auto line = [&](std::size_t c) {
                  const std::int64_t first = axis == 0 ? x0_ : z0_;
                  const std::size_t k = (axis == 0 ? x : z) + kCorners[c][axis];
                  return static_cast<double>(lines[k] - first) * network_.frame().cell_m;
                };
                return line(i) + (line(j) - line(i)) * share;
              };
              SurfacePoint surface;
              surface.at_m = {along(0), level_m, along(1)};
              surface.depth_m = -(beyond[i] + (beyond[j] - beyond[i]) * share);
              return to.add(surface);
            },
            to);
      }
    }
  }

 private:
  double metres(std::int64_t units) const {
    return static_cast<double>(units) / network::kUnitsPerCell * network_.frame().cell_m;
  }

  // `origin_m`: the curve's node, from the node's corner.
  void add(const network::Patch& patch, const network::Curve& curve, glm::dvec2 origin_m,
           SurfaceWriter& to) const {
    if (double{curve.width1_m} < kThinnest * node_.cell_m() || curve.chords == 0) return;
    if (to.vertices() > kMaxVertices) return;
    const std::span<const double> across = across_of(node_.level);
    std::uint32_t before = 0;
    for (std::size_t i = 0; i <= curve.chords; ++i) {
      const std::uint32_t row = to.vertices();
      for (const double place : across)
        to.add(point(curve, i, place, origin_m));
      const bool drawn = i > 0 && !is_in_lake(patch, curve, i);
      for (std::uint32_t k = 0; drawn && k + 1 < across.size(); ++k) {
        to.triangle(before + k, row + k, before + k + 1);
        to.triangle(before + k + 1, row + k, row + k + 1);
      }
      before = row;
    }
  }

  // True for a chord whose ends both lie on a lake, or on the sea.
  bool is_in_lake(const network::Patch& patch, const network::Curve& curve, std::size_t i) const {
    constexpr double kEqualM = 0.01;
    const double from_m = level_m(curve, i - 1), to_m = level_m(curve, i);
    if (from_m > to_m + kEqualM) return false;
    return to_m < network_.frame().sea_level_m + kEqualM ||
           std::ranges::any_of(patch.lakes, [&](const network::Lake& lake) {
             return std::abs(double{lake.level_m} - to_m) < kEqualM;
           });
  }

  // The water at the end of a chord.
  static double level_m(const network::Curve& curve, std::size_t i) {
    return double{network::level_m(curve, static_cast<float>(i) / network::Curve::kChords)};
  }

  SurfacePoint point(const network::Curve& curve, std::size_t i, double across,
                     glm::dvec2 origin_m) const {
    const double t = static_cast<double>(i) / network::Curve::kChords;
    const std::size_t from = i > 0 ? i - 1 : 0, next = std::min<std::size_t>(i + 1, curve.chords);
    const glm::dvec2 chord(double{curve.px[next] - curve.px[from]},
                           double{curve.pz[next] - curve.pz[from]});
    const double length_m = std::max(std::sqrt(chord.x * chord.x + chord.y * chord.y), 1e-3);
    const glm::dvec2 direction = chord / length_m, aside(-direction.y, direction.x);
    double width_m = double{curve.width0_m} + t * double{curve.width1_m - curve.width0_m};
    if (curve.head) width_m *= std::min(0.3 + t, 1.0);
    const bool beyond = std::abs(across) >= kBeyond;
    const double edge_m = node_.level == 0 ? 2 : 0.1 * node_.cell_m();
    const double out_m =
        beyond ? (across > 0 ? 1 : -1) * (0.5 * width_m + edge_m) : across * 0.5 * width_m;
    const glm::dvec2 middle_m = origin_m + glm::dvec2(double{curve.px[i]}, double{curve.pz[i]});
    const glm::dvec2 at_m = middle_m + aside * out_m;
    const double inner = beyond ? 0 : 1 - across * across;
    const double depth_m = double{network::channel_depth_m(static_cast<float>(width_m))};
    const double fall = (level_m(curve, from) - level_m(curve, next)) / length_m;
    const double speed = double{curve.discharge_m3_s} / std::max(0.67 * width_m * depth_m, 0.05);
    SurfacePoint surface;
    surface.at_m = {at_m.x, surface_m(curve, i, middle_m), at_m.y};
    surface.depth_m = depth_m * inner;
    // A thin stream is a white line of little width, not a fall.
    const double broad = std::clamp((width_m - 0.5) / 4, 0.15, 1.0);
    surface.foam = broad * foam_of_fall(fall);
    surface.flow_m_s = direction * (std::min(speed, 6.0) * std::max(inner, 0.2));
    surface.slope = direction * -fall;
    return surface;
  }

  // Where water of several channels meets, that of the finest level is blended.
  double surface_m(const network::Curve& curve, std::size_t i, glm::dvec2 middle_m) const {
    if (node_.level == 0) {
      const core::WorldPosition at =
          core::normalised({node_.block, {middle_m.x, 0, middle_m.y}}, node_.block_m);
      const NetworkWater water = network_.water_at(at);
      if (water.depth_m > 0) return double{water.surface_m};
    }
    return level_m(curve, i);
  }

  const WaterNode& node_;
  const RiverNetwork& network_;
  GroundDetail detail_;
  std::int64_t cells_, x0_, z0_, side_;  // x0_, z0_: of the node's corner
};

void add_all(const WaterNode& node, SurfaceWriter& to) {
  const Surfaces all = surfaces_of(node);
  for (const Strip& strip : all.strips)
    add(node, strip, to);
  for (const Tile& tile : all.tiles)
    add(node, tile, to);
  if (node.ground == nullptr || node.ground->network == nullptr || node.level > kMaxNetworkLevel)
    return;
  const NetworkSurface network(node, *node.ground->network);
  network.add_channels(to);
  network.add_lakes(to);
}

// The mesh of these parameters, without writing it.
SurfaceWriter counted(const Parameters& p) {
  const core::RoundToNearest rounding;
  SurfaceWriter counter;
  add_all(WaterNode(p), counter);
  return counter;
}

// The type. A node's mesh has one level; coarser nodes have coarser meshes.
class WaterType final : public ModelType {
 public:
  std::string_view name() const override { return "water_surface"; }
  std::string_view doc() const override { return "surface of the rivers and lakes of a node"; }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return 1; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const Parameters&, int) const override { return 0; }
  core::SurfaceKind surface() const override { return core::SurfaceKind::kWater; }
  core::Bounds bounds(const Parameters& p) const override { return counted(p).tight(); }
  MeshSize mesh_size(const Parameters& p, int) const override {
    const SurfaceWriter counter = counted(p);
    return {counter.vertices(), counter.indices(), 0, core::VertexLayout::kModel};
  }
  double complexity(const Parameters& p, int) const override { return counted(p).vertices(); }
  double steps(const Parameters& p, int) const override { return counted(p).vertices(); }
  double step_seconds() const override { return 60e-9; }
  double log2_cost(const Parameters&) const override { return 16; }
  core::Bounds synthesise(const Parameters& p, int, const MeshView& out) const override {
    const core::RoundToNearest rounding;
    SurfaceWriter writer(bounds(p), out);
    add_all(WaterNode(p), writer);
    PSYGEN_CHECK(out.vertices.size() == writer.vertices() * sizeof(core::WaterVertex) &&
                     out.indices.size() == writer.indices(),
                 "the destination has exactly the size of the mesh");
    return writer.tight();
  }
};

}  // namespace

Parameters water_surface_parameters(core::BlockCoord node, int node_level, double block_m) {
  Parameters p;
  p.set_integer(kWaterX, node.x);
  p.set_integer(kWaterZ, node.z);
  p.set_integer(kWaterNodeLevel, node_level);
  p.set_real(kWaterBlockM, block_m);
  return p;
}

bool has_water_surface(const Parameters& p) {
  return counted(p).indices() > 0;
}

std::unique_ptr<ModelType> make_water_type() {
  return std::make_unique<WaterType>();
}

}  // namespace psygen::models
