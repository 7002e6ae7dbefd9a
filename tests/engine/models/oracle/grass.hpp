// An independent patch of grass, as docs/models.md defines it: in double precision, blade by blade.
// Returns the positions and looks of a level's vertices in the order of the mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/grass/grass.hpp"
#include "tests/engine/models/oracle/look.hpp"

namespace psygen::models::test {

class GrassOracle {
 public:
  explicit GrassOracle(const Parameters& p)
      : p_(p),
        k_(core::mix64(static_cast<std::uint64_t>(p.integer(kGrassSeed)))),
        slope_(p.real(kGrassSlopeX), p.real(kGrassSlopeZ)) {}

  struct Vertex {
    glm::dvec3 place;
    Look look;
  };

  std::vector<Vertex> mesh(int level) const {
    std::vector<Vertex> result;
    const int each = level < 2 ? 1 : level == 2 ? 3 : 9;
    const std::int64_t blades = p_.integer(kGrassBlades), flowers = p_.integer(kGrassFlowers);
    const std::int64_t some = (blades + each - 1) / each, few = (flowers + each - 1) / each;
    const double broad = 1.3 * static_cast<double>(blades) / static_cast<double>(some);
    for (std::int64_t j = 0; j < some; ++j) {
      const std::array<Vertex, 5> b = blade(static_cast<std::uint64_t>(j), level == 0 ? 1 : broad);
      result.insert(result.end(), b.begin(), b.begin() + 2);
      result.insert(result.end(), b.begin() + (level == 0 ? 2 : 4), b.end());
    }
    for (std::int64_t j = 0; j < few; ++j) {
      const std::uint64_t stem = (1U << 20) + static_cast<std::uint64_t>(j);
      const std::array<Vertex, 5> b = blade(stem, 1);
      if (level == 0) result.insert(result.end(), b.begin(), b.end());
      const double larger = static_cast<double>(flowers) / static_cast<double>(few);
      add_petals(b[4], direction(fraction(2 * stem + 1, 0)), level, std::sqrt(larger), result);
    }
    return result;
  }

 private:
  double real(GrassParameter i) const { return p_.real(i); }

  // Number i of an item, in [0, 1).
  double fraction(std::uint64_t item, unsigned i) const {
    const std::uint64_t h = core::mix64(k_ + 0x9E3779B97F4A7C15U * item);
    return static_cast<double>((h >> (16 * i)) & 0xFFFF) / 65536;
  }
  static glm::dvec2 direction(double t) {
    const double q = std::floor(4 * t), s = 4 * t - q;
    glm::dvec2 u = glm::dvec2{1 - s * s, 2 * s} / (1 + s * s);
    for (int turn = 0; turn < static_cast<int>(q); ++turn)
      u = {-u.y, u.x};
    return u;
  }

  // In radii of the patch.
  glm::dvec2 tuft(std::uint64_t j, std::uint64_t tufts) const {
    const auto signed_part = [](std::uint64_t word) {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(word)) / 2147483648.0;
    };
    const double x = signed_part(k_ + j * 0xC13FA9A9U);
    const double z = signed_part((k_ >> 32) + j * 0x91E10DA5U);
    const glm::dvec2 e{x * std::sqrt(1 - z * z / 2), z * std::sqrt(1 - x * x / 2)};
    const double sigma = std::min(1.2 / std::sqrt(static_cast<double>(tufts)), 0.5);
    const std::uint64_t item = (std::uint64_t{1} << 30) + j;
    return (1 - sigma) * e + sigma * fraction(item, 1) * direction(fraction(item, 0));
  }

  // Left and right of base and bend, then the tip.
  std::array<Vertex, 5> blade(std::uint64_t j, double broader) const {
    const bool stem = j >= 1U << 20;
    const auto a = [&](unsigned i) { return fraction(2 * j + 1, i); };
    const auto b = [&](unsigned i) { return fraction(2 * j + 2, i); };
    const auto tufts = static_cast<std::uint64_t>((p_.integer(kGrassBlades) + 7) / 8);
    const glm::dvec2 u = direction(a(0)), c = tuft(j % tufts, tufts);
    const double height = real(kGrassHeightM), radius = real(kGrassRadiusM);
    const double own = height * (1 - 0.45 * std::min(glm::dot(c, c), 1.0)) * (0.6 + 0.4 * a(1));
    const double h = stem ? 1.2 * own : own;
    const glm::dvec2 at = radius * c + 0.22 * height * a(2) * u;
    const glm::dvec2 lean = real(kGrassLean) * own * (stem ? 0.3 : 0.25 + 0.75 * a(3)) * u;
    const double ground = glm::dot(at, slope_);
    const double half = real(kGrassWidthM) * (stem ? 0.25 : 0.5 * (0.75 + 0.25 * b(0)));
    const glm::dvec2 side = broader * half * glm::dvec2{-u.y, u.x};
    const double sway = std::min(1.1 * h, 1.0);
    const glm::dvec3 colour = colour_of(b(1), b(2));

    const auto vertex = [&](const glm::dvec2& xz, double y, double bend, double shade,
                            double ambient, double wind) {
      const glm::dvec3 normal{bend * u.x - slope_.x, 1, bend * u.y - slope_.y};
      return Vertex{{xz.x, y, xz.y}, {normal, shade * colour, ambient, wind, 1}};
    };
    const double foot = ground - 0.15 * height - 0.06 * radius, bend = ground + 0.55 * h;
    const glm::dvec2 middle = at + lean / 4.0;
    return {vertex(at + side, foot, 0, 0.85, 0.55, 0), vertex(at - side, foot, 0, 0.85, 0.55, 0),
            vertex(middle + 0.9 * side, bend, 0.25, 1, 0.9, 0.3 * sway),
            vertex(middle - 0.9 * side, bend, 0.25, 1, 0.9, 0.3 * sway),
            vertex(at + lean, ground + h, 0.4, 1.05, 1, sway)};
  }
  glm::dvec3 colour_of(double b1, double b2) const {
    const double dry = std::clamp(real(kGrassDryness) + 0.3 * (b1 - 0.5), 0.0, 1.0);
    return std::sqrt(real(kGrassAlbedo)) * (0.86 + 0.28 * b2) *
           glm::mix(glm::dvec3(1.03, 1.25, 0.61), glm::dvec3(1.16, 1.06, 0.71), dry);
  }

  void add_petals(const Vertex& tip, const glm::dvec2& u, int level, double larger,
                  std::vector<Vertex>& result) const {
    static const std::array<glm::dvec3, 4> kPetals{
        {{0.90, 0.90, 0.86}, {0.90, 0.76, 0.16}, {0.72, 0.42, 0.62}, {0.38, 0.42, 0.78}}};
    const glm::dvec3 colour = kPetals[static_cast<std::size_t>(p_.integer(kGrassFlower))];
    const double half = 1.3 * real(kGrassWidthM) * (level == 0 ? 1 : larger);
    Vertex v = tip;
    v.look.colour = 0.85 * colour;
    if (level == 0) result.push_back(v);
    v.look.colour = colour;
    const glm::dvec2 across{-u.y, u.x};
    const std::vector<glm::dvec2> ends = level == 0
                                             ? std::vector<glm::dvec2>{u, across, -u, -across}
                                             : std::vector<glm::dvec2>{u, across, -u - across};
    for (const glm::dvec2& end : ends) {
      v.place = tip.place + half * glm::dvec3(end.x, 0.45, end.y);
      result.push_back(v);
    }
  }

  const Parameters& p_;
  std::uint64_t k_;
  glm::dvec2 slope_;
};

}  // namespace psygen::models::test
