#include "engine/handmade/levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/core/cancellation.hpp"
#include "engine/core/hash.hpp"
#include "engine/handmade/appearance.hpp"
#include "engine/handmade/simplifier.hpp"
#include "engine/models/kit/packing.hpp"

namespace psygen::handmade {
namespace {

constexpr std::size_t kMaxLevelVertices = 65'536;
constexpr std::size_t kMinTriangles = 12;
constexpr std::size_t kManyPieces = 32, kMinSolid = 8;
constexpr std::size_t kStep = 4;      // ratio of the triangles of two successive levels
constexpr float kMaxError = 0.5F;     // relative to the extent
constexpr float kNearlyThere = 1.3F;  // accepted ratio of triangles to the target
constexpr float kMinGain = 0.8F;      // a level with a larger ratio to the previous one is dropped

constexpr std::size_t kManyTriangles = 256;  // of a vertex
constexpr unsigned kCacheSize = 16;          // vertices
constexpr float kMaxReach = 0.5F;            // extent of a piece relative to the extent of all

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

// Simplifies loose leaves, which offer nothing to merge: each piece becomes a flat kite, and in
// coarser levels fewer and larger kites keep the total area (Cook, Halstead, Planck and Ryu,
// "Stochastic Simplification of Aggregate Detail", SIGGRAPH 2007). Coarser levels show a subset of
// the pieces of finer ones.
class Foliage {
 public:
  // From triangles of leaves; triangles that share positions form one piece. O(n log n).
  Foliage(const std::vector<Vertex>& vertices, const Indices& indices);

  std::size_t piece_count() const { return pieces_.size(); }
  // Appends kites with about `triangles` triangles to a mesh. Returns their maximum distance from
  // the leaves, in metres.
  double add(std::size_t triangles, std::vector<Vertex>& vertices, Indices& indices) const;

 private:
  struct Piece {
    glm::vec3 middle{0.0F}, along{0.0F}, across{0.0F};  // along, across: half its diagonals
    glm::vec3 normal{0.0F};
    std::array<std::uint8_t, 3> colour{};
    float area_m2 = 0;
  };
  static Piece piece_of(const std::vector<Vertex>& vertices, const Indices& indices);

  std::vector<Piece> pieces_;  // the first pieces are left out last
  float reach_m_ = 0;          // of all pieces from their centre
  double area_m2_ = 0;
};

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

// The values that distinguish vertices. Without padding, because its bytes are compared.
struct Key {
  glm::vec3 position;
  std::array<std::int16_t, 2> normal;
  std::array<std::uint8_t, 4> colour;
};
static_assert(sizeof(Key) == 20);

struct Mesh {
  std::vector<Vertex> vertices;
  Indices indices;
};

// Triangles thinner than a millionth of their length cover no pixel, and their normals are
// meaningless.
Indices without_slivers(const std::vector<Vertex>& vertices, const Indices& indices) {
  constexpr float kSliver = 1e-6F;
  Indices kept;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::vec3 a = vertices[indices[i]].position, b = vertices[indices[i + 1]].position,
                    c = vertices[indices[i + 2]].position;
    const float longest =
        std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    if (glm::length(glm::cross(b - a, c - a)) > kSliver * longest)
      kept.insert(kept.end(), {indices[i], indices[i + 1], indices[i + 2]});
  }
  return kept;
}

// The triangles without further ones of the same three vertices in the same direction.
Indices without_copies(const Indices& indices) {
  std::vector<std::array<std::uint32_t, 3>> keys;
  keys.reserve(indices.size() / 3);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<std::uint32_t, 3> key{indices[i], indices[i + 1], indices[i + 2]};
    std::rotate(key.begin(), std::ranges::min_element(key), key.end());
    keys.push_back(key);
  }
  Indices numbers(keys.size()), kept;
  meshopt_generateVertexRemap(numbers.data(), nullptr, keys.size(), keys.data(), keys.size(),
                              sizeof(keys[0]));
  for (std::size_t t = 0, known = 0; t < keys.size(); ++t) {
    if (numbers[t] < known) continue;
    ++known;
    kept.insert(kept.end(), &indices[3 * t], &indices[3 * t] + 3);
  }
  return kept;
}

// The mesh without equal and unused vertices, equal triangles and slivers.
Mesh cleaned(const std::vector<Vertex>& vertices, const Indices& indices) {
  std::vector<Key> keys;
  keys.reserve(vertices.size());
  for (const Vertex& v : vertices) {
    const glm::vec2 n = models::encode_octahedral(v.normal);
    keys.push_back({v.position + 0.0F,  // −0 is 0
                    {models::pack_snorm16(n.x), models::pack_snorm16(n.y)},
                    {v.colour[0], v.colour[1], v.colour[2], v.leaf}});
  }
  Mesh mesh{{}, without_slivers(vertices, indices)};
  if (mesh.indices.empty()) return {};
  Indices remap(vertices.size());
  mesh.vertices.resize(meshopt_generateVertexRemap(remap.data(), mesh.indices.data(),
                                                   mesh.indices.size(), keys.data(), keys.size(),
                                                   sizeof(Key)));
  meshopt_remapVertexBuffer(mesh.vertices.data(), vertices.data(), vertices.size(), sizeof(Vertex),
                            remap.data());
  meshopt_remapIndexBuffer(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(),
                           remap.data());
  mesh.indices = without_copies(mesh.indices);
  return mesh;
}

std::uint32_t max_triangles_of_a_vertex(const Mesh& mesh) {
  std::vector<std::uint32_t> triangles(mesh.vertices.size());
  for (const std::uint32_t i : mesh.indices)
    ++triangles[i];
  return *std::ranges::max_element(triangles);
}

// The mesh as a level, in an order that suits the caches of GPUs.
Level packed(const Mesh& mesh, double error_m) {
  Level level;
  level.error_m = error_m;
  Indices indices(mesh.indices.size());
  // The better order takes time with the square of the triangles of a vertex.
  if (max_triangles_of_a_vertex(mesh) <= kManyTriangles)
    meshopt_optimizeVertexCache(indices.data(), mesh.indices.data(), indices.size(),
                                mesh.vertices.size());
  else
    meshopt_optimizeVertexCacheFifo(indices.data(), mesh.indices.data(), indices.size(),
                                    mesh.vertices.size(), kCacheSize);
  level.vertices.resize(mesh.vertices.size());
  level.vertices.resize(meshopt_optimizeVertexFetch(level.vertices.data(), indices.data(),
                                                    indices.size(), mesh.vertices.data(),
                                                    mesh.vertices.size(), sizeof(Vertex)));
  level.indices.assign(indices.begin(), indices.end());
  return level;
}

// A coarser mesh and its distance from the finest.
struct Coarse {
  Mesh mesh;
  double error_m = 0;
};

// Simplifies connected parts.
class Solid {
 public:
  explicit Solid(const Mesh& finest)
      : finest_(finest),
        appearance_(finest_.vertices, finest_.indices),
        simplifier_(finest_.vertices, finest_.indices) {}

  std::size_t triangle_count() const { return finest_.indices.size() / 3; }
  // About as many triangles as requested, which must be no more than the last time.
  Coarse coarse(std::size_t triangles) {
    simplifier_.reduce_to(triangles);
    const std::size_t left = simplifier_.triangle_count();
    if (left == 0) return {};
    if (static_cast<float>(left) > kNearlyThere * static_cast<float>(triangles))
      return clustered(triangles);
    Coarse coarse{{finest_.vertices, simplifier_.indices()}, 0};
    coarse.error_m = appearance_.fit(coarse.mesh.vertices, simplifier_);
    return coarse;
  }

 private:
  // The outline of loose parts, which have no edges to collapse. Each corner gets the normal that
  // fits its triangle best.
  Coarse clustered(std::size_t triangles) const {
    const float* const places = &finest_.vertices.front().position.x;
    const std::size_t count = finest_.vertices.size(), all = finest_.indices.size();
    Indices indices(all);
    float error = 0;
    indices.resize(meshopt_simplifySloppy(indices.data(), finest_.indices.data(), all, places,
                                          count, sizeof(Vertex), std::min(3 * triangles, all),
                                          kMaxError, &error));
    float side_m = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const auto at = [&](std::size_t k) { return finest_.vertices[indices[i + k]].position; };
      const glm::vec3 ab = at(1) - at(0), ac = at(2) - at(0), across = glm::cross(ab, ac);
      side_m = std::max({side_m, glm::length(ab), glm::length(ac), glm::length(ac - ab)});
      for (std::size_t k = 0; k < 3; ++k)
        indices[i + k] = simplifier_.fitting(indices[i + k], across);
    }
    error *= meshopt_simplifyScale(places, count, sizeof(Vertex));
    // A cluster has one colour, whatever its parts have.
    return {{finest_.vertices, std::move(indices)}, static_cast<double>(std::max(error, side_m))};
  }

  Mesh finest_;
  Appearance appearance_;
  Simplifier simplifier_;
};

// The input of coarser levels: loose leaves are kept apart if there are many.
class Parts {
 public:
  explicit Parts(const Mesh& finest)
      : leaves_(indices_of(finest, true)), foliage_(finest.vertices, leaves_) {
    is_loose_ = foliage_.piece_count() >= kManyPieces;
    if (!is_loose_) {
      solid_.emplace(finest);
      return;
    }
    const Indices rest = indices_of(finest, false);
    if (!rest.empty()) solid_.emplace(cleaned(finest.vertices, rest));
  }

  // About as many triangles as wanted, which must be no more than the last time.
  Coarse coarse(std::size_t wanted) {
    if (!is_loose_) return solid_->coarse(wanted);
    Coarse made;
    std::size_t solid = 0;
    if (solid_) {
      const std::size_t triangles = solid_->triangle_count(), leaves = leaves_.size() / 3;
      solid = std::min(triangles, std::max(wanted * triangles / (triangles + leaves), kMinSolid));
      made = solid_->coarse(solid);
    }
    const double error_m =
        foliage_.add(wanted - std::min(wanted, solid), made.mesh.vertices, made.mesh.indices);
    made.error_m = std::max(made.error_m, error_m);
    return made;
  }

 private:
  static Indices indices_of(const Mesh& mesh, bool leaves) {
    Indices indices;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      if ((mesh.vertices[mesh.indices[i]].leaf != 0) == leaves)
        indices.insert(indices.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    }
    return indices;
  }

  Indices leaves_;
  Foliage foliage_;
  bool is_loose_ = false;
  std::optional<Solid> solid_;  // what is not leaves, if there is any
};

}  // namespace

std::vector<Level> levels_of(const Triangles& triangles, int most) {
  Mesh finest = cleaned(triangles.vertices, triangles.indices);
  if (finest.indices.empty()) return {};
  Parts parts(finest);
  std::size_t wanted = finest.indices.size() / 3;
  while (finest.vertices.size() > kMaxLevelVertices) {
    wanted = std::min(wanted * 19 / 20, wanted * kMaxLevelVertices / finest.vertices.size());
    const Mesh fewer = parts.coarse(wanted).mesh;
    finest = cleaned(fewer.vertices, fewer.indices);
    if (finest.indices.empty() || core::is_cancelled()) return {};
  }
  wanted = finest.indices.size() / 3;
  std::vector<Level> levels{packed(finest, 0)};
  while (static_cast<int>(levels.size()) < most && wanted > kMinTriangles &&
         !core::is_cancelled()) {
    wanted = std::max(wanted / kStep, kMinTriangles);
    const auto [mesh, error_m] = parts.coarse(wanted);
    const float before = static_cast<float>(levels.back().indices.size());
    if (mesh.indices.empty() || static_cast<float>(mesh.indices.size()) > kMinGain * before) break;
    Mesh level = cleaned(mesh.vertices, mesh.indices);
    if (level.indices.empty() || level.vertices.size() > kMaxLevelVertices) break;
    levels.push_back(packed(level, std::max({error_m, 1.01 * levels.back().error_m, 1e-4})));
  }
  return levels;
}

}  // namespace psygen::handmade
