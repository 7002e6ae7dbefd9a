#include "engine/models/network/halving.hpp"

#include <limits>
#include <optional>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::models::network {
namespace {

// Largest displacements of middles, in altitudes of the triangles at their edge. The small
// triangles of a halved one have half its altitude. A line can meet discs around their corners only
// if two radii add up to that. Two displacements in one triangle add up to less, so no triangle can
// fold: a river's middle goes far only where no other river's edge shares a triangle with its own.
constexpr double kFreeRiverShift = 0.36, kRiverShift = 0.24, kLandShift = 0.13;
constexpr double kSteepest = 0.6;         // of new ground that need not guard a bank
constexpr double kGatheringShare = 0.36;  // of sources
constexpr double kJoin = 8;               // preference of sources for other sources
constexpr int kLevelsWithMountains = 3;   // below them the field is interpolated
constexpr std::uint64_t kPlaceBits = 1, kHeightBits = 2, kSourceBits = 3, kSlopeBits = 8;

// The edge whose middle is being made, with the third corners of its two triangles. If it is part
// of the forest, a drains to b.
struct Edge {
  const Node *a, *b, *left, *right;
  int direction;  // from a to b
  bool tree;
  bool alone;  // no other edge of its two triangles is part of the forest
};

Edge edge_of(const NodePatch& coarse, std::int64_t i, std::int64_t j) {
  const bool odd_i = (i & 1) != 0, odd_j = (j & 1) != 0;
  Edge e{};
  e.direction = !odd_j ? 0 : odd_i ? 2 : 1;
  const std::int64_t ai = (i >> 1) + (e.direction == 2 ? 1 : 0), aj = j >> 1;
  e.a = &coarse.at(ai, aj);
  e.b = &coarse.beside(ai, aj, e.direction);
  e.left = &coarse.beside(ai, aj, (e.direction + 1) % 6);
  e.right = &coarse.beside(ai, aj, (e.direction + 5) % 6);
  const auto drains = [](const Node& from, const Node& to, int d) {
    return from.receiver == d || to.receiver == opposite(d);
  };
  const int d = e.direction;
  e.alone = !drains(*e.a, *e.left, (d + 1) % 6) && !drains(*e.a, *e.right, (d + 5) % 6) &&
            !drains(*e.b, *e.left, (d + 2) % 6) && !drains(*e.b, *e.right, (d + 4) % 6);
  const bool forth = e.a->receiver == e.direction;
  e.tree = forth || e.b->receiver == opposite(e.direction);
  if (e.tree && !forth) {
    std::swap(e.a, e.b);
    std::swap(e.left, e.right);
    e.direction = opposite(e.direction);
  }
  return e;
}

// Largest displacement of the middle of a–b in units, as far as the triangle a, b, c is concerned:
// it keeps triangles unfolded and edges shorter than kLongestEdge.
double freedom(const Edge& e, const Node& c, double shift, double spacing) {
  const auto difference = [](std::int64_t p, std::int64_t q) { return static_cast<double>(p - q); };
  const double bx = difference(e.b->x, e.a->x), bz = difference(e.b->z, e.a->z);
  const double cx = difference(c.x, e.a->x), cz = difference(c.z, e.a->z);
  const double longest = std::max({length(bx, bz), length(cx, cz), length(cx - bx, cz - bz)});
  return std::min(shift * std::abs(bx * cz - bz * cx) / longest,
                  (kLongestEdge * spacing - longest / 2) / 2);
}

// Names the lake of a sill.
std::uint32_t name_of(const Node& sill) {
  const std::uint64_t hash =
      core::combine(static_cast<std::uint64_t>(sill.x), static_cast<std::uint64_t>(sill.z));
  return lake_name(hash);
}

// Makes one middle. `level` is its level.
class Middle {
 public:
  Middle(const Scale& scale, const Edge& edge, int level, std::uint64_t bits)
      : scale_(scale), e_(edge), level_(level), bits_(bits) {
    ex_ = static_cast<double>(e_.b->x - e_.a->x);
    ez_ = static_cast<double>(e_.b->z - e_.a->z);
    length_ = length(ex_, ez_);
    // In units of height, so that slopes times lengths are heights.
    height_length_ = length_ * scale_.unit_m * kHeightUnits;
    const Pair random = pair_of(core::mix64(bits_ + kHeightBits));
    w_ = random.first;
    w2_ = random.second;
  }

  Node make(LandFields& fields) {
    n_.made = static_cast<std::uint8_t>(level_);
    n_.river = e_.tree;
    place();
    n_.mountain = level_ <= kLevelsWithMountains ? static_cast<float>(fields.mountains(n_.x, n_.z))
                                                 : 0.5F * (e_.a->mountain + e_.b->mountain);
    const Pair random = pair_of(core::mix64(bits_ + kSourceBits));
    source_ = random.first < kGatheringShare ? Source::kGathering : Source::kPlain;
    n_.sill = e_.tree && random.second < scale_.lakes[static_cast<std::size_t>(level_)];
    if (!e_.tree && (e_.a->kind == Kind::kSea || e_.b->kind == Kind::kSea))
      coast();
    else if (!(e_.tree ? lake_of_river() : lake_of_land()))
      e_.tree ? river() : land();
    n_.sill = n_.sill && n_.kind == Kind::kLand;
    return n_;
  }

 private:
  std::uint8_t towards_b() const { return static_cast<std::uint8_t>(e_.direction); }
  std::uint8_t towards_a() const { return static_cast<std::uint8_t>(opposite(e_.direction)); }
  // True if a lake fills the lower halves of the edges that run into a node of the coarser level.
  bool fills(const Node& n) const { return n.sill && level_ - 1 - n.made <= 1; }
  std::int32_t part(double fraction) const {
    return static_cast<std::int32_t>(fraction * height_length_);
  }

  void place() {
    const double spacing = static_cast<double>(scale_.spacing(level_));
    const double shift = !e_.tree ? kLandShift : e_.alone ? kFreeRiverShift : kRiverShift;
    const double reach =
        std::max(0.0, std::min({freedom(e_, *e_.left, shift, spacing),
                                freedom(e_, *e_.right, shift, spacing), kLargestShift * spacing}));
    const Pair random = pair_of(core::mix64(bits_ + kPlaceBits));
    double u = 2 * random.first - 1, v = 2 * random.second - 1;
    if (e_.tree) {  // to the side
      const double s = (u < 0 ? -1 : 1) * (0.7 + 0.3 * std::abs(u));
      u = s * -ez_ / length_;
      v = s * ex_ / length_;
    } else if (const double r = length(u, v); r > 1) {
      u /= r;
      v /= r;
    }
    n_.x = ((e_.a->x + e_.b->x) >> 1) + static_cast<std::int64_t>(u * reach);
    n_.z = ((e_.a->z + e_.b->z) >> 1) + static_cast<std::int64_t>(v * reach);
  }

  // Shoals, islands and the land beside the sea.
  void coast() {
    const bool shoal = e_.a->kind == Kind::kSea && e_.b->kind == Kind::kSea;
    n_.height = static_cast<std::int32_t>((std::int64_t{e_.a->height} + e_.b->height) >> 1) +
                part((w_ - 0.5) * (shoal ? 0.012 : 0.03));
    if (n_.height <= 0) {
      n_.kind = Kind::kSea;
      n_.height = std::min(n_.height, -512);
    } else {
      n_.height += 512;
      n_.fresh = source_;
    }
  }

  bool lake(const Node& of, double depth, std::uint8_t receiver) {
    n_.kind = Kind::kLake;
    n_.lake = of.lake != 0 ? of.lake : name_of(of);
    n_.height = of.height;
    n_.depth = std::max(1024, static_cast<std::int32_t>(depth));
    n_.receiver = receiver;
    if (!e_.tree) n_.area = 1;
    return true;
  }
  bool within_lake() {
    const Node &a = *e_.a, &b = *e_.b;
    if (a.kind != Kind::kLake || b.kind != Kind::kLake || a.lake != b.lake) return false;
    return lake(a, (a.depth + b.depth) / 2.0 + (w_ - 0.35) * height_length_ * 0.02,
                e_.tree || w_ < 0.5 ? towards_b() : towards_a());
  }
  bool lake_of_river() {
    const Node &a = *e_.a, &b = *e_.b;
    if (within_lake()) return true;
    // Down to the sill, which itself stays dry: else the lake would hang over the valley below.
    if (a.kind == Kind::kLake && a.height == b.height) return lake(a, a.depth, towards_b());
    if (fills(b)) return lake(b, height_length_ * (0.004 + 0.012 * w2_), towards_b());
    return b.kind == Kind::kLake && w_ < 0.25 && lake(b, b.depth, towards_b());
  }
  bool lake_of_land() {
    const Node &a = *e_.a, &b = *e_.b;
    if (within_lake()) return true;
    if (fills(a) && w2_ < 0.45 && b.height >= a.height)
      return lake(a, height_length_ * 0.006, towards_a());
    if (fills(b) && w2_ < 0.45 && a.height >= b.height)
      return lake(b, height_length_ * 0.006, towards_b());
    // Shores become irregular, but never reach lower ground.
    const bool lake_a = a.kind == Kind::kLake, lake_b = b.kind == Kind::kLake;
    if (lake_a && !lake_b && w2_ < 0.4 && a.height < b.height) return lake(a, a.depth, towards_a());
    return lake_b && !lake_a && w2_ < 0.4 && b.height < a.height && lake(b, b.depth, towards_b());
  }

  void river() {
    const std::int32_t drop = e_.a->height - e_.b->height;
    n_.height = e_.b->height + static_cast<std::int32_t>((0.32 + 0.28 * w_) * drop);
    // An estuary keeps its way to the open sea.
    n_.kind = e_.b->kind == Kind::kSea && n_.height <= 0 ? Kind::kSea : Kind::kLand;
    n_.receiver = towards_b();
  }
  // Above both ends, so that a channel keeps its banks. Where none runs through the higher end, no
  // steeper than need be.
  void land() {
    const bool a_high = e_.a->height > e_.b->height;
    const Node &high = a_high ? *e_.a : *e_.b, &low = a_high ? *e_.b : *e_.a;
    const std::int32_t drop = high.height - low.height;
    // Long edges of stretched triangles rise no more than others: rows of them would be ridges.
    const double usual = 1.8 * static_cast<double>(scale_.spacing(level_)) / length_;
    const std::int32_t rise =
        1 + part(std::min(usual, 1.0) * scale_.rise[static_cast<std::size_t>(level_)] *
                 (0.12 + 0.88 * static_cast<double>(n_.mountain)) * (0.25 + 0.75 * w_));
    n_.height = high.height + rise;
    if (high.kind == Kind::kLand && high.area < scale_.channel_area)
      n_.height = low.height + std::max(std::min(drop + rise, part(kSteepest / 2)), 1 + drop / 2);
    n_.fresh = source_;
  }

  const Scale& scale_;
  const Edge& e_;
  int level_;
  std::uint64_t bits_;
  double ex_, ez_, length_, height_length_, w_, w2_;
  Source source_ = Source::kNone;
  Node n_;
};

// Receivers and areas of the nodes that a halving made.
class Drainage {
 public:
  Drainage(const Scale& scale, NodePatch& nodes)
      : scale_(scale), f_(nodes), own_(1U << (2 * (scale.halvings() - nodes.level))) {}

  // Drains sources to lower neighbours: plain ones to gathering ones or to older water, gathering
  // ones to older water.
  void drain(const Rect& rect) {
    each(rect, [&](std::int64_t i, std::int64_t j, Node& n) {
      if (n.fresh == Source::kNone) return;
      const std::uint64_t bits = scale_.hash(f_.level, i, j);
      double best = -1;
      for (int d = 0; d < 6; ++d) {
        const Node& o = f_.beside(i, j, d);
        if (o.height >= n.height || o.fresh == Source::kPlain ||
            (o.fresh == Source::kGathering && n.fresh == Source::kGathering))
          continue;
        const std::int32_t floor = o.kind == Kind::kSea ? std::max(o.height, -1024) : o.height;
        const double random =
            pair_of(core::mix64(bits + kSlopeBits + static_cast<std::uint64_t>(d))).first;
        const double score = static_cast<double>(n.height - floor) / distance(n, o) *
                             (0.6 + 0.8 * random) * (o.fresh != Source::kNone ? kJoin : 1);
        if (score > best) {
          best = score;
          n.receiver = static_cast<std::uint8_t>(d);
        }
      }
      n.area = own_;
    });
  }
  // Adds plain sources to gathering ones. More than three would carry more than their receiver.
  void gather(const Rect& rect) {
    each(rect, [&](std::int64_t i, std::int64_t j, Node& n) {
      if (n.fresh == Source::kGathering)
        n.area = std::min(own_ + inflow(i, j, Source::kPlain), 3 * own_);
    });
  }
  // Gives middles of rivers an area between those of their ends.
  void carry(const Rect& rect) {
    each(rect, [&](std::int64_t i, std::int64_t j, Node& n) {
      if (n.made != f_.level || n.fresh != Source::kNone || n.receiver == kSink || n.area != 0)
        return;
      const Node& up = f_.beside(i, j, opposite(n.receiver));
      const Node& down = f_.beside(i, j, n.receiver);
      const bool open = down.kind == Kind::kSea && down.receiver == kSink;
      const std::uint32_t most =
          open ? std::numeric_limits<std::uint32_t>::max() : std::max(up.area, down.area);
      n.area = std::min(up.area + own_ + inflow(i, j, Source::kGathering), most);
    });
  }

 private:
  template <class Visit>
  void each(const Rect& r, const Visit& visit) {
    for (std::int64_t j = r.j0; j < r.j1; ++j) {
      for (std::int64_t i = r.i0; i < r.i1; ++i)
        visit(i, j, f_.at(i, j));
    }
  }
  // Areas of the sources of this kind and later ones that drain to a node.
  std::uint32_t inflow(std::int64_t i, std::int64_t j, Source from) const {
    std::uint32_t sum = 0;
    for (int d = 0; d < 6; ++d) {
      const Node& o = f_.beside(i, j, d);
      if (o.fresh >= from && o.receiver == opposite(d)) sum += o.area;
    }
    return sum;
  }

  const Scale& scale_;
  NodePatch& f_;
  std::uint32_t own_;
};

NodePatch cropped(const NodePatch& p, const Rect& r) {
  NodePatch result(p.level, r);
  for (std::int64_t j = r.j0; j < r.j1; ++j)
    std::copy_n(&p.at(r.i0, j), r.width(), &result.at(r.i0, j));
  return result;
}

// The rectangle of the nodes within `margin` of a square.
Rect reaching(const NodePatch& p, const Square& s, std::int64_t margin) {
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  Rect r{kFar, kFar, -kFar, -kFar};
  for (std::int64_t j = p.rect.j0; j < p.rect.j1; ++j) {
    for (std::int64_t i = p.rect.i0; i < p.rect.i1; ++i) {
      const Node& n = p.at(i, j);
      if (n.x < s.x - margin || n.x > s.x + s.side + margin || n.z < s.z - margin ||
          n.z > s.z + s.side + margin)
        continue;
      r = {std::min(r.i0, i), std::min(r.j0, j), std::max(r.i1, i + 1), std::max(r.j1, j + 1)};
    }
  }
  return r;
}

}  // namespace

Rect coarse_for(const Rect& w) {
  return {((w.i0 - 3) >> 1) - 1, ((w.j0 - 3) >> 1) - 1, ((w.i1 + 3) >> 1) + 3,
          ((w.j1 + 3) >> 1) + 3};
}

NodePatch halve(const Scale& scale, LandFields& fields, const NodePatch& coarse, const Rect& want) {
  PSYGEN_CHECK(coarse.rect.holds(coarse_for(want)), "the coarse nodes around the fine ones exist");
  NodePatch f(coarse.level + 1, want.grown(3));
  for (std::int64_t j = f.rect.j0; j < f.rect.j1; ++j) {
    for (std::int64_t i = f.rect.i0; i < f.rect.i1; ++i) {
      Node& n = f.at(i, j);
      if (((i | j) & 1) == 0) {
        n = coarse.at(i >> 1, j >> 1);
        n.fresh = Source::kNone;
      } else {
        const Edge edge = edge_of(coarse, i, j);
        n = Middle(scale, edge, f.level, scale.hash(f.level, i, j)).make(fields);
      }
    }
  }
  Drainage drainage(scale, f);
  drainage.drain(want.grown(2));
  drainage.gather(want.grown(1));
  drainage.carry(want);
  return cropped(f, want);
}

NodePatch nodes_around(const Scale& scale, RootNodes& root, int level, const Surroundings& around,
                       int finest) {
  const auto& [square, margin] = around;
  const std::int64_t s0 = scale.spacing0, row = s0 / 8 * 7;
  const std::int64_t j0 = floor_div(square.z - margin, row) - 11,
                     j1 = floor_div(square.z + square.side + margin, row) + 12;
  const std::int64_t i0 = floor_div(2 * (square.x - margin) - j1 * s0, 2 * s0) - 11,
                     i1 = floor_div(2 * (square.x + square.side + margin) - j0 * s0, 2 * s0) + 12;
  NodePatch p(0, {i0, j0, i1, j1});
  for (std::int64_t j = j0; j < j1; ++j) {
    for (std::int64_t i = i0; i < i1; ++i)
      p.at(i, j) = root.node(i, j);
  }
  return nodes_from(scale, root, p, level, around, finest);
}

NodePatch nodes_from(const Scale& scale, RootNodes& root, const NodePatch& coarse, int level,
                     const Surroundings& around, int finest) {
  // Descendants stay within kLargestShift of their triangle, whose edges are shorter than
  // kLongestEdge.
  const auto tight = [&](const NodePatch& p) {
    const auto beyond = static_cast<std::int64_t>((kLargestShift + kLongestEdge) *
                                                  static_cast<double>(scale.spacing(p.level)));
    return reaching(p, around.square, around.margin + beyond);
  };
  std::optional<NodePatch> made;
  for (int from = coarse.level; from < level; ++from) {
    const NodePatch& p = made ? *made : coarse;
    const Rect near = tight(p);
    // coarse_for() of these fits into those of the level above.
    constexpr std::array<std::int64_t, 4> kRings{2, 5, 6, 7};
    const std::int64_t rings = kRings[static_cast<std::size_t>(std::min(finest - from - 1, 3))];
    const Rect want = Rect{2 * near.i0, 2 * near.j0, 2 * near.i1 - 1, 2 * near.j1 - 1}.grown(rings);
    made = halve(scale, root.fields(), p, want);
  }
  if (!made) return coarse;
  return *std::move(made);
}

}  // namespace psygen::models::network
