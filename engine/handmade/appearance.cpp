#include "engine/handmade/appearance.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <utility>

#include "engine/core/hash.hpp"

namespace psygen::handmade {
namespace {

constexpr std::size_t kPoints = 4096, kFewTriangles = 256;
// Wrong means of a region: of stored colours, and of unit normals, which change light less.
constexpr float kWrongColour = 0.05F, kWrongNormal = 0.25F;
constexpr float kFilled = 0.5F;     // part of a region's square that is surface
constexpr float kClearGain = 0.7F;  // of errors, for new colours
constexpr int kTurns = 8;           // of the fit of colours
constexpr float kGrowth = 1.5F;     // ratio of two sizes of regions

glm::vec3 colour_of(const Vertex& v) {
  return glm::vec3(v.colour[0], v.colour[1], v.colour[2]) / 255.0F;
}

std::vector<glm::vec3> colours_of(const std::vector<Vertex>& vertices) {
  std::vector<glm::vec3> colours;
  colours.reserve(vertices.size());
  for (const Vertex& v : vertices)
    colours.push_back(colour_of(v));
  return colours;
}

glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0 ? v / length : v;
}

// std::floor() of a number below 2^63.
std::int64_t floored(float number) {
  const auto whole = static_cast<std::int64_t>(number);
  return static_cast<float>(whole) > number ? whole - 1 : whole;
}

// The sides of thin parts are kept apart by their directions: 0 … 5.
std::uint64_t side_of(const glm::vec3& facing) {
  const glm::vec3 n = glm::abs(facing);
  const int axis = n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
  return static_cast<std::uint64_t>(2 * axis + (facing[axis] > 0 ? 1 : 0));
}

}  // namespace

void Appearance::Difference::add(const Difference& other) {
  colour += other.colour, normal += other.normal, area_m2 += other.area_m2;
}

bool Appearance::Difference::has_wrong_normal() const {
  return glm::length(normal) > kWrongNormal * area_m2;
}

bool Appearance::Difference::is_wrong() const {
  return glm::length(colour) > kWrongColour * area_m2 || has_wrong_normal();
}

Appearance::Appearance(const std::vector<Vertex>& vertices, const Indices& indices) {
  // Few triangles have several points each, and of many triangles some have one.
  constexpr std::array<glm::vec3, 4> kInside{
      {glm::vec3(1.0F / 3), {0.7F, 0.15F, 0.15F}, {0.15F, 0.7F, 0.15F}, {0.15F, 0.15F, 0.7F}}};
  const std::size_t triangles = indices.size() / 3;
  const std::size_t each = triangles <= kFewTriangles ? kInside.size() : 1;
  const std::size_t step = (each * triangles + kPoints - 1) / kPoints;
  glm::vec3 low(1e30F), high(-1e30F);
  float area_m2 = 0;
  for (std::size_t t = 0; t < triangles; t += step) {
    const std::array<const Vertex*, 3> v{&vertices[indices[3 * t]], &vertices[indices[3 * t + 1]],
                                         &vertices[indices[3 * t + 2]]};
    for (std::size_t k = 0; k < each; ++k) {
      Point p;
      p.triangle = static_cast<std::uint32_t>(t);
      p.goal.facing = glm::cross(v[1]->position - v[0]->position, v[2]->position - v[0]->position);
      p.side = side_of(p.goal.facing);
      for (int i = 0; i < 3; ++i) {
        const Vertex& corner = *v[static_cast<std::size_t>(i)];
        p.goal.position += kInside[k][i] * corner.position;
        p.normal += kInside[k][i] * corner.normal;
        p.colour += kInside[k][i] * colour_of(corner);
      }
      p.area_m2 =
          0.5F * glm::length(p.goal.facing) * static_cast<float>(step) / static_cast<float>(each);
      area_m2 += p.area_m2;
      darkest_ = glm::min(darkest_, p.colour), brightest_ = glm::max(brightest_, p.colour);
      low = glm::min(low, p.goal.position), high = glm::max(high, p.goal.position);
      points_.push_back(p);
    }
  }
  if (points_.empty()) return;
  extent_m_ = glm::length(high - low);
  spacing_m_ = std::sqrt(area_m2 / static_cast<float>(points_.size()));
}

// Times the area of a point, from the colours of the vertices of a level.
glm::vec3 Appearance::missing_colour(const std::vector<glm::vec3>& colours,
                                     const std::vector<Match>& matches, std::size_t point) const {
  const Match& match = matches[point];
  glm::vec3 colour(0.0F);
  for (int k = 0; k < 3; ++k)
    colour += match.weights[k] * colours[match.corners[static_cast<std::size_t>(k)]];
  return points_[point].area_m2 * (points_[point].colour - colour);
}

std::vector<Appearance::Difference> Appearance::differences(
    const std::vector<Vertex>& vertices, const std::vector<Match>& matches) const {
  const std::vector<glm::vec3> colours = colours_of(vertices);
  std::vector<Difference> found(points_.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!matches[i].is_found) continue;
    const Point& p = points_[i];
    glm::vec3 normal(0.0F);
    for (int k = 0; k < 3; ++k)
      normal +=
          matches[i].weights[k] * vertices[matches[i].corners[static_cast<std::size_t>(k)]].normal;
    found[i] = {missing_colour(colours, matches, i), p.area_m2 * (p.normal - unit_or_zero(normal)),
                p.area_m2};
  }
  return found;
}

double Appearance::fit(std::vector<Vertex>& vertices, Simplifier& simplifier) const {
  double error_m = simplifier.error_m();
  std::vector<Match> matches;
  matches.reserve(points_.size());
  for (const Point& p : points_) {
    const Simplifier::Match match = simplifier.nearest(p.triangle, p.goal);
    const std::uint32_t* const c = simplifier.corners(match.triangle);
    matches.push_back({{c[0], c[1], c[2]}, match.weights, match.is_found});
    if (match.is_found) error_m = std::max(error_m, static_cast<double>(match.distance_m));
  }
  const WrongSize wrong = wrong_size(differences(vertices, matches));
  float wrong_m = wrong.any_m;
  // Other colours leave the normals as they are.
  if (wrong.normals_m < kClearGain * wrong_m) {
    std::vector<Vertex> fitted = with_fitted_colours(vertices, matches);
    const float left_m = wrong_size(differences(fitted, matches)).any_m;
    if (left_m < kClearGain * wrong_m) wrong_m = left_m, vertices = std::move(fitted);
  }
  return std::max(error_m, static_cast<double>(wrong_m));
}

// Each turn adds to the colour of a vertex the mean of what is missing around it, which tends to
// the least squares.
std::vector<Vertex> Appearance::with_fitted_colours(const std::vector<Vertex>& vertices,
                                                    const std::vector<Match>& matches) const {
  std::vector<Vertex> fitted = vertices;
  std::vector<glm::vec3> colours = colours_of(fitted);
  for (int turn = 0; turn < kTurns; ++turn) {
    std::vector<glm::vec4> missing(vertices.size(), glm::vec4(0.0F));  // weighted; weight
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!matches[i].is_found) continue;
      const glm::vec4 here(missing_colour(colours, matches, i), points_[i].area_m2);
      for (int k = 0; k < 3; ++k)
        missing[matches[i].corners[static_cast<std::size_t>(k)]] += matches[i].weights[k] * here;
    }
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      if (!(missing[i].w > 0)) continue;
      const glm::vec3 colour = colours[i] + glm::vec3(missing[i]) / missing[i].w;
      for (int k = 0; k < 3; ++k)
        fitted[i].colour[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(
            255 * std::clamp(colour[k], darkest_[k], brightest_[k]) + 0.5F);
      colours[i] = colour_of(fitted[i]);
    }
  }
  return fitted;
}

// Sums of the differences in each region, in the order of the points. An open hash table, which
// takes a third of the time of std::unordered_map.
class Appearance::Regions {
 public:
  explicit Regions(std::size_t points) : slots_(std::bit_ceil(2 * points)) {
    sums_.reserve(points);
  }

  void clear() {
    std::ranges::fill(slots_, 0U);
    sums_.clear();
  }
  Difference& at(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = key & mask;
    while (slots_[slot] != 0 && sums_[slots_[slot] - 1].first != key)
      slot = (slot + 1) & mask;
    if (slots_[slot] == 0) {
      sums_.emplace_back(key, Difference{});
      slots_[slot] = static_cast<std::uint32_t>(sums_.size());
    }
    return sums_[slots_[slot] - 1].second;
  }
  bool have_any(float min_area_m2, bool (Difference::*is_wrong)() const) const {
    return std::ranges::any_of(sums_, [&](const auto& sum) {
      return sum.second.area_m2 > min_area_m2 && (sum.second.*is_wrong)();
    });
  }

 private:
  std::vector<std::uint32_t> slots_;  // 1 + index of a sum; 0: free
  std::vector<std::pair<std::uint64_t, Difference>> sums_;
};

Appearance::WrongSize Appearance::wrong_size(const std::vector<Difference>& differences) const {
  if (std::ranges::none_of(differences, &Difference::is_wrong)) return {};
  WrongSize wrong;
  bool are_normals_wrong = std::ranges::any_of(differences, &Difference::has_wrong_normal);
  constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15;  // odd, with irregular bits
  float size_m = spacing_m_;
  Regions regions(points_.size());
  for (; size_m < extent_m_; size_m *= kGrowth) {
    regions.clear();
    for (std::size_t i = 0; i < differences.size(); ++i) {
      std::uint64_t key = points_[i].side;
      for (int k = 0; k < 3; ++k)
        key = kFactor * key +
              static_cast<std::uint64_t>(floored(points_[i].goal.position[k] / size_m));
      regions.at(core::mix64(key)).add(differences[i]);
    }
    const float min_area_m2 = kFilled * size_m * size_m;
    if (are_normals_wrong && !regions.have_any(min_area_m2, &Difference::has_wrong_normal)) {
      are_normals_wrong = false;
      wrong.normals_m = size_m;
    }
    if (!regions.have_any(min_area_m2, &Difference::is_wrong)) break;
  }
  wrong.any_m = std::min(size_m, extent_m_);
  if (are_normals_wrong) wrong.normals_m = wrong.any_m;
  return wrong;
}

}  // namespace psygen::handmade
