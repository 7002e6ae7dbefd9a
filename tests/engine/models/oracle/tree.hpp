// An independent mesh of a tree, as docs/models.md defines it: in double precision, vertex by
// vertex, with the foliage of foliage.hpp. Returns the positions and looks of a level's vertices in
// the order of the mesh. The tests compare the engine's meshes with it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "tests/engine/models/oracle/foliage.hpp"

namespace psygen::models::test {

class TreeOracle : public FoliageOracle {
 public:
  using FoliageOracle::FoliageOracle;

  // Of a level, in order.
  std::vector<Vertex> mesh(int level) {
    vertices_.clear();
    looks_.clear();
    find_crown();
    const bool leafy = p_.foliage.near != nullptr;
    if (leafy && level >= 4) {
      cone({0, -2 * d(p_.radius_m), 0}, d(p_.radius_m) * (1 + 0.3 * d(p_.flare)), 0.6);
      const std::vector<Vertex> crown = hull(level);
      vertices_.insert(vertices_.end(), crown.begin(), crown.end());
      return vertices_;
    }
    static constexpr std::uint64_t kLeafy[4] = {0, 0, 64, 16}, kBare[6] = {0, 0, 64, 16, 5, 2};
    const Branches all = grow(leafy ? kLeafy[level] : kBare[level]);
    reached_ = all.back().depth;
    bark(all, level);
    const glm::dvec3 end = all[0].at(1);
    if (leafy && level >= 2) cone(end, all[0].start * d(p_.taper), ambient(end));
    if (leafy) sprays(all, level);
    return vertices_;
  }

 private:
  static glm::dvec3 corner(int side, int sides, const glm::dvec3& u, const glm::dvec3& v) {
    const double angle = 2 * std::numbers::pi * side / sides;
    return std::cos(angle) * u + std::sin(angle) * v;
  }

  void cone(const glm::dvec3& from, double r, double light) {
    const glm::dvec3 colour = stored(p_.bark);
    const std::uint32_t foot = look({{}, colour, light, 20.0 / 255});
    for (int side = 0; side < 3; ++side) {
      const glm::dvec3 o = corner(side, 3, {1, 0, 0}, {0, 0, 1});
      vertices_.push_back({from + r * o, o, false, foot});
    }
    const std::uint32_t tip = look({{}, colour, ambient(centre_), 100.0 / 255});
    vertices_.push_back({centre_, {0, 1, 0}, false, tip});
  }

  // ---- Bark ----

  // Place of lane i of 16 in a block.
  static std::size_t place_in_block(std::size_t i) { return i % 4 * 4 + i / 4; }

  // Appends tubes one after the other; those in whole blocks of 16 (unless `rings`) vertex by
  // vertex.
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
    for (int at = 0; at <= depth(); ++at) {
      const auto column = static_cast<std::size_t>(std::min(at, 3));
      int sides = kSides[level][column], segments = kSegments[level][column];
      if (p_.foliage.near == nullptr && (level > 1 || sides == 0)) sides = 3, segments = 1;
      if (sides == 0) continue;
      for (const bool tip : {false, true}) {
        std::vector<std::vector<Vertex>> tubes;
        for (const Branch& b : all)
          if (b.depth == at && is_tip(b) == tip) tubes.push_back(tube(b, sides, segments));
        put(tubes, tip || tubes.size() >= 16);
      }
    }
  }

  // Sway at the end of branches of a depth; the trunk's base does not sway.
  double sway_at(int at) const {
    return at < 0 ? 0 : (30 + std::floor(170.0 * at / std::max(reached_, 1))) / 255;
  }

  std::vector<Vertex> tube(const Branch& b, int sides, int segments) {
    const std::vector<double> six{0, 0.06, 0.16, 0.34, 0.55, 0.78, 1}, three{0, 0.14, 0.5, 1},
        two{0, 0.2, 1};
    std::vector<Vertex> result;
    const Axes f = frame(b.direction);
    const std::uint32_t z = number(b.key, 5);
    const auto noise = [z](int y) {
      return ((z + static_cast<std::uint32_t>(y) * 0x9E3779B9U) * 0x846CA68BU) >> 29;
    };
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
        const double distance =
            b.start * (1 - t * (1 - end)) * (1 + flare * (0.4 + 0.16 * noise(x + 1000)));
        result.push_back({middle + distance * (o - glm::dot(o, 2 * t * b.bend) * b.direction),
                          corners == 1 ? b.direction : o, true});
        if (with_looks_) result.back().look = bark_look(b, t, middle, noise(8 * ring + x));
      }
    }
    return result;
  }

  // Look of the vertices of a branch's ring with this middle; `noise` is 0 … 7.
  std::uint32_t bark_look(const Branch& b, double t, const glm::dvec3& middle,
                          std::uint32_t noise) {
    const double tone = 1 + d(p_.bark_contrast) * (2 * noise / 7.0 - 1);
    const double contact = std::min(1.0, 0.55 + 1.5 * std::max(middle.y, 0.0) / d(p_.size_m));
    const double sway = glm::mix(sway_at(b.depth - 1), sway_at(b.depth), t);
    return look({{}, tone * stored(p_.bark), ambient(middle) * contact, sway});
  }

  // ---- Leaves ----

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

  int reached_ = 0;  // depth of the deepest branch that the level's paths reach
  std::vector<Vertex> vertices_;
};

}  // namespace psygen::models::test
