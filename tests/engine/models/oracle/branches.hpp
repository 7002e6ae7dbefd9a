// An independent skeleton of a tree, as docs/models.md defines it: in double precision, branch by
// branch, with the library's sines and cosines. Not its mesh (tree.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "engine/models/tree/plan.hpp"

namespace psygen::models::test {

class BranchOracle {
 public:
  explicit BranchOracle(const TreePlan& plan) : p_(plan) { depth_ = deepest(grow(0)); }

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

  // Grows the branches of at most `paths` paths (0: all), ordered by depth, kind, parent, rank.
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

 protected:
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
  // Returns the branches with leaves, or the tips if none has any.
  Branches bearers(const Branches& all) const {
    Branches found;
    for (const Branch& b : all)
      if (p_.foliage.near != nullptr && bears(b)) found.push_back(b);
    if (!found.empty()) return found;
    for (const Branch& b : all)
      if (is_tip(b)) found.push_back(b);
    return found;
  }

  const TreePlan& p_;

 private:
  int depth_ = -1;
};

}  // namespace psygen::models::test
