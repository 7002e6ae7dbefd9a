// The surface of the channels and lakes of a river network.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/models/network/network.hpp"
#include "engine/models/water/surface_writer.hpp"

namespace psygen::models {
namespace {

using network::Curve;

// Nodes above this level show no channels and lakes: they are smaller than pixels there.
constexpr int kMaxNodeLevel = 8;
// Vertices along a side of a node, for lakes.
constexpr std::size_t kLakeSide = 17;

class NetworkSurface {
 public:
  NetworkSurface(const WaterNode& node, const RiverNetwork& network, SurfaceWriter& to)
      : node_(node),
        network_(network),
        to_(to),
        detail_(GroundDetail::of_node(node.level)),
        square_(network.square_of(node.block, node.level)),
        parts_(network.parts_of(square_, detail_)) {}

  // A channel belongs to the node in which its network's node lies.
  void add_channels() {
    for (const auto& [patch, box] : parts_) {
      const auto from_corner_m = [&](std::int64_t units, std::int64_t corner_cells) {
        return static_cast<double>(units - corner_cells * network::kUnitsPerCell) /
               network::kUnitsPerCell * network_.frame().cell_m;
      };
      for (const Curve& curve : patch->curves) {
        if (!box.holds(curve.x, curve.z)) continue;
        add(*patch, curve,
            {from_corner_m(patch->x + curve.x, square_.x),
             from_corner_m(patch->z + curve.z, square_.z)});
      }
    }
  }

  void add_lakes() {
    const bool any = std::ranges::any_of(parts_, [](const RiverNetwork::Part& part) {
      return part.patch->may_have_lake(part.box.grown(1));
    });
    if (!any) return;
    std::array<std::int64_t, kLakeSide> xs, zs;
    constexpr std::int64_t kSteps = kLakeSide - 1;
    for (std::size_t i = 0; i < kLakeSide; ++i) {
      const std::int64_t away = square_.side * static_cast<std::int64_t>(i) / kSteps;
      xs[i] = square_.x + away;
      zs[i] = square_.z + away;
    }
    constexpr std::size_t kCount = kLakeSide * kLakeSide;
    std::vector<float> rows(4 * kCount);
    float *const height = rows.data(), *const water = height + kCount,
                 *const flow_x = water + kCount, *const flow_z = flow_x + kCount;
    network_.evaluate({xs, zs}, detail_,
                      {.height_m = height,
                       .water_m = water,
                       .flow_x = flow_x,
                       .flow_z = flow_z,
                       .stride = kLakeSide});
    const auto is_lake = [&](std::size_t i) {
      constexpr float kEqualM = 0.02F;
      if (!(water[i] > height[i]) ||
          water[i] < static_cast<float>(network_.frame().sea_level_m) + kEqualM)
        return false;
      return (flow_x[i] == 0 && flow_z[i] == 0) ||
             std::ranges::any_of(parts_, [&](const RiverNetwork::Part& part) {
               return part.patch->is_lake_level(double{water[i]});
             });
    };
    const auto away_m = [&](const auto& lines, std::size_t i) {
      return static_cast<double>(lines[i] - lines.front()) * network_.frame().cell_m;
    };
    for (std::size_t z = 0; z + 1 < kLakeSide; ++z) {
      for (std::size_t x = 0; x + 1 < kLakeSide; ++x) {
        std::array<std::size_t, 4> at;
        std::array<glm::dvec2, 4> places;
        double level_m = -1;
        for (std::size_t c = 0; c < 4; ++c) {
          const auto [right, down] = SurfaceWriter::kCorners[c];
          at[c] = (z + down) * kLakeSide + x + right;
          places[c] = {away_m(xs, x + right), away_m(zs, z + down)};
          if (is_lake(at[c])) level_m = std::max(level_m, double{water[at[c]]});
        }
        if (level_m < 0) continue;
        std::array<double, 4> beyond;
        for (std::size_t c = 0; c < 4; ++c) {
          const double above_m = double{height[at[c]]} - level_m;
          beyond[c] = is_lake(at[c]) ? std::min(above_m, 0.0) : std::max(above_m, 0.2);
        }
        to_.add_ring(beyond, [&](std::size_t i, std::size_t j, double share) {
          const glm::dvec2 at_m = places[i] + (places[j] - places[i]) * share;
          return to_.add({.at_m = {at_m.x, level_m, at_m.y},
                          .depth_m = -(beyond[i] + (beyond[j] - beyond[i]) * share)});
        });
      }
    }
  }

 private:
  // `origin_m`: the curve's node, from the corner of the node of the quadtree.
  void add(const network::Patch& patch, const Curve& curve, glm::dvec2 origin_m) {
    if (!node_.shows(double{curve.width1_m}) || to_.is_full()) return;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i <= curve.chords; ++i) {
      const std::uint32_t row = to_.add(section(curve, i, origin_m), node_.level);
      if (i > 0 && !is_still(patch, curve, i)) to_.join(before, row, node_.level);
      before = row;
    }
  }

  // The water at the end of a chord.
  static double level_m(const Curve& curve, std::size_t i) {
    return double{network::level_m(curve, static_cast<float>(i) / Curve::kChords)};
  }
  // True for a chord whose ends both lie on a lake, or on the sea.
  bool is_still(const network::Patch& patch, const Curve& curve, std::size_t i) const {
    constexpr double kEqualM = 0.01;
    const double from_m = level_m(curve, i - 1), to_m = level_m(curve, i);
    if (from_m > to_m + kEqualM) return false;
    if (to_m < network_.frame().sea_level_m + kEqualM) return true;
    const auto at = [&](std::int32_t node, float away_m) {
      return node + static_cast<std::int32_t>(away_m / patch.unit_m);
    };
    const std::int32_t x = at(curve.x, curve.px[i]), z = at(curve.z, curve.pz[i]);
    return patch.is_lake_level(to_m, kEqualM) && patch.may_have_lake({x, z, x, z});
  }

  CrossSection section(const Curve& curve, std::size_t i, glm::dvec2 origin_m) const {
    const double t = static_cast<double>(i) / Curve::kChords;
    const std::size_t from = i > 0 ? i - 1 : 0, next = std::min<std::size_t>(i + 1, curve.chords);
    const glm::dvec2 chord(double{curve.px[next] - curve.px[from]},
                           double{curve.pz[next] - curve.pz[from]});
    const double length_m = std::max(std::sqrt(chord.x * chord.x + chord.y * chord.y), 1e-3);
    double width_m = double{curve.width0_m} + t * double{curve.width1_m - curve.width0_m};
    if (curve.head) width_m *= std::min(0.3 + t, 1.0);
    const double depth_m = double{network::channel_depth_m(static_cast<float>(width_m))};
    const glm::dvec2 middle_m = origin_m + glm::dvec2(double{curve.px[i]}, double{curve.pz[i]});
    const double fall = (level_m(curve, from) - level_m(curve, next)) / length_m;
    return {.middle_m = middle_m,
            .direction = chord / length_m,
            .half_width_m = 0.5 * width_m,
            .edge_m = node_.level == 0 ? 2 : 0.1 * node_.cell_m(),
            .surface_m = surface_m(curve, i, middle_m),
            .middle_depth_m = depth_m,
            .middle_m_s = double{network::middle_speed_m_s(curve.discharge_m3_s,
                                                           static_cast<float>(width_m))},
            .fall = fall,
            // A thin stream is a white line of little width, not a fall.
            .foam = std::clamp((width_m - 0.5) / 4, 0.15, 1.0) * foam_of_fall(fall)};
  }

  // Where water of several channels meets, that of the finest level is blended.
  double surface_m(const Curve& curve, std::size_t i, glm::dvec2 middle_m) const {
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
  SurfaceWriter& to_;
  GroundDetail detail_;
  RiverNetwork::Cells square_;
  std::vector<RiverNetwork::Part> parts_;
};

}  // namespace

void add_network(const WaterNode& node, const RiverNetwork& network, SurfaceWriter& to) {
  if (node.level > kMaxNodeLevel) return;
  NetworkSurface surface(node, network, to);
  surface.add_channels();
  surface.add_lakes();
}

}  // namespace psygen::models
