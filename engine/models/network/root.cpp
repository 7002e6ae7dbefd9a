#include "engine/models/network/root.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/models/kit/exact_math.hpp"

namespace psygen::models::network {
namespace {

constexpr std::int32_t kMinCost = 64, kMaxCost = 1024;
constexpr std::int32_t kLakeCost = 18 * kMinCost;  // of a path that ends in an inland lake
constexpr std::int64_t kLakeEvery = 14;            // nodes: one possible inland lake in a square
constexpr double kJitter = 0.22;                   // of root nodes, in spacings
constexpr std::uint64_t kPlaceBits = 1, kLakeBits = 2, kHeightBits = 3, kCostBits = 10;

// The offset of noise of which this fraction lies below 0 (measured). 0 and 1 leave nothing over.
double offset_below(double fraction) {
  constexpr std::array<double, 11> kOffsets{.65,   .352,  .235,  .148,  .071, 0,
                                            -.071, -.148, -.235, -.352, -.65};
  if (fraction <= 0) return 9;
  if (fraction >= 1) return -9;
  const auto k = static_cast<std::size_t>(fraction * 10);
  return kOffsets[k] + (fraction * 10 - static_cast<double>(k)) * (kOffsets[k + 1] - kOffsets[k]);
}

}  // namespace

Scale::Scale(const RiverSettings& s, const RiverFrame& f) : settings(s), frame(f) {
  const auto finest = static_cast<std::int64_t>(
      std::floor(std::ldexp(s.root_spacing_m / f.cell_m, -s.halvings) + 0.5));
  spacing0 = (finest * kUnitsPerCell) << s.halvings;
  unit_m = f.cell_m / static_cast<double>(kUnitsPerCell);
  const double finest_km = static_cast<double>(finest) * f.cell_m / 1000;
  node_km2 = finest_km * finest_km * 0.875;
  size = static_cast<double>(spacing0) * unit_m / 8192;
  channel_area = static_cast<std::uint32_t>(std::clamp(s.channel_km2 / node_km2 + 0.5, 1.0, 4e9));
  for (std::size_t k = 0; k < keys.size(); ++k)
    keys[k] = core::combine(core::combine(core::mix64(RiverSettings::kRandomEdition), s.seed), k);
  // Slopes depend on the length of the edge, whatever level has it. Edges of 8192 m come first.
  constexpr std::array<double, 12> kRise{.009, .011, .019, .035, .062, .088,
                                         .093, .066, .042, .032, .023, .018};
  constexpr std::array<double, 6> kSills{.06, .05, .05, .04, .03, .01};
  const double first = -exact_log(size) / 0.69314718055994531;
  for (int k = 0; k <= s.halvings; ++k) {
    const double place = std::clamp(first + k, 0.0, 10.999);
    const auto p = static_cast<std::size_t>(place);
    const auto level = static_cast<std::size_t>(k);
    rise[level] =
        s.steepness * (kRise[p] + (place - static_cast<double>(p)) * (kRise[p + 1] - kRise[p]));
    // A sill needs two more levels to fill its lake.
    lakes[level] = k + 2 <= s.halvings && level < kSills.size()
                       ? std::min(1.0, kSills[level] * s.lake_share / 0.04)
                       : 0;
  }
}

LandFields::LandFields(const Scale& scale) {
  const auto octave = [&](std::int64_t eighths, std::uint64_t key, double amplitude) {
    Octave result;
    result.cell = scale.spacing0 / 8 * eighths;
    result.key = core::combine(scale.keys[15], key);
    result.amplitude = amplitude;
    return result;
  };
  land_ = {octave(192, 1, 1), octave(72, 2, 0.5), octave(30, 3, 0.25)};
  high_ = {octave(58, 4, 1), octave(26, 5, 0.5)};
  land_offset_ = offset_below(scale.settings.sea_share);
  high_offset_ = offset_below(1 - scale.settings.mountain_share);
}

double LandFields::Octave::at(std::int64_t x, std::int64_t z) {
  const std::int64_t ci = floor_div(x, cell), cj = floor_div(z, cell);
  if (!valid || ci != i || cj != j) {
    valid = true, i = ci, j = cj;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto a = static_cast<std::uint64_t>(ci + static_cast<std::int64_t>(k & 1));
      const auto b = static_cast<std::uint64_t>(cj + static_cast<std::int64_t>(k >> 1));
      const std::uint64_t h = core::mix64(core::mix64(key ^ a) + b);
      const Pair slope = pair_of(h), value = pair_of(core::mix64(h));
      corners[k] = {2 * slope.first - 1, 2 * slope.second - 1, 0.35 * (2 * value.first - 1)};
    }
  }
  const double size = static_cast<double>(cell);
  const double fx = static_cast<double>(x - ci * cell) / size;
  const double fz = static_cast<double>(z - cj * cell) / size;
  const auto corner = [&](std::size_t k, double dx, double dz) {
    return corners[k].gx * dx + corners[k].gz * dz + corners[k].value;
  };
  const auto fade = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const double u = fade(fx), v = fade(fz);
  const double near = corner(0, fx, fz), far = corner(2, fx, fz - 1);
  const double low = near + u * (corner(1, fx - 1, fz) - near);
  const double high = far + u * (corner(3, fx - 1, fz - 1) - far);
  return amplitude * (low + v * (high - low));
}

double LandFields::continent(std::int64_t x, std::int64_t z) {
  return land_[0].at(x, z) + land_[1].at(x, z) + land_[2].at(x, z) + land_offset_;
}

double LandFields::mountains(std::int64_t x, std::int64_t z) {
  const double t =
      std::clamp(0.5 + 1.3 * (high_[0].at(x, z) + high_[1].at(x, z) + high_offset_), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

namespace {

// The rest position of a root node plus a random vector.
Node placed(const Scale& scale, std::int64_t i, std::int64_t j) {
  const Pair p = pair_of(core::mix64(scale.hash(0, i, j) + kPlaceBits));
  double a = 2 * p.first - 1, b = 2 * p.second - 1;
  if (const double r = length(a, b); r > 1) {
    a /= r;
    b /= r;
  }
  const double reach = kJitter * static_cast<double>(scale.spacing0);
  Node n;
  n.x = (2 * i + j) * (scale.spacing0 / 2) + static_cast<std::int64_t>(a * reach);
  n.z = j * (scale.spacing0 / 8 * 7) + static_cast<std::int64_t>(b * reach);
  return n;
}

bool may_be_lake(const Scale& scale, std::int64_t i, std::int64_t j) {
  const std::int64_t a = floor_div(i, kLakeEvery), b = floor_div(j, kLakeEvery);
  const std::uint64_t h = core::mix64(scale.hash(0, a, b) + kLakeBits);
  constexpr auto kSide = static_cast<std::uint64_t>(kLakeEvery);
  return i - a * kLakeEvery == static_cast<std::int64_t>(h % kSide) &&
         j - b * kLakeEvery == static_cast<std::int64_t>((h >> 32) % kSide);
}

// Dijkstra's algorithm in a window around a tile.
class Window {
 public:
  Window(const Scale& scale, const TileKey& key, std::int64_t border)
      : scale_(scale),
        border_(border),
        side_(RootTile::kSide + 2 * border),
        i0_(key.i * RootTile::kSide - border),
        j0_(key.j * RootTile::kSide - border) {
    const auto count = static_cast<std::size_t>(side_ * side_);
    cost_to_.assign(count, std::numeric_limits<std::int32_t>::max());
    sea_.resize(count);
    costs_.resize(count);
    first_.fill(-1);
    prepare();
    settle();
  }

  // Writes the ways of the tile; false if a path from outside could be as cheap.
  bool write(RootTile& tile) const {
    for (std::int64_t v = 0; v < RootTile::kSide; ++v) {
      for (std::int64_t u = 0; u < RootTile::kSide; ++u) {
        const std::int64_t x = u + border_, y = v + border_;
        const std::size_t q = index(x, y);
        const std::int64_t rim = 1 + std::min({x, y, side_ - 1 - x, side_ - 1 - y});
        // Less, not equal: then neighbours that could tie are exact too.
        if (cost_to_[q] >= kMinCost * rim) return false;
        Way& way = tile.ways[static_cast<std::size_t>(v * RootTile::kSide + u)];
        way = {kSink, sea_[q] != 0};
        if (way.sea || (cost_to_[q] == kLakeCost && may_be_lake(scale_, i0_ + x, j0_ + y)))
          continue;
        for (int d = 5; d >= 0; --d) {
          if (cost_to_[neighbour(q, d)] + edge(q, d) == cost_to_[q])
            way.receiver = static_cast<std::uint8_t>(d);
        }
      }
    }
    return true;
  }

 private:
  struct Entry {
    std::int32_t node, next;
  };
  // Costs in flight span less than this.
  static constexpr std::size_t kBuckets = 2048;

  std::size_t index(std::int64_t u, std::int64_t v) const {
    return static_cast<std::size_t>(v * side_ + u);
  }
  std::size_t neighbour(std::size_t q, int d) const {
    const auto k = static_cast<std::size_t>(d);
    return static_cast<std::size_t>(static_cast<std::int64_t>(q) + kStepJ[k] * side_ + kStepI[k]);
  }
  std::int32_t edge(std::size_t q, int d) const {
    return d < 3 ? costs_[q][static_cast<std::size_t>(d)]
                 : costs_[neighbour(q, d)][static_cast<std::size_t>(d - 3)];
  }
  void push(std::size_t q, std::int32_t cost) {
    cost_to_[q] = cost;
    std::int32_t& first = first_[static_cast<std::size_t>(cost) % kBuckets];
    entries_.push_back({static_cast<std::int32_t>(q), first});
    first = static_cast<std::int32_t>(entries_.size() - 1);
    ++waiting_;
  }

  // Finds the costs of all edges, the sea and the inland lakes.
  void prepare() {
    LandFields fields(scale_);
    for (std::int64_t v = 0; v < side_; ++v) {
      for (std::int64_t u = 0; u < side_; ++u) {
        const std::int64_t i = i0_ + u, j = j0_ + v;
        const std::size_t q = index(u, v);
        const double m =
            fields.mountains((2 * i + j) * (scale_.spacing0 / 2), j * (scale_.spacing0 / 8 * 7));
        // Paths go around mountains.
        const auto range = static_cast<std::uint64_t>((0.25 + 0.75 * m) * (kMaxCost - kMinCost));
        const std::uint64_t bits = core::mix64(scale_.hash(0, i, j) + kCostBits);
        for (std::size_t d = 0; d < 3; ++d) {
          // The square makes cheap edges frequent, so paths wander and merge.
          const std::uint64_t r = (bits >> (21 * d)) & 0xFFFFF;
          costs_[q][d] = kMinCost + static_cast<std::int32_t>(((r * r >> 20) * range) >> 20);
        }
        const Node p = placed(scale_, i, j);
        sea_[q] = fields.continent(p.x, p.z) < 0;
        if (sea_[q] != 0)
          push(q, 0);
        else if (may_be_lake(scale_, i, j))
          push(q, kLakeCost);
      }
    }
  }
  void settle() {
    for (std::int32_t now = 0; waiting_ > 0; ++now) {
      std::int32_t& first = first_[static_cast<std::size_t>(now) % kBuckets];
      while (first >= 0) {
        const Entry entry = entries_[static_cast<std::size_t>(first)];
        first = entry.next;
        --waiting_;
        const auto q = static_cast<std::size_t>(entry.node);
        if (now == cost_to_[q]) relax(q, now);
      }
    }
  }
  void relax(std::size_t q, std::int32_t now) {
    const std::int64_t u = static_cast<std::int64_t>(q) % side_;
    const std::int64_t v = static_cast<std::int64_t>(q) / side_;
    for (int d = 0; d < 6; ++d) {
      const auto k = static_cast<std::size_t>(d);
      const std::int64_t x = u + kStepI[k], y = v + kStepJ[k];
      if (x < 0 || y < 0 || x >= side_ || y >= side_) continue;
      const std::size_t p = index(x, y);
      if (sea_[p] != 0) continue;
      if (const std::int32_t next = now + edge(q, d); next < cost_to_[p]) push(p, next);
    }
  }

  const Scale& scale_;
  std::int64_t border_, side_, i0_, j0_;
  std::vector<std::int32_t> cost_to_;
  std::vector<std::uint8_t> sea_;
  std::vector<std::array<std::int32_t, 3>> costs_;
  std::array<std::int32_t, kBuckets> first_;
  std::vector<Entry> entries_;
  std::size_t waiting_ = 0;
};

}  // namespace

RootTile make_root_tile(const Scale& scale, const TileKey& key, std::int64_t border) {
  RootTile tile;
  while (!Window(scale, key, border).write(tile))
    border += 16;
  return tile;
}

RootNodes::RootNodes(const Scale& scale, TileSource tiles)
    : scale_(scale), source_(std::move(tiles)), fields_(scale) {}

const Way& RootNodes::way(std::int64_t i, std::int64_t j) {
  const TileKey key{0, floor_div(i, RootTile::kSide), floor_div(j, RootTile::kSide)};
  if (key != last_) {
    std::shared_ptr<const RootTile>& tile = tiles_[key];
    if (tile == nullptr) tile = source_(key);
    last_ = key;
    last_tile_ = tile.get();
  }
  return last_tile_->ways[static_cast<std::size_t>((j - key.j * RootTile::kSide) * RootTile::kSide +
                                                   i - key.i * RootTile::kSide)];
}

std::uint32_t RootNodes::area(std::int64_t i, std::int64_t j) {
  const TileKey key{0, i, j};
  if (const auto it = areas_.find(key); it != areas_.end()) return it->second;
  std::uint32_t sum = 1;
  for (int d = 0; d < 6; ++d) {
    const auto k = static_cast<std::size_t>(d);
    const Way up = way(i + kStepI[k], j + kStepJ[k]);
    if (!up.sea && up.receiver == opposite(d)) sum += area(i + kStepI[k], j + kStepJ[k]);
  }
  areas_.emplace(key, sum);
  return sum;
}

const Node& RootNodes::node(std::int64_t i, std::int64_t j) {
  const TileKey key{0, i, j};
  if (const auto it = nodes_.find(key); it != nodes_.end()) return it->second;
  const Way w = way(i, j);
  const std::uint64_t bits = core::mix64(scale_.hash(0, i, j) + kHeightBits);
  const Pair random = pair_of(bits);
  Node n = placed(scale_, i, j);
  n.receiver = w.receiver;
  n.river = true;
  n.mountain = static_cast<float>(fields_.mountains(n.x, n.z));
  const int finest = 2 * scale_.halvings();
  // Of heights that are given in metres for a root of 8192 m.
  const double metres = scale_.size * kHeightUnits;
  if (w.sea) {
    n.kind = Kind::kSea;
    const double floor = std::min(-6.0, fields_.continent(n.x, n.z) * 400);
    n.height = static_cast<std::int32_t>(floor * metres);
  } else if (w.receiver == kSink) {
    n.kind = Kind::kLake;
    n.sill = true;
    n.lake = lake_name(bits);
    n.area = area(i, j) << finest;
    n.height = static_cast<std::int32_t>((60 + 120 * random.first) * metres);
    n.depth = static_cast<std::int32_t>(60 * metres);
  } else {
    const auto d = static_cast<std::size_t>(w.receiver);
    const Node& down = node(i + kStepI[d], j + kStepJ[d]);
    const std::uint32_t nodes = area(i, j);
    const double m = 0.5 * (static_cast<double>(n.mountain) + static_cast<double>(down.mountain));
    const double slope = scale_.settings.steepness * (0.0015 + 0.022 * m) *
                         exact_pow(nodes, -0.35) * (0.6 + 0.8 * random.first);
    n.area = nodes << finest;
    n.height = std::max(down.height, 0) + 1 + static_cast<std::int32_t>(metres) +
               static_cast<std::int32_t>(slope * distance(n, down) * scale_.unit_m * kHeightUnits);
    n.sill = random.second < scale_.lakes[0];
  }
  return nodes_.emplace(key, n).first->second;
}

}  // namespace psygen::models::network
