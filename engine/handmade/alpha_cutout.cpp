#include "engine/handmade/alpha_cutout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "engine/core/hash.hpp"
#include "engine/handmade/texture_colours.hpp"

namespace psygen::handmade {
namespace {

constexpr std::size_t kManyTriangles = 4000;  // of cards; models with more are cut less finely
constexpr int kMaxSide = 1 << kMaxCutDepth;
constexpr int kTaps = 5;         // samples along each side of a point's area
constexpr int kSteps = 12;       // bisections to find the border
constexpr float kNoise = 0.25F;  // makes holes in evenly thin surfaces
constexpr std::uint32_t kNone = ~0U;

// Points on a triangle with subdivided sides: i of `side` towards its second corner, j towards its
// third.
struct Point {
  int i = 0, j = 0;
  friend auto operator<=>(const Point&, const Point&) = default;
};
struct Lattice {
  float share = 0;  // drawn fraction of the triangle
  // The drawn fraction of the surroundings of each point.
  std::array<std::array<float, kMaxSide + 1>, kMaxSide + 1> drawn{};
  float at(Point p) const {
    return drawn[static_cast<std::size_t>(p.i)][static_cast<std::size_t>(p.j)];
  }
};

bool is_drawn(const image::Image& image, glm::vec2 uv, float opacity, float min_opacity) {
  return opacity * static_cast<float>(pixel_of(image, uv)[3]) / 255 >= min_opacity;
}

// The fraction of the way from a drawn point to a cut one at which the border lies.
float way_to_border(float from, float to, float border) {
  return std::clamp((from - border) / (from - to), 0.02F, 0.98F);
}

// The kept fraction of a triangle.
float part_in(float a, float b, float c, float border) {
  const bool in_a = a >= border, in_b = b >= border, in_c = c >= border;
  const int count = int{in_a} + int{in_b} + int{in_c};
  if (count == 0 || count == 3) return count == 0 ? 0.0F : 1.0F;
  // The corner that is alone on its side of the border.
  const bool alone = count == 1;
  if (in_b == alone && in_a != alone && in_c != alone) return part_in(b, c, a, border);
  if (in_c == alone && in_a != alone && in_b != alone) return part_in(c, a, b, border);
  if (alone) return way_to_border(a, b, border) * way_to_border(a, c, border);
  return 1 - (1 - way_to_border(b, a, border)) * (1 - way_to_border(c, a, border));
}

class Cutter {
 public:
  Cutter(const core::MeshData& mesh, const image::Image& image, float opacity, float min_opacity,
         int depth)
      : mesh_(mesh),
        image_(image),
        opacity_(opacity),
        min_opacity_(min_opacity),
        side_(1 << depth),
        copies_(mesh.positions.size(), kNone) {}

  core::MeshData cut() {
    for (std::size_t i = 0; i + 2 < mesh_.indices.size(); i += 3)
      lattices_.push_back(lattice_of(i));
    border_ = border();
    for (std::size_t i = 0; i + 2 < mesh_.indices.size(); i += 3) {
      first_ = i;
      lattice_ = &lattices_[i / 3];
      points_.clear();
      cut_part({0, 0}, side_);
    }
    return std::move(out_);
  }

 private:
  Lattice lattice_of(std::size_t first) const;
  float border() const;
  double area_of(std::size_t triangle) const;
  double drawn_area() const;
  double area_with(float border) const;
  void cut_part(Point at, int size);
  void cut_border(const std::array<Point, 3>& corners);
  std::uint32_t vertex_at(Point p);
  std::uint32_t vertex_between(Point drawn, Point left_out);
  std::uint32_t add_vertex(glm::vec3 weights);
  glm::vec3 weights_of(Point p) const {
    const float u = static_cast<float>(p.i) / static_cast<float>(side_);
    const float v = static_cast<float>(p.j) / static_cast<float>(side_);
    return {1 - u - v, u, v};
  }
  bool is_in(Point p) const { return lattice_->at(p) >= border_; }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.indices.insert(out_.indices.end(), {a, b, c});
  }

  const core::MeshData& mesh_;
  const image::Image& image_;
  const float opacity_, min_opacity_;
  const int side_;
  std::vector<Lattice> lattices_;
  float border_ = 0.5F;
  core::MeshData out_;
  std::vector<std::uint32_t> copies_;  // for each vertex of the mesh; kNone: not yet copied
  // State of the triangle that is being cut:
  std::size_t first_ = 0;
  const Lattice* lattice_ = nullptr;
  std::map<std::pair<Point, Point>, std::uint32_t>
      points_;  // between two points, or the same point twice
};

Lattice Cutter::lattice_of(std::size_t first) const {
  const glm::vec2 uv[3] = {mesh_.uvs[mesh_.indices[first]], mesh_.uvs[mesh_.indices[first + 1]],
                           mesh_.uvs[mesh_.indices[first + 2]]};
  // The texture may have other content outside of this area.
  const glm::vec2 low = glm::min(glm::min(uv[0], uv[1]), uv[2]);
  const glm::vec2 high = glm::max(glm::max(uv[0], uv[1]), uv[2]);
  const float step = 1 / static_cast<float>(side_);
  const glm::vec2 along = (uv[1] - uv[0]) * step, across = (uv[2] - uv[0]) * step;
  const glm::vec2 inset = (high - low) * 1e-3F;
  Lattice lattice;
  float share = 0, points = 0;
  for (int i = 0; i <= side_; ++i) {
    for (int j = 0; i + j <= side_; ++j) {
      const glm::vec2 middle =
          uv[0] + static_cast<float>(i) * along + static_cast<float>(j) * across;
      int drawn = 0;
      for (int k = 0; k < kTaps * kTaps; ++k) {
        const auto offset = [](int tap) { return (static_cast<float>(tap) + 0.5F) / kTaps - 0.5F; };
        const glm::vec2 at = middle + offset(k % kTaps) * along + offset(k / kTaps) * across;
        drawn +=
            is_drawn(image_, glm::clamp(at, low + inset, high - inset), opacity_, min_opacity_);
      }
      const float part = static_cast<float>(drawn) / (kTaps * kTaps);
      // Number of small triangles around the point.
      const int sides = int{i == 0} + int{j == 0} + int{i + j == side_};
      const auto weight = static_cast<float>(sides == 0 ? 6 : sides == 1 ? 3 : 1);
      share += weight * part;
      points += weight;
      const std::uint64_t random = core::mix64(first * 128 + static_cast<std::size_t>(i * 16 + j));
      const float noise = static_cast<float>(random >> 40) / static_cast<float>(1 << 24) - 0.5F;
      lattice.drawn[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          drawn == 0 || drawn == kTaps * kTaps ? part : part + kNoise * noise;
    }
  }
  lattice.share = share / points;
  return lattice;
}

// The drawn fraction from which on a point counts as drawn, chosen so that the area is right.
float Cutter::border() const {
  const double wanted = drawn_area();
  float low = 0, high = 1;
  for (int step = 0; step < kSteps; ++step) {
    const float middle = 0.5F * (low + high);
    (area_with(middle) > wanted ? low : high) = middle;
  }
  return 0.5F * (low + high);
}

double Cutter::area_of(std::size_t triangle) const {
  const auto corner = [&](std::size_t k) {
    return mesh_.positions[mesh_.indices[3 * triangle + k]];
  };
  return static_cast<double>(glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))));
}

// Twice the area of the drawn pixels.
double Cutter::drawn_area() const {
  double area = 0;
  for (std::size_t t = 0; t < lattices_.size(); ++t)
    area += area_of(t) * static_cast<double>(lattices_[t].share);
  return area;
}

// Twice the area that this border would keep.
double Cutter::area_with(float border) const {
  double area = 0;
  for (std::size_t t = 0; t < lattices_.size(); ++t) {
    float parts = 0;
    for (int i = 0; i < side_; ++i) {
      for (int j = 0; i + j < side_; ++j) {
        const auto at = [&](int u, int v) { return lattices_[t].at({i + u, j + v}); };
        parts += part_in(at(0, 0), at(1, 0), at(0, 1), border);
        if (i + j + 1 < side_) parts += part_in(at(1, 1), at(0, 1), at(1, 0), border);
      }
    }
    area += area_of(t) * static_cast<double>(parts / static_cast<float>(side_ * side_));
  }
  return area;
}

// Cuts the part with a corner at a point, which extends by `size` along both sides; below 0:
// backwards.
void Cutter::cut_part(Point at, int size) {
  const int reach = std::abs(size), way = size < 0 ? -1 : 1;
  bool all = true, any = false;
  for (int i = 0; i <= reach; ++i) {
    for (int j = 0; i + j <= reach; ++j) {
      const bool in = is_in({at.i + way * i, at.j + way * j});
      all = all && in;
      any = any || in;
    }
  }
  if (!any) return;
  const std::array<Point, 3> corners{at, {at.i + size, at.j}, {at.i, at.j + size}};
  if (all) return add_triangle(vertex_at(corners[0]), vertex_at(corners[1]), vertex_at(corners[2]));
  if (reach == 1) return cut_border(corners);
  const int half = size / 2;
  cut_part(at, half);
  cut_part({at.i + half, at.j}, half);
  cut_part({at.i, at.j + half}, half);
  cut_part({at.i + half, at.j + half}, -half);
}

void Cutter::cut_border(const std::array<Point, 3>& corners) {
  const auto in = [&](std::size_t k) { return is_in(corners[k % 3]); };
  const int count = int{in(0)} + int{in(1)} + int{in(2)};
  for (std::size_t k = 0; k < 3; ++k) {
    const Point a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
    if (count == 1 && in(k)) add_triangle(vertex_at(a), vertex_between(a, b), vertex_between(a, c));
    if (count == 2 && !in(k)) {
      const std::uint32_t to_b = vertex_between(b, a), to_c = vertex_between(c, a);
      add_triangle(to_b, vertex_at(b), vertex_at(c));
      add_triangle(to_b, vertex_at(c), to_c);
    }
  }
}

std::uint32_t Cutter::vertex_at(Point p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Point corner{k == 1 ? side_ : 0, k == 2 ? side_ : 0};
    if (p != corner) continue;
    std::uint32_t& copy = copies_[mesh_.indices[first_ + k]];
    if (copy == kNone) copy = add_vertex(weights_of(p));
    return copy;
  }
  const auto [known, is_new] = points_.try_emplace({p, p}, kNone);
  if (is_new) known->second = add_vertex(weights_of(p));
  return known->second;
}

std::uint32_t Cutter::vertex_between(Point drawn, Point left_out) {
  const auto [known, is_new] = points_.try_emplace({drawn, left_out}, kNone);
  if (is_new) {
    const float from = lattice_->at(drawn), to = lattice_->at(left_out);
    const float part = way_to_border(from, to, border_);
    known->second = add_vertex(glm::mix(weights_of(drawn), weights_of(left_out), part));
  }
  return known->second;
}

std::uint32_t Cutter::add_vertex(glm::vec3 weights) {
  const auto mixed = [&](const auto& values) {
    return weights.x * values[mesh_.indices[first_]] +
           weights.y * values[mesh_.indices[first_ + 1]] +
           weights.z * values[mesh_.indices[first_ + 2]];
  };
  out_.positions.push_back(mixed(mesh_.positions));
  out_.uvs.push_back(mixed(mesh_.uvs));
  if (!mesh_.normals.empty()) out_.normals.push_back(mixed(mesh_.normals));
  if (!mesh_.colours.empty()) out_.colours.push_back(mixed(mesh_.colours));
  return static_cast<std::uint32_t>(out_.positions.size() - 1);
}

}  // namespace

int cut_depth(std::size_t triangles) {
  int depth = kMaxCutDepth;
  for (std::size_t most = kManyTriangles; depth > 0 && triangles > most; most *= 4)
    --depth;
  return depth;
}

core::MeshData alpha_cutout(const core::MeshData& mesh, const image::Image& image, float opacity,
                            float min_opacity, int depth) {
  return Cutter(mesh, image, opacity, min_opacity, depth).cut();
}

}  // namespace psygen::handmade
