// The tree once more, as docs/models.md defines it: in double precision, branch by branch, with the
// library's sines and cosines. Gives the places and normals of a level's vertices in the order of
// the mesh. The tests hold the engine's meshes to it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "engine/models/tree_plan.hpp"

namespace psygen::models::test {

class TreeOracle {
 public:
  explicit TreeOracle(const TreePlan& plan) : p_(plan) { depth_ = deepest(grow(0)); }

  struct Vertex {
    glm::dvec3 place, normal;
    bool bark = false;  // of a tube: never pulled in by the tree's box
  };
  struct Branch {
    std::uint32_t key = 0;
    std::size_t kind = 0;
    int depth = 0;
    glm::dvec3 base{0}, direction{0}, bend{0};
    double length = 0, start = 0;
    glm::dvec3 at(double t) const { return base + length * (t * direction + t * t * bend); }
  };
  using Branches = std::vector<Branch>;

  int depth() const { return depth_; }
  bool is_tip(const Branch& b) const { return b.depth == depth_ || !p_.grammar->grows(b.kind); }

  // Branches of at most `paths` paths (0: all), ordered by depth, kind, parent, rank.
  Branches grow(std::uint64_t paths) const {
    Branches all{trunk()};
    std::vector<std::uint64_t> shares{paths};
    std::size_t first = 0;
    for (int d = 1; d <= p_.iterations; ++d) {
      std::array<Branches, kMaxKinds> next;
      std::array<std::vector<std::uint64_t>, kMaxKinds> next_shares;
      std::size_t count = 0;
      for (std::size_t i = first; i < all.size(); ++i) {
        if (!p_.grammar->grows(all[i].kind)) continue;
        const auto counts = children(all[i]);
        const auto parts = shared(all[i], counts, shares[i], p_.iterations - d);
        std::size_t child_index = 0;
        for (std::size_t kind = 0; kind < p_.grammar->kinds; ++kind)
          for (std::uint32_t rank = 0; rank < counts[kind]; ++rank, ++child_index) {
            if (paths != 0 && parts[child_index] == 0) continue;
            next[kind].push_back(child(all[i], kind, rank, counts[kind]));
            next_shares[kind].push_back(paths == 0 ? 0 : parts[child_index]);
            ++count;
          }
      }
      if (count == 0 || all.size() + count > kMaxTreeNodes || (depth_ >= 0 && d > depth_)) break;
      first = all.size();
      for (std::size_t kind = 0; kind < p_.grammar->kinds; ++kind) {
        all.insert(all.end(), next[kind].begin(), next[kind].end());
        shares.insert(shares.end(), next_shares[kind].begin(), next_shares[kind].end());
      }
    }
    return all;
  }

  std::vector<Vertex> mesh(int level) {
    vertices_.clear();
    find_crown();
    const bool leafy = p_.foliage.near != nullptr;
    if (leafy && level >= 4) {
      cone({0, -2.0 * static_cast<double>(p_.radius_m), 0},
           static_cast<double>(p_.radius_m) * (1 + 0.3 * static_cast<double>(p_.flare)));
      hull(level);
      return vertices_;
    }
    static constexpr std::uint64_t kLeafy[4] = {0, 0, 64, 16}, kBare[6] = {0, 0, 64, 16, 5, 2};
    const Branches all = grow(leafy ? kLeafy[level] : kBare[level]);
    bark(all, level);
    if (leafy && level >= 2) cone(all[0].at(1), all[0].start * static_cast<double>(p_.taper));
    if (leafy) sprays(all, level);
    return vertices_;
  }

 private:
  static double d(float v) { return static_cast<double>(v); }
  static std::uint32_t mix(std::uint32_t h) {
    h = (h ^ (h >> 16)) * 0x7FEB352DU;
    h = (h ^ (h >> 15)) * 0x846CA68BU;
    return h ^ (h >> 16);
  }
  std::uint32_t number(std::uint32_t key, std::uint32_t i) const {
    return mix(key ^ (p_.salt + i * 0x85EBCA6BU));
  }
  static double low(std::uint32_t h) { return (h & 0xFFFF) / 65536.0; }
  static double high(std::uint32_t h) { return (h >> 16) / 65536.0; }

  using Counts = std::array<std::uint32_t, kMaxKinds>;
  Counts children(const Branch& b) const {
    const std::uint32_t draw = number(b.key, 4);
    const Grammar& g = *p_.grammar;
    std::size_t r = g.first_rule[b.kind];
    while ((draw & 0xFFFF) >= g.rules[r].until)
      ++r;
    Counts counts{};
    int fixed = 0;
    for (std::size_t k = 0; k < g.kinds; ++k)
      fixed += static_cast<int>(counts[k] = g.rules[r].count[k]);
    if (g.rules[r].star != kNoKind) {
      const int drawn =
          p_.branches - g.spread + static_cast<int>(std::floor((2 * g.spread + 1) * high(draw)));
      counts[g.rules[r].star] +=
          static_cast<std::uint32_t>(std::max(std::max(drawn, 1) - fixed, 0));
    }
    return counts;
  }
  std::vector<std::uint64_t> shared(const Branch& b, const Counts& counts, std::uint64_t budget,
                                    int remaining) const {
    std::vector<std::uint64_t> weights, parts;
    std::uint64_t total = 0, sum = 0;
    for (std::size_t k = 0; k < p_.grammar->kinds; ++k)
      for (std::uint32_t i = 0; i < counts[k]; ++i)
        weights.push_back(
            p_.weights == nullptr ? 1 : (*p_.weights)[k][static_cast<std::size_t>(remaining)]);
    for (const std::uint64_t w : weights)
      total += w;
    const std::uint64_t phase = number(b.key, 4) & 0xFFFF;
    std::uint64_t before = 0;
    for (const std::uint64_t w : weights) {
      sum += w;
      const std::uint64_t reached = (budget * sum * 65536 + phase * total) / (total * 65536);
      parts.push_back(reached - before);
      before = reached;
    }
    return parts;
  }
  static int deepest(const Branches& all) { return all.back().depth; }

  Branch trunk() const {
    Branch b;
    b.key = p_.key;
    b.kind = p_.axiom;
    const std::uint32_t h[4] = {number(b.key, 0), number(b.key, 1), number(b.key, 2),
                                number(b.key, 3)};
    b.direction =
        glm::normalize(glm::dvec3{0.16 * (low(h[0]) - 0.5), 1, 0.16 * (high(h[0]) - 0.5)});
    b.bend = 0.5 * d(p_.trunk_curvature) * glm::dvec3{low(h[2]) - 0.5, 0, low(h[3]) - 0.5};
    b.length = d(p_.size_m) * (0.9 + 0.2 * low(h[1]));
    b.start = d(p_.radius_m) * (0.85 + 0.3 * high(h[1]));
    return b;
  }

  struct Axes {
    glm::dvec3 u, v;
  };
  static Axes frame(const glm::dvec3& t) {
    const double sign = t.y >= 0 ? 1 : -1;
    const double a = -1 / (sign + t.y), b = t.z * t.x * a;
    return {{sign * b, -sign * t.z, 1 + sign * t.z * t.z * a}, {sign + t.x * t.x * a, -t.x, b}};
  }

  Branch child(const Branch& p, std::size_t kind, std::uint32_t rank, std::uint32_t of) const {
    const KindPlan& k = p_.kinds[kind];
    Branch b;
    b.kind = kind;
    b.key = mix(p.key + 0x9E3779B9U * (static_cast<std::uint32_t>(kind) * 64 + rank + 1));
    b.depth = p.depth + 1;
    const std::uint32_t h[4] = {number(b.key, 0), number(b.key, 1), number(b.key, 2),
                                number(b.key, 3)};
    const double a = k.leader ? 0 : (rank + 0.7 * low(h[0])) / of;
    const double t = d(k.along_high) - a * (d(k.along_high) - d(k.along_low));
    const double v = d(k.angle_variation);
    const glm::dvec3 tangent = glm::normalize(p.direction + 2 * t * p.bend);
    b.base = p.at(t);
    b.direction = tangent;
    if (!k.leader) {
      const double tilt = 2 * std::numbers::pi * (1 + v * (2 * high(h[0]) - 1)) *
                          (d(k.angle_high) + a * (d(k.angle_low) - d(k.angle_high)));
      const double psi =
          2 * std::numbers::pi * (low(p.key) + d(k.whorl) * rank + 0.3 * v * (low(h[1]) - 0.5));
      const Axes f = frame(tangent);
      b.direction =
          std::cos(tilt) * tangent + std::sin(tilt) * (std::cos(psi) * f.u + std::sin(psi) * f.v);
    }
    b.direction = glm::normalize(b.direction + glm::dvec3{0, d(k.lift), 0});
    b.bend = 0.5 * d(k.curvature) * glm::dvec3{low(h[2]) - 0.5, high(h[2]) - 0.5, low(h[3]) - 0.5} +
             glm::dvec3{0, d(k.bend_up), 0};
    b.length = p.length * (0.85 + 0.3 * high(h[1])) *
               (d(k.length_high) + (1 - t) * (d(k.length_foot) - d(k.length_high)));
    const glm::dvec3 q =
        (b.base + b.length * (b.direction + b.bend) - glm::dvec3{0, d(p_.envelope_y), 0}) *
        glm::dvec3{d(p_.limit_across), d(p_.limit_up), d(p_.limit_across)};
    if (p_.limit_across > 0) b.length /= std::max(1.0, glm::dot(q, q));
    b.start = p.start * (1 - t * (1 - d(p_.taper))) * d(k.radius);
    return b;
  }

  bool bears(const Branch& b) const {
    const LeavesOn on = p_.kinds[b.kind].leaves;
    return on == LeavesOn::kAll || (on == LeavesOn::kTips && is_tip(b));
  }
  Branches bearers(const Branches& all) const {
    Branches found;
    for (const Branch& b : all)
      if (p_.foliage.near != nullptr && bears(b)) found.push_back(b);
    for (const Branch& b : all)
      if (found.empty() || !bears(found[0]))
        if (is_tip(b)) found.push_back(b);
    return found;
  }

  void find_crown() {
    std::vector<glm::dvec3> ends;
    for (const Branch& b : bearers(grow(16)))
      ends.push_back(b.at(1));
    const double n = static_cast<double>(ends.size());
    center_ = glm::dvec3(0);
    for (const glm::dvec3& e : ends)
      center_ += e / n;
    double across = 0, up = 0;
    for (const glm::dvec3& e : ends) {
      const glm::dvec3 v = e - center_;
      across += (v.x * v.x + v.z * v.z) / (2 * n);
      up += v.y * v.y / n;
    }
    half_ = glm::dvec3(0.3 * d(p_.size_m)) +
            1.5 * glm::dvec3{std::sqrt(across), std::sqrt(up), std::sqrt(across)};
    crown_radius_ = (2 * half_.x + half_.y) / 3;
  }

  static glm::dvec3 corner(int side, int sides, const glm::dvec3& u, const glm::dvec3& v) {
    const double angle = 2 * std::numbers::pi * side / sides;
    return std::cos(angle) * u + std::sin(angle) * v;
  }

  void cone(const glm::dvec3& from, double r) {
    for (int side = 0; side < 3; ++side) {
      const glm::dvec3 o = corner(side, 3, {1, 0, 0}, {0, 0, 1});
      vertices_.push_back({from + r * o, o});
    }
    vertices_.push_back({center_, {0, 1, 0}});
  }

  // Place of lane i of 16 in a block.
  static std::size_t place_in_block(std::size_t i) { return i % 4 * 4 + i / 4; }

  // Tubes one after the other; those in whole blocks of 16 (unless `rings`) vertex by vertex.
  void put(const std::vector<std::vector<Vertex>>& tubes, bool whole_only) {
    const std::size_t blocked = whole_only ? tubes.size() / 16 * 16 : 0;
    for (std::size_t first = 0; first < blocked; first += 16)
      for (std::size_t v = 0; v < tubes[first].size(); ++v) {
        std::array<Vertex, 16> row;
        for (std::size_t i = 0; i < 16; ++i)
          row[place_in_block(i)] = tubes[first + i][v];
        vertices_.insert(vertices_.end(), row.begin(), row.end());
      }
    for (std::size_t i = blocked; i < tubes.size(); ++i)
      vertices_.insert(vertices_.end(), tubes[i].begin(), tubes[i].end());
  }

  void bark(const Branches& all, int level) {
    static constexpr int kSides[6][4] = {{8, 5, 4, 3}, {6, 4, 3, 0}, {4, 3, 0, 0}, {3, 0, 0, 0}};
    static constexpr int kSegments[6][4] = {{6, 3, 2, 1}, {3, 2, 1, 0}, {2, 1, 0, 0}, {1, 0, 0, 0}};
    for (int depth = 0; depth <= depth_; ++depth) {
      const auto column = static_cast<std::size_t>(std::min(depth, 3));
      int sides = kSides[level][column], segments = kSegments[level][column];
      if (p_.foliage.near == nullptr && (level > 1 || sides == 0)) sides = 3, segments = 1;
      if (sides == 0) continue;
      for (const bool tip : {false, true}) {
        std::vector<std::vector<Vertex>> tubes;
        for (const Branch& b : all)
          if (b.depth == depth && is_tip(b) == tip) tubes.push_back(tube(b, sides, segments));
        put(tubes, tip || tubes.size() >= 16);
      }
    }
  }

  std::vector<Vertex> tube(const Branch& b, int sides, int segments) const {
    const std::vector<double> six{0, 0.06, 0.16, 0.34, 0.55, 0.78, 1}, three{0, 0.14, 0.5, 1},
        two{0, 0.2, 1};
    std::vector<Vertex> result;
    const Axes f = frame(b.direction);
    const std::uint32_t z = number(b.key, 5);
    for (int ring = 0; ring <= segments; ++ring) {
      const auto r = static_cast<std::size_t>(ring);
      double t = static_cast<double>(ring) / segments, flare = 0;
      if (b.depth == 0) {
        if (segments > 1) t = segments == 6 ? six[r] : segments == 3 ? three[r] : two[r];
        flare = d(p_.flare) * std::pow(std::max(1 - 3 * t, 0.0), 2) *
                (segments == 1   ? 0.3
                 : segments == 2 ? 0.6
                                 : 1.0);
      }
      glm::dvec3 middle = b.at(t);
      if (b.depth == 0 && ring == 0) middle.y -= 2 * d(p_.radius_m);
      const double end = is_tip(b) ? 0 : d(p_.taper);
      const int corners = is_tip(b) && ring == segments ? 1 : sides;
      for (int x = 0; x < corners; ++x) {
        const glm::dvec3 o = corner(x, sides, f.u, f.v);
        const std::uint32_t e =
            ((z + (static_cast<std::uint32_t>(x) + 1000) * 0x9E3779B9U) * 0x846CA68BU) >> 29;
        const double distance = b.start * (1 - t * (1 - end)) * (1 + flare * (0.4 + 0.16 * e));
        result.push_back({middle + distance * (o - glm::dot(o, 2 * t * b.bend) * b.direction),
                          corners == 1 ? b.direction : o, true});
      }
    }
    return result;
  }

  void sprays(const Branches& all, int level) {
    const Branches on = bearers(all);
    const double share = d(p_.foliage.density) * (level == 0 ? 1 : 0.3125);
    std::size_t n = std::clamp<std::size_t>(
        static_cast<std::size_t>(static_cast<float>(static_cast<double>(on.size()) * share)),
        level == 0 ? 256 : 64, level == 0 ? 4096 : 768);
    n = std::min<std::size_t>(n, (65536 - vertices_.size()) / 10) / 16 * 16;
    if (level >= 2) n = level == 2 ? 64 : 16;
    const SprayForm& form = level < 2 ? *p_.foliage.near : *p_.foliage.far;
    std::vector<std::vector<Vertex>> made;
    for (std::size_t k = 0; k < n; ++k)
      made.push_back(spray(on[k % on.size()], static_cast<std::uint32_t>(k), level, form,
                           static_cast<double>(n), static_cast<double>(on.size())));
    put(made, true);
  }

  static double whole(std::uint32_t half) {  // 16 bits as a signed fraction
    return static_cast<double>(static_cast<std::int16_t>(half & 0xFFFF)) / 32768;
  }

  std::vector<Vertex> spray(const Branch& on, std::uint32_t k, int level, const SprayForm& form,
                            double n, double m) const {
    static constexpr double kFill[4] = {5.3, 6.0, 4.4, 4.4};
    const FoliagePlan& f = p_.foliage;
    const std::uint32_t id = k * 0x9E3779B9U + (p_.key ^ (p_.salt + 0x40000000U));
    std::uint32_t h[4];
    for (std::uint32_t i = 0; i < 4; ++i)
      h[i] = mix(id ^ (i * 0x85EBCA6BU));
    const double t = d(f.from) + (1 - d(f.from)) * high(h[1]);
    const glm::dvec3 room = glm::dvec3(p_.bounds.half_extent());
    const double mean = std::min(
        std::min(kFill[level] * crown_radius_ * d(f.fill) / std::sqrt(n), 2 * d(p_.size_m)),
        0.6 * std::min(std::min(room.x, room.y), room.z));
    const double length = mean * (0.75 + 0.5 * high(h[3]));
    const double pull = level == 0 ? 1 : std::max(1 - 0.28 * mean / crown_radius_, 0.5);
    const double cluster = d(f.cluster) * crown_radius_ * std::min(2.1 / std::sqrt(m), 0.6);
    const glm::dvec3 o{whole(h[0]), whole(h[0] >> 16), whole(h[1])};
    const glm::dvec3 random{whole(h[2]), whole(h[2] >> 16), whole(h[3])};
    glm::dvec3 place = pull * (on.at(t) - center_ + cluster * (1 - 0.2 * glm::dot(o, o)) * o);
    const glm::dvec3 out = crown_radius_ * place / (half_ * half_);
    const glm::dvec3 along = glm::normalize(on.direction + 2 * t * on.bend);
    const glm::dvec3 axis = glm::normalize(d(f.random) * o + d(f.out) * out + d(f.branch) * along +
                                           glm::dvec3{0, d(f.up), 0});
    const glm::dvec3 side = glm::normalize(glm::cross(
        d(f.side_out) * out + d(f.side_random) * random + glm::dvec3{0, d(f.side_up), 0}, axis));
    const glm::dvec3 face = glm::cross(axis, side);
    const glm::dvec3 normal = glm::normalize(out + 0.3 * axis + glm::dvec3{0, d(f.normal_up), 0});
    const glm::dvec3 limit = room - 1.3 * length;
    place = glm::clamp(place + center_ - glm::dvec3(p_.bounds.center()), -limit, limit) +
            glm::dvec3(p_.bounds.center());
    std::vector<Vertex> result;
    for (std::uint32_t c = 0; c < form.vertices; ++c)
      result.push_back({place + length * ((d(form.along[c]) - 0.45) * axis +
                                          d(form.across[c]) * side - d(form.droop[c]) * face),
                        normal});
    return result;
  }

  void hull(int level) {
    std::vector<glm::dvec3> ends;
    for (const Branch& b : bearers(grow(16)))
      ends.push_back(b.at(1));
    double top = -1e9, bottom = 1e9;
    for (const glm::dvec3& e : ends)
      top = std::max(top, e.y), bottom = std::min(bottom, e.y);
    const double leaves = 0.2 * half_.x;
    const double middle = (top + bottom) / 2, half = (top - bottom) / 2 + leaves;
    const auto radius = [&](bool upper) {
      double sum = 0, weights = 0;
      for (const glm::dvec3& e : ends) {
        const double up = 0.5 + 0.5 * (e.y - middle) / half, w = std::pow(upper ? up : 1 - up, 4);
        sum += w * (std::pow(e.x - center_.x, 2) + std::pow(e.z - center_.z, 2));
        weights += w;
      }
      return leaves + 1.25 * std::sqrt(sum / weights);
    };
    const double upper = radius(true), lower = radius(false);
    auto add = [&, k = 0U](const glm::dvec3& place, const glm::dvec3& corner) mutable {
      const double grown = d(p_.foliage.hull) * (0.85 + 0.3 * low(number(p_.key, 16 + k++)));
      vertices_.push_back({glm::dvec3(center_.x, middle, center_.z) + grown * place,
                           glm::normalize(corner + glm::dvec3{0, 0.2, 0})});
    };
    const double y = 1 / std::sqrt(5.0), r = 2 * y, narrow = (upper - lower) / (upper + lower);
    add({0, half, 0}, {0, 1, 0});
    for (int k = 0; k < 10 && level == 4; ++k) {
      const double angle = 2 * std::numbers::pi * (k < 5 ? k : k - 4.5) / 5;
      const glm::dvec3 o{std::cos(angle), 0, std::sin(angle)};
      const double up = k < 5 ? y : -y;
      const double shift = 0.6 * (k < 5 ? std::max(narrow, 0.0) : std::min(narrow, 0.0));
      add((k < 5 ? upper : lower) * o + glm::dvec3{0, half * (up + shift), 0},
          r * o + glm::dvec3{0, up, 0});
    }
    for (int k = 0; k < 4 && level == 5; ++k) {
      const double angle = 2 * std::numbers::pi * k / 4;
      const glm::dvec3 o{std::cos(angle), 0, std::sin(angle)};
      const double up = half * std::clamp(1.2 * narrow, -0.9, 0.9);
      add(1.1 * std::max(upper, lower) * o + glm::dvec3{0, up, 0}, o);
    }
    add({0, -half, 0}, {0, -1, 0});
  }

  const TreePlan& p_;
  int depth_ = -1;
  glm::dvec3 center_{0}, half_{1};
  double crown_radius_ = 1;
  std::vector<Vertex> vertices_;
};

}  // namespace psygen::models::test
