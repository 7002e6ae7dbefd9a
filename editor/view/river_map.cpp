#include "editor/view/river_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <unordered_map>

namespace psygen::editor {
namespace {

using models::GroundDetail;
using models::RiverNetwork;
using models::network::Curve;
using models::network::kUnitsPerCell;

constexpr int kSquares = 4;
constexpr double kSideSpacings = 64;          // of the finest square, in spacings of its nodes
constexpr std::int64_t kShoreSteps = 128;     // samples along a side, for shores
constexpr std::size_t kFarChords = 2;         // chords of a curve that one far line stands for
constexpr std::uint32_t kSmallestBasin = 16;  // coarsest nodes; smaller ones have no divide
constexpr int kBrookDecades = 2;              // a line of 1 pixel stands for 10^−2 m³/s

class Maker {
 public:
  Maker(const RiverNetwork& network, const core::WorldPosition& around, glm::dvec2 blocks,
        const std::atomic<bool>& cancelled)
      : network_(network),
        cell_m_(network.frame().cell_m),
        block_cells_(network.frame().cells_per_block),
        blocks_(blocks),
        cancelled_(cancelled),
        corner_(network.square_of(around.block, 0)) {
    const auto& settings = network.settings();
    const double spacing_m = std::ldexp(settings.root_spacing_m, -settings.halvings);
    const double side_cells = kSideSpacings * spacing_m / cell_m_;
    // A multiple of the steps of the shores, so that all squares share them.
    side_ = std::max<std::int64_t>(std::llround(side_cells / kShoreSteps), 1) * kShoreSteps;
    middle_ = {snapped(corner_.x + std::llround(around.local.x / cell_m_)),
               snapped(corner_.z + std::llround(around.local.z / cell_m_))};
    map_.corner = around.block;
    map_.near_m = static_cast<double>(side_) / 2 * cell_m_;
  }

  RiverMap make() {
    const int squares = std::min(kSquares, network_.settings().halvings + 1);
    for (int k = 0; k < squares && !cancelled_; ++k) {
      square_ = square(k);
      inner_ = k > 0 ? square(k - 1) : RiverNetwork::Cells{};
      detail_ = detail_of(network_.settings().halvings - k);
      parts_ = network_.parts_of(square_, detail_);
      add_channels(k > 0 ? kFarChords : 1);
      add_shores();
    }
    if (!cancelled_) add_divides(squares);
    return std::move(map_);
  }

 private:
  RiverNetwork::Cells square(int k) const {
    const std::int64_t side = side_ << k;
    return {middle_[0] - side / 2, middle_[1] - side / 2, side};
  }
  std::int64_t snapped(std::int64_t cells) const {
    const std::int64_t step = (side_ / kShoreSteps) << kSquares;
    return models::network::floor_div(cells, step) * step;
  }
  // The finest detail that reads nodes of a level at the samples themselves.
  GroundDetail detail_of(int level) const {
    GroundDetail detail{2, false};
    while (network_.level_of(detail) > level)
      ++detail.level;
    return detail;
  }
  bool is_in_world(double x_cells, double z_cells) const {
    const auto inside = [&](double cells, double blocks) {
      return blocks == 0 || (cells >= 0 && cells <= blocks * static_cast<double>(block_cells_));
    };
    return inside(x_cells, blocks_.x) && inside(z_cells, blocks_.y);
  }
  static bool holds(const RiverNetwork::Cells& s, double x_cells, double z_cells) {
    const auto in = [&](double v, std::int64_t first) {
      return v >= static_cast<double>(first) && v < static_cast<double>(first + s.side);
    };
    return in(x_cells, s.x) && in(z_cells, s.z);
  }
  // A place in cells of the world, as metres from the corner.
  glm::vec3 from_corner(double x_cells, double height_m, double z_cells) const {
    return {(x_cells - static_cast<double>(corner_.x)) * cell_m_, height_m,
            (z_cells - static_cast<double>(corner_.z)) * cell_m_};
  }

  // A channel belongs to the square in which its node lies.
  void add_channels(std::size_t chords) {
    for (const auto& [patch, box] : parts_) {
      for (const Curve& curve : patch->curves) {
        if (!box.holds(curve.x, curve.z)) continue;
        const double x = cells(patch->x + curve.x), z = cells(patch->z + curve.z);
        if (holds(inner_, x, z) || !is_in_world(x, z)) continue;
        const auto end = [&](std::size_t s) {
          const float t = static_cast<float>(s) / Curve::kChords;
          return from_corner(x + double{curve.px[s]} / cell_m_,
                             double{models::network::level_m(curve, t)},
                             z + double{curve.pz[s]} / cell_m_);
        };
        const int width_px = river_width_px(double{curve.discharge_m3_s});
        for (std::size_t s = 0; s < curve.chords; s += chords) {
          const std::size_t next = std::min<std::size_t>(s + chords, curve.chords);
          map_.channels.push_back({{end(s), end(next)}, curve.discharge_m3_s, width_px});
        }
      }
    }
  }
  static double cells(std::int64_t units) {
    return static_cast<double>(units) / static_cast<double>(kUnitsPerCell);
  }

  // Ground and water at the samples of a square.
  struct Samples {
    static constexpr std::size_t kSide = kShoreSteps + 1;
    std::vector<std::int64_t> x, z;
    std::vector<float> height, water, flow_x, flow_z;
  };
  Samples sample() const {
    Samples s;
    const std::int64_t step = square_.side / kShoreSteps;
    for (std::int64_t i = 0; i <= kShoreSteps; ++i) {
      s.x.push_back(square_.x + i * step);
      s.z.push_back(square_.z + i * step);
    }
    for (auto* rows : {&s.height, &s.water, &s.flow_x, &s.flow_z})
      rows->resize(Samples::kSide * Samples::kSide);
    network_.evaluate({s.x, s.z}, detail_,
                      {.height_m = s.height.data(),
                       .water_m = s.water.data(),
                       .flow_x = s.flow_x.data(),
                       .flow_z = s.flow_z.data(),
                       .stride = Samples::kSide});
    return s;
  }
  void add_shores() {
    const auto sea_m = static_cast<float>(network_.frame().sea_level_m);
    const Samples s = sample();
    const auto is_lake = [&](std::size_t k) {
      constexpr float kEqualM = 0.02F;
      if (!(s.water[k] > s.height[k]) || s.water[k] < sea_m + kEqualM) return false;
      return (s.flow_x[k] == 0 && s.flow_z[k] == 0) ||
             std::ranges::any_of(parts_, [&](const RiverNetwork::Part& part) {
               return part.patch->is_lake_level(double{s.water[k]});
             });
    };
    const auto is_sea = [&](std::size_t k) {
      return s.height[k] < sea_m && s.water[k] > s.height[k] && !is_lake(k);
    };
    add_borders(s, is_lake, [&](std::size_t k) { return s.water[k]; });
    add_borders(s, is_sea, [&](std::size_t) { return sea_m; });
  }
  // Adds the border of still water, cell by cell: it crosses the sides whose ends differ.
  void add_borders(const Samples& s, const auto& is_wet, const auto& level_of) {
    constexpr std::array<std::array<std::size_t, 2>, 4> kCorners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t j = 0; j < kShoreSteps; ++j) {
      for (std::size_t i = 0; i < kShoreSteps; ++i) {
        std::array<std::size_t, 4> at{};
        std::array<bool, 4> wet{};
        float level_m = 0;
        int count = 0;
        for (std::size_t c = 0; c < 4; ++c) {
          at[c] = (j + kCorners[c][1]) * Samples::kSide + i + kCorners[c][0];
          wet[c] = is_wet(at[c]);
          if (!wet[c]) continue;
          level_m = std::max(level_m, level_of(at[c]));
          ++count;
        }
        if (count == 0 || count == 4) continue;
        const double x = middle_of(s.x, i), z = middle_of(s.z, j);
        if (holds(inner_, x, z) || !is_in_world(x, z)) continue;
        std::array<glm::vec3, 4> ends{};
        std::size_t crossed = 0;
        for (std::size_t c = 0; c < 4; ++c) {
          const std::size_t d = (c + 1) % 4;
          if (wet[c] == wet[d]) continue;
          // Heights of the ground over the water; a dry corner below it counts as little above it.
          const auto above = [&](std::size_t k) {
            const float m = s.height[at[k]] - level_m;
            return double{wet[k] ? std::min(m, -0.01F) : std::max(m, 0.2F)};
          };
          const double share = above(c) / (above(c) - above(d));
          const auto between = [&](const std::vector<std::int64_t>& axis, std::size_t from,
                                   std::size_t to) {
            return static_cast<double>(axis[from]) +
                   share * static_cast<double>(axis[to] - axis[from]);
          };
          ends[crossed++] =
              from_corner(between(s.x, i + kCorners[c][0], i + kCorners[d][0]), double{level_m},
                          between(s.z, j + kCorners[c][1], j + kCorners[d][1]));
        }
        for (std::size_t e = 0; e + 1 < crossed; e += 2)
          map_.shores.push_back({ends[e], ends[e + 1]});
      }
    }
  }
  static double middle_of(const std::vector<std::int64_t>& axis, std::size_t i) {
    return 0.5 * static_cast<double>(axis[i] + axis[i + 1]);
  }

  // Divides pass between nodes that drain to different places: through the middles of the edges of
  // the lattice's triangles.
  void add_divides(int squares) {
    const RiverNetwork::Cells all = square(squares - 1);
    const int level = network_.settings().halvings - (squares - 1);
    const auto nodes = network_.nodes(level, all.x, all.z, all.side);
    const models::network::Rect& rect = nodes.rect;
    const std::vector<std::size_t> mouths = mouths_of(nodes);
    const auto index = [&](std::int64_t i, std::int64_t j) {
      return static_cast<std::size_t>((j - rect.j0) * rect.width() + i - rect.i0);
    };
    const auto place = [&](std::size_t k) {
      return from_corner(cells(nodes.nodes[k].x), 0, cells(nodes.nodes[k].z));
    };
    const auto add = [&](const std::array<std::size_t, 3>& corners) {
      std::array<glm::vec3, 3> middles{};
      std::size_t cut = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t a = corners[c], b = corners[(c + 1) % 3];
        if (mouths[a] != mouths[b]) middles[cut++] = (place(a) + place(b)) * 0.5F;
      }
      if (cut == 2) map_.divides.push_back({middles[0], middles[1]});
      if (cut < 3) return;
      const glm::vec3 centre = (middles[0] + middles[1] + middles[2]) / 3.0F;
      for (const glm::vec3& middle : middles)
        map_.divides.push_back({middle, centre});
    };
    for (std::int64_t j = rect.j0; j + 1 < rect.j1; ++j) {
      for (std::int64_t i = rect.i0; i + 1 < rect.i1; ++i) {
        const auto& node = nodes.at(i, j);
        if (!holds(all, cells(node.x), cells(node.z)) || !is_in_world(cells(node.x), cells(node.z)))
          continue;
        add({index(i, j), index(i + 1, j), index(i, j + 1)});
        add({index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
      }
    }
  }
  // For each node, the node where its water ends or leaves the patch; small basins share a number.
  static std::vector<std::size_t> mouths_of(const models::network::NodePatch& nodes) {
    constexpr std::size_t kUnknown = SIZE_MAX, kSmall = SIZE_MAX - 1;
    const std::int64_t width = nodes.rect.width(), height = nodes.rect.height();
    std::vector<std::size_t> mouths(nodes.nodes.size(), kUnknown);
    std::vector<std::uint32_t> sizes(nodes.nodes.size(), 0);
    std::vector<std::size_t> way;
    for (std::size_t k = 0; k < mouths.size(); ++k) {
      std::size_t at = k;
      for (way.clear(); mouths[at] == kUnknown;) {
        way.push_back(at);
        const auto& node = nodes.nodes[at];
        const auto step = static_cast<std::size_t>(node.receiver);
        const auto here = static_cast<std::int64_t>(at);
        const bool ends = node.receiver == models::network::kSink;
        const std::int64_t i = ends ? -1 : here % width + models::network::kStepI[step];
        const std::int64_t j = ends ? -1 : here / width + models::network::kStepJ[step];
        if (i < 0 || j < 0 || i >= width || j >= height)
          mouths[at] = at;
        else
          at = static_cast<std::size_t>(j * width + i);
      }
      for (const std::size_t node : way) {
        mouths[node] = mouths[at];
        ++sizes[mouths[at]];
      }
    }
    for (std::size_t& mouth : mouths)
      mouth = sizes[mouth] < kSmallestBasin ? kSmall : mouth;
    return mouths;
  }

  const RiverNetwork& network_;
  double cell_m_;
  std::int64_t block_cells_;
  glm::dvec2 blocks_;
  const std::atomic<bool>& cancelled_;
  RiverNetwork::Cells corner_;  // of the map
  std::int64_t side_ = 0;       // of the finest square, cells
  std::array<std::int64_t, 2> middle_{};
  // Of the present square:
  RiverNetwork::Cells square_, inner_;
  GroundDetail detail_;
  std::vector<RiverNetwork::Part> parts_;
  RiverMap map_;
};

}  // namespace

RiverMap make_river_map(const models::RiverNetwork& network, const core::WorldPosition& around,
                        glm::dvec2 blocks, const std::atomic<bool>& cancelled) {
  return Maker(network, around, blocks, cancelled).make();
}

int river_width_px(double discharge_m3_s) {
  const double decade = std::round(std::log10(std::max(discharge_m3_s, 1e-6)));
  return std::clamp(static_cast<int>(decade) + kBrookDecades + 1, 1, kMaxRiverPx);
}

glm::vec3 river_colour(int width_px) {
  const glm::vec3 brook{0.55F, 0.85F, 1.0F}, stream{0.10F, 0.50F, 1.0F}, river{0.55F, 0.15F, 0.95F};
  const float part = 2 * static_cast<float>(width_px - 1) / (kMaxRiverPx - 1);
  return part < 1 ? glm::mix(brook, stream, part) : glm::mix(stream, river, part - 1);
}

double usual_discharge_m3_s(int width_px) {
  return std::pow(10.0, width_px - 1 - kBrookDecades);
}

}  // namespace psygen::editor
