#include "engine/handmade/foliage.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>

#include "engine/core/hash.hpp"

namespace psygen::handmade {
namespace {

using Indices = std::vector<std::uint32_t>;

constexpr float kMaxReach = 0.5F;  // extent of a piece relative to the extent of all

// Groups vertices into connected sets.
class Sets {
 public:
  explicit Sets(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0U);
  }
  std::uint32_t of(std::uint32_t i) {
    while (parents_[i] != i)
      i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  // The smaller number becomes the root, so sets keep the order of the file.
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a), b = of(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  Indices parents_;
};

std::map<std::uint32_t, Indices> pieces_of(const std::vector<Vertex>& vertices,
                                           const Indices& indices) {
  Sets sets(vertices.size());
  std::map<std::tuple<float, float, float>, std::uint32_t> places;
  for (const std::uint32_t i : indices) {
    const glm::vec3& p = vertices[i].position;
    sets.join(i, places.try_emplace({p.x, p.y, p.z}, i).first->second);
  }
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    sets.join(indices[i], indices[i + 1]);
    sets.join(indices[i], indices[i + 2]);
  }
  std::map<std::uint32_t, Indices> pieces;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    Indices& piece = pieces[sets.of(indices[i])];
    piece.insert(piece.end(), {indices[i], indices[i + 1], indices[i + 2]});
  }
  return pieces;
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& other) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : other;
}

}  // namespace

Foliage::Piece Foliage::piece_of(const std::vector<Vertex>& vertices, const Indices& indices) {
  Piece piece;
  glm::vec3 front{0.0F}, colour{0.0F};
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Vertex &a = vertices[indices[i]], &b = vertices[indices[i + 1]],
                 &c = vertices[indices[i + 2]];
    const glm::vec3 cross = glm::cross(b.position - a.position, c.position - a.position);
    const float area = 0.5F * glm::length(cross);
    front += cross;
    piece.area_m2 += area;
    piece.middle += area * (a.position + b.position + c.position) / 3.0F;
    piece.normal += area * (a.normal + b.normal + c.normal);
    for (const Vertex* v : {&a, &b, &c})
      colour += area / 3 * glm::vec3(v->colour[0], v->colour[1], v->colour[2]);
  }
  if (!(piece.area_m2 > 0)) return piece;
  piece.middle /= piece.area_m2;
  for (std::size_t k = 0; k < 3; ++k)
    piece.colour[k] = static_cast<std::uint8_t>(colour[static_cast<int>(k)] / piece.area_m2 + 0.5F);
  piece.normal = unit_or(piece.normal, {0, 1, 0});
  front = unit_or(front, piece.normal);
  for (const std::uint32_t i : indices) {
    const glm::vec3 out = vertices[i].position - piece.middle;
    const glm::vec3 flat = out - glm::dot(out, front) * front;
    if (glm::dot(flat, flat) > glm::dot(piece.along, piece.along)) piece.along = flat;
  }
  const float half = glm::length(piece.along);
  if (half > 0) piece.across = glm::cross(front, piece.along) * (piece.area_m2 / (2 * half * half));
  return piece;
}

Foliage::Foliage(const std::vector<Vertex>& vertices, const Indices& indices) {
  glm::vec3 low{1e30F}, high{-1e30F};
  std::vector<std::pair<std::uint64_t, Piece>> pieces;
  for (const auto& [first, own] : pieces_of(vertices, indices)) {
    const Piece piece = piece_of(vertices, own);
    if (!(piece.area_m2 > 0) || piece.across == glm::vec3(0.0F)) continue;
    pieces.emplace_back(core::mix64(pieces.size()), piece);
    area_m2_ += static_cast<double>(piece.area_m2);
    low = glm::min(low, piece.middle), high = glm::max(high, piece.middle);
  }
  std::ranges::sort(pieces, {}, [](const auto& piece) { return piece.first; });
  for (const auto& [order, piece] : pieces)
    pieces_.push_back(piece);
  if (!pieces_.empty()) reach_m_ = 0.5F * glm::length(high - low);
}

double Foliage::add(std::size_t triangles, std::vector<Vertex>& vertices, Indices& indices) const {
  const std::size_t count = std::clamp<std::size_t>(triangles / 2, 1, pieces_.size());
  double shown_m2 = 0;
  for (std::size_t i = 0; i < count; ++i)
    shown_m2 += static_cast<double>(pieces_[i].area_m2);
  const auto scale = static_cast<float>(std::sqrt(area_m2_ / shown_m2));
  double error_m = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Piece& piece = pieces_[i];
    const float half = glm::length(piece.along);
    const float grown = std::min(scale, std::max(1.0F, kMaxReach * reach_m_ / half));
    error_m += static_cast<double>(half * (1.5F * grown - 1)) / static_cast<double>(count);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const glm::vec3& corner : {-piece.along, -piece.across, piece.along, piece.across})
      vertices.push_back({piece.middle + grown * corner, piece.normal, piece.colour, 1});
    indices.insert(indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
  }
  return error_m;
}

}  // namespace psygen::handmade
