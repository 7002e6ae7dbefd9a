// The tree once more, as docs/models.md defines it: in double precision, by recursion over
// branches, with the library's sines and cosines. Gives the places and normals of a level's
// vertices in the order of the mesh. The tests hold the engine's meshes to it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/tree.hpp"

namespace psygen::models::test {

class TreeOracle {
 public:
  explicit TreeOracle(const Parameters& p) : p_(p) {
    double length = real(kTreeSizeM), sum = 0;
    for (int i = 0; i < iterations(); ++i) {
      length *= real(kTreeLengthDecay);
      sum += length;
    }
    envelope_ = {0.25 * size() + 0.4 * sum, 0.25 * size() + 0.4 * sum, size() + 0.4 * sum};
    count();
  }

  struct Vertex {
    glm::dvec3 place, normal;
  };
  struct Branch {
    std::uint64_t key = 0;
    int depth = 0, parent = -1;
    glm::dvec3 base{0}, direction{0}, bend{0};
    double length = 0, start = 0, end = 0;
    glm::dvec3 at(double t) const { return base + length * (t * direction + t * t * bend); }
  };

  int depth() const { return depth_; }
  std::size_t tips() const { return nodes_[static_cast<std::size_t>(depth_)]; }
  std::size_t nodes(int d) const { return nodes_[static_cast<std::size_t>(d)]; }

  // Branches of at most `paths` paths (0: all), ordered by depth, parent, number.
  std::vector<Branch> grow(std::uint64_t paths) const {
    std::vector<Branch> all{trunk()};
    std::vector<std::uint64_t> shares{paths};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Branch parent = all[i];
      if (parent.depth == depth_) break;
      const std::uint64_t k = children(parent.key);
      for (std::uint64_t j = 0; j < k; ++j) {
        const std::uint64_t rank = (j + (parent.key & 0xFFFF)) % k;
        const std::uint64_t share = shares[i] / k + (rank < shares[i] % k ? 1 : 0);
        if (paths != 0 && share == 0) continue;
        all.push_back(child(parent, j, k));
        all.back().parent = static_cast<int>(i);
        shares.push_back(share);
      }
    }
    return all;
  }

  std::vector<Vertex> mesh(int level) {
    vertices_.clear();
    find_crown();
    if (level >= 4) {
      cone({0, -2 * radius(), 0}, radius() * (1 + 0.3 * real(kTreeFlare)));
      hull(level);
      return vertices_;
    }
    const std::vector<Branch> all = grow(level < 2 ? 0 : level == 2 ? 64 : 18);
    for (const Branch& b : all)
      bark(b, level);
    if (level >= 2) cone(all[0].at(1), all[0].end);
    sprays(all, level);
    return vertices_;
  }

 private:
  double real(TreeParameter i) const { return p_.real(i); }
  int iterations() const { return static_cast<int>(p_.integer(kTreeIterations)); }
  double size() const { return real(kTreeSizeM); }
  double radius() const { return real(kTreeRadiusM); }

  static std::array<double, 4> fractions(std::uint64_t h) {
    std::array<double, 4> f;
    for (std::size_t i = 0; i < 4; ++i)
      f[i] = static_cast<double>((h >> (16 * i)) & 0xFFFF) / 65536;
    return f;
  }
  std::uint64_t children(std::uint64_t key) const {
    const auto drawn =
        p_.integer(kTreeBranches) - 2 +
        static_cast<std::int64_t>(std::floor(5.0 * static_cast<double>(key >> 48) / 65536));
    return static_cast<std::uint64_t>(std::max<std::int64_t>(1, drawn));
  }
  static std::uint64_t child_key(std::uint64_t key, std::uint64_t j) {
    return core::mix64(key + 0xD1B54A32D192ED03ull * (j + 1));
  }
  std::uint64_t trunk_key() const {
    return core::mix64(static_cast<std::uint64_t>(p_.integer(kTreeSeed)) ^ 0x5472656553656564ull);
  }

  void count() {
    std::vector<std::uint64_t> keys{trunk_key()};
    std::size_t total = 1;
    nodes_ = {1};
    for (int i = 0; i < iterations(); ++i) {
      std::vector<std::uint64_t> next;
      for (const std::uint64_t key : keys)
        for (std::uint64_t j = 0; j < children(key); ++j)
          next.push_back(child_key(key, j));
      if (total + next.size() > 3072) break;
      total += next.size();
      nodes_.push_back(next.size());
      keys = next;
      depth_ = i + 1;
    }
  }

  Branch trunk() const {
    Branch b;
    b.key = trunk_key();
    const std::uint64_t h = core::mix64(b.key ^ 0xA24BAED4963EE407ull);
    const auto u = fractions(h), w = fractions(core::mix64(h));
    b.direction = glm::normalize(glm::dvec3{0.16 * (u[0] - 0.5), 1, 0.16 * (u[1] - 0.5)});
    b.bend = 0.5 * real(kTreeCurvature) * glm::dvec3{w[0] - 0.5, 0, w[1] - 0.5};
    b.length = size() * (0.9 + 0.2 * u[2]);
    b.start = radius() * (0.85 + 0.3 * u[3]);
    b.end = depth_ == 0 ? 0 : 0.72 * b.start;
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

  Branch child(const Branch& p, std::uint64_t j, std::uint64_t k) const {
    Branch b;
    b.key = child_key(p.key, j);
    b.depth = p.depth + 1;
    const std::uint64_t h = core::mix64(b.key ^ 0xA24BAED4963EE407ull);
    const auto u = fractions(h), w = fractions(core::mix64(h));
    const bool leader = j == 0;
    const double a =
        leader ? 0 : (static_cast<double>(j) - 1 + 0.7 * u[0]) / (static_cast<double>(k) - 1);
    const double t = 1 - a * (p.depth == 0 ? 0.3 : 0.6);
    const double v = real(kTreeAngleVariation), tropism = real(kTreeTropism);
    const glm::dvec3 tangent = glm::normalize(p.direction + 2 * t * p.bend);
    b.base = p.at(t);
    b.direction = tangent + glm::dvec3{0, 0.5 * tropism, 0};
    if (!leader) {
      const double tilt = real(kTreeBranchAngle) * (1 + v * (2 * u[1] - 1)) * (0.75 + 0.4 * a);
      const double turns = static_cast<double>((p.key >> 24) & 0xFFFF) / 65536 +
                           0.381966011 * static_cast<double>(j) + 0.3 * v * (u[2] - 0.5);
      const double psi = 2 * std::numbers::pi * turns;
      const Axes f = frame(tangent);
      b.direction = std::cos(tilt) * tangent +
                    std::sin(tilt) * (std::cos(psi) * f.u + std::sin(psi) * f.v) +
                    glm::dvec3{0, tropism, 0};
    }
    b.direction = glm::normalize(b.direction);
    b.bend = 0.5 * real(kTreeCurvature) * glm::dvec3{w[0] - 0.5, w[1] - 0.5, w[2] - 0.5} +
             glm::dvec3{0, 0.35 * tropism, 0};
    const double full = p.length * real(kTreeLengthDecay) * (0.85 + 0.3 * u[3]) *
                        (leader ? 1 : 0.85 + 0.4 * (1 - t));
    const glm::dvec3 q = (b.base + full * (b.direction + b.bend) - glm::dvec3{0, envelope_.z, 0}) /
                         glm::dvec3{envelope_.x, envelope_.y, envelope_.x};
    b.length = full / std::max(1.0, glm::dot(q, q));
    b.start = (p.start + t * (p.end - p.start)) * (leader ? 1 : real(kTreeRadiusDecay));
    b.end = b.depth == depth_ ? 0 : 0.72 * b.start;
    return b;
  }

  void find_crown() {
    std::vector<glm::dvec3> ends;
    for (const Branch& b : grow(18))
      if (b.depth == depth_) ends.push_back(b.at(1));
    const double n = static_cast<double>(ends.size());
    center_ = glm::dvec3(0);
    for (const glm::dvec3& e : ends)
      center_ += e / n;
    double across = 0, up = 0;
    for (const glm::dvec3& e : ends) {
      const glm::dvec3 d = e - center_;
      across += (d.x * d.x + d.z * d.z) / (2 * n);
      up += d.y * d.y / n;
    }
    half_ = glm::dvec3(0.3 * size()) +
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

  void bark(const Branch& b, int level) {
    static constexpr int kSides[4][4] = {{8, 5, 4, 3}, {6, 4, 3, 0}, {4, 3, 0, 0}, {3, 0, 0, 0}};
    static constexpr int kSegments[4][4] = {{6, 3, 2, 1}, {3, 2, 1, 0}, {2, 1, 0, 0}, {1, 0, 0, 0}};
    const int sides = kSides[level][std::min(b.depth, 3)];
    const int segments = kSegments[level][std::min(b.depth, 3)];
    if (sides == 0) return;
    const std::vector<double> six{0, 0.06, 0.16, 0.34, 0.55, 0.78, 1}, three{0, 0.14, 0.5, 1},
        two{0, 0.2, 1};
    const Axes f = frame(b.direction);
    const std::uint64_t z = core::mix64(b.key ^ 0xE7037ED1A0B428DBull);
    for (int ring = 0; ring <= segments; ++ring) {
      const auto r = static_cast<std::size_t>(ring);
      double t = static_cast<double>(ring) / segments, flare = 0;
      if (b.depth == 0) {
        if (segments > 1) t = segments == 6 ? six[r] : segments == 3 ? three[r] : two[r];
        flare = real(kTreeFlare) * std::pow(std::max(1 - 3 * t, 0.0), 2) *
                (segments == 1   ? 0.3
                 : segments == 2 ? 0.6
                                 : 1.0);
      }
      glm::dvec3 middle = b.at(t);
      if (b.depth == 0 && ring == 0) middle.y -= 2 * radius();
      const int corners = b.depth == depth_ && ring == segments ? 1 : sides;
      for (int x = 0; x < corners; ++x) {
        const glm::dvec3 o = corner(x, sides, f.u, f.v);
        const double lobe = 0.4 + 0.16 * static_cast<double>((z >> (3 * x % 61)) & 7);
        const double distance = (b.start + t * (b.end - b.start)) * (1 + flare * lobe);
        vertices_.push_back({middle + distance * (o - glm::dot(o, 2 * t * b.bend) * b.direction),
                             corners == 1 ? b.direction : o});
      }
    }
  }

  void sprays(const std::vector<Branch>& all, int level) {
    std::vector<Branch> ends;
    for (const Branch& b : all)
      if (b.depth == depth_) ends.push_back(b);
    const std::size_t m = ends.size();
    const std::size_t n = level == 0   ? std::clamp<std::size_t>(16 * m / 5, 512, 7168)
                          : level == 1 ? std::clamp<std::size_t>(m, 128, 1536)
                          : level == 2 ? 64
                                       : 18;
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t q = n * i / m; q < n * (i + 1) / m; ++q)
        spray(all, ends[i], q - n * i / m, level, static_cast<double>(n), static_cast<double>(m));
  }

  void spray(const std::vector<Branch>& all, const Branch& tip, std::size_t number, int level,
             double n, double m) {
    static constexpr double kLeaf[6][3] = {{0, 0, 0},    {0.52, -0.6, 0.14}, {0.4, -0.2, 0},
                                           {1, 0, 0.18}, {0.4, 0.2, 0},      {0.52, 0.6, 0.14}};
    static constexpr double kPatch[6][3] = {{0, 0, 0.12},    {0.22, -0.46, 0.06}, {0.74, -0.4, 0},
                                            {1, 0.06, 0.16}, {0.66, 0.44, 0},     {0.3, 0.4, 0.06}};
    static constexpr double kFill[4] = {6.7, 7.1, 4.4, 4.4};
    const std::uint64_t h = core::mix64(tip.key + 0x8EBC6AF09C88C6E3ull * (number + 1));
    const auto x = fractions(h), y = fractions(core::mix64(h));
    const double g = static_cast<double>((h >> 40) & 0xFFFF) / 65536;
    const Branch& bearer = all[static_cast<std::size_t>(tip.parent)];
    const glm::dvec3 anchor = g < 0.3 ? bearer.at(0.4 + 2 * g) : tip.at(g);
    const double mean =
        std::min(kFill[level] * crown_radius_ * real(kTreeLeafScale) / std::sqrt(n), 2 * size());
    const double length = mean * (0.75 + 0.5 * y[3]);
    const double cluster = crown_radius_ * std::min(2.1 / std::sqrt(m), 0.6);
    const double pull = level == 0 ? 1 : std::max(1 - 0.28 * mean / crown_radius_, 0.5);
    const glm::dvec3 o{2 * x[0] - 1, 2 * x[1] - 1, 2 * x[2] - 1};
    const glm::dvec3 random{2 * y[0] - 1, 2 * y[1] - 1, 2 * y[2] - 1};
    const glm::dvec3 place =
        center_ + pull * (anchor + cluster * (1 - 0.2 * glm::dot(o, o)) * o - center_);
    const glm::dvec3 out = glm::normalize((place - center_) / (half_ * half_));
    const glm::dvec3 axis = glm::normalize(0.7 * (o + out) - glm::dvec3{0, 0.25, 0});
    const glm::dvec3 side =
        glm::normalize(glm::cross(0.7 * out + 0.9 * random + glm::dvec3{0, 0.3, 0}, axis));
    const glm::dvec3 face = glm::cross(axis, side);
    const glm::dvec3 normal = glm::normalize(out + 0.3 * axis + glm::dvec3{0, 0.25, 0});
    for (int c = 0; c < 6; ++c) {
      const double* f = level <= 1 ? kLeaf[c] : kPatch[c];
      vertices_.push_back(
          {place + length * ((f[0] - 0.45) * axis + f[1] * side - f[2] * face), normal});
    }
  }

  void hull(int level) {
    std::vector<glm::dvec3> corners;
    if (level == 4) {
      const double a = 1 / std::sqrt(1 + std::numbers::phi * std::numbers::phi);
      const double b = a * std::numbers::phi;
      corners = {{-a, b, 0},  {a, b, 0},  {-a, -b, 0}, {a, -b, 0}, {0, -a, b},  {0, a, b},
                 {0, -a, -b}, {0, a, -b}, {b, 0, -a},  {b, 0, a},  {-b, 0, -a}, {-b, 0, a}};
    } else {
      for (int k = 0; k < 6; ++k) {
        const double turns = (k < 3 ? k : k - 3) / 3.0 + (k < 3 ? 0 : 1 / 6.0);
        const double angle = 2 * std::numbers::pi * turns;
        corners.emplace_back(0.85 * std::cos(angle), k < 3 ? 0.52 : -0.52, 0.85 * std::sin(angle));
      }
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const auto x = fractions(core::mix64(trunk_key() + 0x2F72B4215A3D8CAFull * (k + 1)));
      const double grown = (level == 4 ? 1.05 : 1.3) * (0.85 + 0.3 * x[0]);
      vertices_.push_back({center_ + grown * half_ * corners[k],
                           glm::normalize(corners[k] + glm::dvec3{0, 0.2, 0})});
    }
  }

  Parameters p_;
  glm::dvec3 envelope_{0};  // across, up, height of the centre
  int depth_ = 0;
  std::vector<std::size_t> nodes_;
  glm::dvec3 center_{0}, half_{1};
  double crown_radius_ = 1;
  std::vector<Vertex> vertices_;
};

}  // namespace psygen::models::test
