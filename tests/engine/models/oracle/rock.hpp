// An independent rock, as docs/models.md defines it: in double precision, with a list of edges and
// a plain recursion over subdivisions; then the look of every vertex. The tests compare the
// engine's meshes with it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <utility>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/rock/rock.hpp"
#include "tests/engine/models/oracle/look.hpp"

namespace psygen::models::test {

struct RockOracle {
  std::uint64_t seed = 0;
  int subdivisions = 2;
  double radius = 1, amplitude = 0.2, decay = 0.5;
  int family = 1;  // 0 rounded, 1 faceted, 2 layered
  double albedo = 0.26, warmth = 0.25, moss = 0.3;

  std::vector<glm::dvec3> places = {};  // of the vertices, in metres above the base point
  std::vector<std::array<int, 3>> triangles = {};

  // Number `field` (0 … 3) of item `index`, in [−1, 1).
  double random(std::uint64_t index, int field) const {
    const std::uint64_t key = core::mix64(seed) >> (field < 2 ? 0 : 32);
    std::uint32_t h = static_cast<std::uint32_t>(key + 0x9E3779B9u * index);
    h = (h ^ (h >> 16)) * 0x7FEB352Du;
    h = (h ^ (h >> 15)) * 0x846CA68Bu;
    h ^= h >> 16;
    return static_cast<double>((h >> (16 * (field % 2))) & 0xFFFF) / 32768.0 - 1;
  }

  void build() {
    amplitude *= family == kRockFaceted ? 1 : 0.8;
    const double w = std::abs(random(0, 3)) + 0.1;
    const glm::dvec3 axis{random(0, 0), random(0, 1), random(0, 2)};
    const double length = std::sqrt(glm::dot(axis, axis) + w * w);
    const auto turned = [&](const glm::dvec3& v) {
      const glm::dvec3 q = axis / length;
      return v + 2.0 * (w / length) * glm::cross(q, v) + 2.0 * glm::cross(q, glm::cross(q, v));
    };
    const int signs[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    std::vector<double> radii;
    for (int v = 0; v < 4; ++v) {
      const auto item = static_cast<std::uint64_t>(2 + v);
      const glm::dvec3 corner =
          glm::dvec3(signs[v][0], signs[v][1], signs[v][2]) / std::sqrt(3.0) +
          0.15 * glm::dvec3(random(item, 0), random(item, 1), random(item, 2));
      radii.push_back(1 + amplitude * random(item, 3));
      places.push_back(glm::normalize(turned(corner)) * radii.back());
    }
    triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    std::vector<std::pair<int, int>> edges = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    for (int n = 1; n <= subdivisions; ++n)
      split(edges, radii, amplitude * std::pow(decay, n));
    stretch();
  }

 private:
  void split(std::vector<std::pair<int, int>>& edges, std::vector<double>& radii, double size) {
    std::map<std::pair<int, int>, int> middle;
    std::vector<std::pair<int, int>> finer;
    for (const auto& [a, b] : edges) {
      const int v = static_cast<int>(places.size());
      const double r = (radii[static_cast<std::size_t>(a)] + radii[static_cast<std::size_t>(b)]) /
                       2 * (1 + size * random(static_cast<std::uint64_t>(2 + v), 0));
      radii.push_back(r);
      places.push_back(r * glm::normalize(places[static_cast<std::size_t>(a)] +
                                          places[static_cast<std::size_t>(b)]));
      middle[std::minmax(a, b)] = v;
      finer.push_back({a, v});
      finer.push_back({v, b});
    }
    std::vector<std::array<int, 3>> parts;
    for (const auto& t : triangles) {
      const int m0 = middle[std::minmax(t[0], t[1])];
      const int m1 = middle[std::minmax(t[1], t[2])];
      const int m2 = middle[std::minmax(t[2], t[0])];
      parts.insert(parts.end(), {{t[0], m0, m2}, {t[1], m1, m0}, {t[2], m2, m1}, {m0, m1, m2}});
      finer.insert(finer.end(), {{m0, m2}, {m1, m0}, {m2, m1}});
    }
    edges = finer;
    triangles = parts;
  }

 public:
  // Returns the area-weighted sum of the normals of the triangles around each position.
  std::vector<glm::dvec3> normals() const {
    std::vector<glm::dvec3> sums(places.size(), glm::dvec3(0));
    for (const auto& t : triangles) {
      const glm::dvec3 a = places[static_cast<std::size_t>(t[0])];
      const glm::dvec3 face = glm::cross(places[static_cast<std::size_t>(t[1])] - a,
                                         places[static_cast<std::size_t>(t[2])] - a);
      for (const int v : t)
        sums[static_cast<std::size_t>(v)] += face;
    }
    return sums;
  }

  // Returns the corners of all triangles, one after the other.
  std::vector<Look> looks() const {
    const std::vector<glm::dvec3> shared = normals();
    std::vector<Look> result;
    for (const auto& t : triangles) {
      const glm::dvec3 a = places[static_cast<std::size_t>(t[0])];
      const glm::dvec3 face = glm::normalize(glm::cross(
          places[static_cast<std::size_t>(t[1])] - a, places[static_cast<std::size_t>(t[2])] - a));
      for (const int v : t) {
        const glm::dvec3 n = glm::normalize(shared[static_cast<std::size_t>(v)]);
        result.push_back(look(static_cast<std::size_t>(v), n));
        if (family == kRockFaceted) result.back().normal = 0.7 * face + 0.3 * n;
      }
    }
    return result;
  }

 private:
  Look look(std::size_t v, const glm::dvec3& n) const {
    const double u = n.y / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    const double g = (random(2 + v, 1) + random(2 + v, v < 4 ? 3 : 0)) / 2;
    const double rise = std::clamp(0.8 * places[v].y / scale().y + 0.16, 0.0, 1.0);
    const glm::dvec3 before = glm::normalize(places[v] / scale() - glm::dvec3(0, 0.45, 0));
    const double w = 0.22 * warmth, tint = family == kRockLayered ? 0.14 : 0;
    const double tone = (1 + 0.25 * g) * (0.86 + 0.14 * rise) * (1 + tint * band(before));
    const double cover = moss * (2 - moss) * std::clamp(4 * (u - 0.35) + 2 * g, 0.0, 1.0);
    const glm::dvec3 light = glm::dvec3(1 + w, 1, 1 - w) * albedo * (1 + 0.15 * random(1, 3));
    const glm::dvec3 stone =
        tone * glm::dvec3(std::sqrt(light.x), std::sqrt(light.y), std::sqrt(light.z));
    return {n, stone + cover * (glm::dvec3(0.26, 0.33, 0.17) - stone),
            (0.3 + 0.7 * rise) * (0.8 + 0.2 * u)};
  }

  // Offset of a layer in a direction, in [−1, 1].
  double band(const glm::dvec3& direction) const {
    const std::uint64_t item = std::uint64_t{1} << 31;
    const glm::dvec3 across{0.35 * random(item, 1), 1, 0.35 * random(item, 2)};
    const double t = glm::dot(direction, across) * (2.2 + 0.6 * random(item, 3)) + random(item, 0);
    return std::abs(2 * (t - std::floor(t)) - 1) * 2 - 1;
  }

  glm::dvec3 scale() const {
    return radius * glm::dvec3{1 + 0.2 * random(1, 0),
                               (0.75 + 0.15 * random(1, 1)) * (family == 2 ? 0.75 : 1),
                               1 + 0.2 * random(1, 2)};
  }

  void stretch() {
    const glm::dvec3 factors = scale();
    for (glm::dvec3& p : places)
      p = p * (family == 2 ? 1 + 0.13 * band(glm::normalize(p)) : 1.0) * factors +
          glm::dvec3(0, 0.45 * factors.y, 0);
  }
};

inline RockOracle rock_oracle(const Parameters& p, int level = 0) {
  const int subdivisions = static_cast<int>(p.integer(kRockSubdivisions)) - level;
  RockOracle oracle{.seed = static_cast<std::uint64_t>(p.integer(kRockSeed)),
                    .subdivisions = std::max(subdivisions, 0),
                    .radius = p.real(kRockRadiusM),
                    .amplitude = p.real(kRockAmplitude),
                    .decay = p.real(kRockDecay),
                    .family = static_cast<int>(p.integer(kRockFamily)),
                    .albedo = p.real(kRockAlbedo),
                    .warmth = p.real(kRockWarmth),
                    .moss = p.real(kRockMoss)};
  oracle.build();
  return oracle;
}

}  // namespace psygen::models::test
