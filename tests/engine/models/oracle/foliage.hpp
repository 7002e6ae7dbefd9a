// An independent foliage of a tree, as docs/models.md defines it: in double precision, the crown
// and its light, colours of leaves, single sprays and hulls, on the skeleton of branches.hpp. Bark
// and the order of vertices are in tree.hpp.
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

#include "tests/engine/models/oracle/branches.hpp"
#include "tests/engine/models/oracle/look.hpp"

namespace psygen::models::test {

class FoliageOracle : public BranchOracle {
 public:
  // Makes looks, or only positions and normals, which takes half the time.
  explicit FoliageOracle(const TreePlan& plan, bool with_looks = false)
      : BranchOracle(plan), with_looks_(with_looks) {}

  struct Vertex {
    glm::dvec3 place;
    glm::dvec3 normal;       // sum of directions, whose length says how far they cancel out
    bool bark = false;       // of a tube: the tree's bounds never clamp it
    std::uint32_t look = 0;  // index into looks()
  };
  // Looks of the vertices of the last mesh, without their normals.
  const std::vector<Look>& looks() const { return looks_; }

 protected:
  std::uint32_t look(const Look& look) {
    looks_.push_back(look);
    return static_cast<std::uint32_t>(looks_.size() - 1);
  }

  // ---- Crown ----

  void find_crown() {
    std::vector<glm::dvec3> ends;
    for (const Branch& b : bearers(grow(16)))
      ends.push_back(b.at(1));
    const double n = static_cast<double>(ends.size());
    centre_ = glm::dvec3(0);
    for (const glm::dvec3& e : ends)
      centre_ += e / n;
    double across = 0, up = 0;
    for (const glm::dvec3& e : ends) {
      const glm::dvec3 v = e - centre_;
      across += (v.x * v.x + v.z * v.z) / (2 * n);
      up += v.y * v.y / n;
    }
    half_ = glm::dvec3(0.3 * d(p_.size_m)) +
            1.5 * glm::dvec3{std::sqrt(across), std::sqrt(up), std::sqrt(across)};
    crown_radius_ = (2 * half_.x + half_.y) / 3;
  }

  // Visible fraction of the sky at a point in or about the crown.
  double ambient(const glm::dvec3& place) const {
    const glm::dvec3 q = (place - centre_) / half_;
    return (0.3 + 0.7 * std::min(glm::dot(q, q), 1.44) / 1.44) *
           std::clamp(0.8 + 0.2 * q.y, 0.6, 1.0);
  }

  // ---- Colours ----

  static glm::dvec3 stored(const std::array<float, 3>& c) { return {d(c[0]), d(c[1]), d(c[2])}; }
  // Colour of leaves of a hue.
  glm::dvec3 leaf(double hue) const {
    const double x = std::clamp(4 * (p_.cyclic ? hue - std::floor(hue) : hue), 0.0, 4.0);
    const auto before = static_cast<std::size_t>(std::min(x, 3.0));
    return glm::mix(stored(p_.ramp[before]), stored(p_.ramp[before + 1]),
                    x - static_cast<double>(before));
  }
  double own_hue() const {
    return d(p_.hue) + 0.12 * d(p_.colour_variation) * (low(number(p_.key, 6)) - 0.5);
  }
  double own_brightness() const {
    return 1 + 0.24 * d(p_.colour_variation) * (high(number(p_.key, 6)) - 0.5);
  }

  // ---- Sprays and hulls ----

  static double whole(std::uint32_t half) {  // 16 bits as a signed fraction
    return static_cast<double>(static_cast<std::int16_t>(half & 0xFFFF)) / 32768;
  }

  std::vector<Vertex> spray(const Branch& on, std::uint32_t k, int level, const SprayForm& form,
                            double n, double m) {
    static constexpr double kFill[4] = {5.3, 6.0, 4.4, 4.4};
    const FoliagePlan& f = p_.foliage;
    const std::uint32_t id = k * 0x9E3779B9U + (p_.key ^ (p_.salt + 0x40000000U));
    std::uint32_t h[5];
    for (std::uint32_t i = 0; i < 5; ++i)
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
    glm::dvec3 place = pull * (on.at(t) - centre_ + cluster * (1 - 0.2 * glm::dot(o, o)) * o);
    const glm::dvec3 out = crown_radius_ * place / (half_ * half_);
    const glm::dvec3 along = glm::normalize(on.direction + 2 * t * on.bend);
    const glm::dvec3 axis = glm::normalize(d(f.random) * o + d(f.out) * out + d(f.branch) * along +
                                           glm::dvec3{0, d(f.up), 0});
    const glm::dvec3 side = glm::normalize(glm::cross(
        d(f.side_out) * out + d(f.side_random) * random + glm::dvec3{0, d(f.side_up), 0}, axis));
    const glm::dvec3 face = glm::cross(axis, side);
    const glm::dvec3 normal = out + 0.3 * axis + glm::dvec3{0, d(f.normal_up), 0};
    std::array<std::uint32_t, 2> numbers{};  // indices of the looks of corner 0 and of the others
    if (with_looks_) numbers = spray_looks(centre_ + place, h[3], h[4]);
    const glm::dvec3 limit = room - 1.3 * length;
    place = glm::clamp(place + centre_ - glm::dvec3(p_.bounds.centre()), -limit, limit) +
            glm::dvec3(p_.bounds.centre());
    std::vector<Vertex> result;
    for (std::uint32_t c = 0; c < form.vertices; ++c)
      result.push_back(
          {place + length * ((d(form.corners.along[c]) - 0.45) * axis +
                             d(form.corners.across[c]) * side - d(form.corners.droop[c]) * face),
           normal, false, numbers[c == 0 ? 0 : 1]});
    return result;
  }
  std::array<std::uint32_t, 2> spray_looks(const glm::dvec3& place, std::uint32_t h3,
                                           std::uint32_t h4) {
    const double light = ambient(place);
    const glm::dvec3 colour = spray_colour(h3, h4);
    return {look({{}, colour, light, 205.0 / 255, 1, true}),
            look({{}, colour, light, 245.0 / 255, 1})};
  }
  glm::dvec3 spray_colour(std::uint32_t h3, std::uint32_t h4) const {
    const double variation = d(p_.colour_variation), hue = own_hue();
    const glm::dvec3 below = leaf(hue - 0.05), above = leaf(hue + 0.05);
    const double deviation = 0.16 * variation * (low(h4) - 0.5);
    const double brightness = own_brightness() * (1 + 0.4 * variation * (high(h3) - 0.5));
    return 1.05 * brightness * glm::mix(below, above, 0.5 + deviation / 0.1);
  }

  std::vector<Vertex> hull(int level) {
    std::vector<Vertex> result;
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
        sum += w * (std::pow(e.x - centre_.x, 2) + std::pow(e.z - centre_.z, 2));
        weights += w;
      }
      return leaves + 1.25 * std::sqrt(sum / weights);
    };
    const double upper = radius(true), lower = radius(false);
    auto add = [&, k = 0U](const glm::dvec3& place, const glm::dvec3& corner) mutable {
      const std::uint32_t h = number(p_.key, 16 + k++);
      const glm::dvec3 at = glm::dvec3(centre_.x, middle, centre_.z) +
                            d(p_.foliage.hull) * (0.85 + 0.3 * low(h)) * place;
      const double hue = own_hue() + 0.1 * d(p_.colour_variation) * (high(h) - 0.5);
      const Look seen{{},
                      0.9 * own_brightness() * leaf(hue),
                      (level == 4 ? 0.78 : 0.7) * ambient(at),
                      200.0 / 255,
                      1};
      result.push_back({at, glm::normalize(corner + glm::dvec3{0, 0.2, 0}), false,
                        with_looks_ ? look(seen) : 0});
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
    return result;
  }

  bool with_looks_;
  std::vector<Look> looks_;
  glm::dvec3 centre_{0}, half_{1};
  double crown_radius_ = 1;
};

}  // namespace psygen::models::test
