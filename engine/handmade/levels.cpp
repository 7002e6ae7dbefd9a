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
#include <tuple>
#include <utility>

#include "engine/core/hash.hpp"
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

enum class Keep : std::uint8_t { kAll, kColours, kPositions };

Key key_of(const Vertex& v, Keep keep) {
  Key key{v.position + 0.0F, {0, 0}, {0, 0, 0, v.leaf}};  // −0 is 0
  if (keep == Keep::kAll) {
    const glm::vec2 n = models::encode_octahedral(v.normal);
    key.normal = {models::pack_snorm16(n.x), models::pack_snorm16(n.y)};
  }
  for (std::size_t c = 0; c < 3 && keep != Keep::kPositions; ++c)
    key.colour[c] = keep == Keep::kAll ? v.colour[c] : static_cast<std::uint8_t>(v.colour[c] >> 4);
  return key;
}

struct Mesh {
  std::vector<Vertex> vertices;
  Indices indices;
};

// The mesh with equal vertices merged; the colour is their mean. `remap` gets the new indices of
// vertices, and ~0 for unused ones.
Mesh welded(const std::vector<Vertex>& vertices, const Indices& indices, Keep keep,
            std::vector<unsigned>& remap) {
  std::vector<Key> keys;
  keys.reserve(vertices.size());
  for (const Vertex& v : vertices)
    keys.push_back(key_of(v, keep));
  remap.resize(vertices.size());
  const std::size_t count = meshopt_generateVertexRemap(
      remap.data(), indices.data(), indices.size(), keys.data(), keys.size(), sizeof(Key));
  Mesh mesh;
  mesh.vertices.resize(count);
  std::vector<std::array<std::uint32_t, 4>> sums(count);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (remap[i] == ~0U) continue;  // no triangle uses it
    auto& sum = sums[remap[i]];
    if (sum[3]++ == 0) mesh.vertices[remap[i]] = vertices[i];
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += vertices[i].colour[c];
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      mesh.vertices[i].colour[c] =
          static_cast<std::uint8_t>((sums[i][c] + sums[i][3] / 2) / std::max(sums[i][3], 1U));
  for (const std::uint32_t i : indices)
    mesh.indices.push_back(remap[i]);
  return mesh;
}

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

// The input of simplification, and the normals that the finest mesh has at each of its vertices:
// normals[first[i] … first[i + 1] − 1].
struct Source {
  Mesh mesh;
  std::vector<std::uint32_t> first;
  std::vector<glm::vec3> normals;
};

Source source_of(const Mesh& finest, Keep keep) {
  std::vector<unsigned> remap;
  Source source{welded(finest.vertices, finest.indices, keep, remap), {}, {}};
  source.first.resize(source.mesh.vertices.size() + 1);
  for (const unsigned to : remap)
    ++source.first[to + 1];
  for (std::size_t i = 1; i < source.first.size(); ++i)
    source.first[i] += source.first[i - 1];
  source.normals.resize(remap.size());
  std::vector<std::uint32_t> next(source.first.begin(), source.first.end() - 1);
  for (std::size_t i = 0; i < remap.size(); ++i)
    source.normals[next[remap[i]]++] = finest.vertices[i].normal;
  return source;
}

// The mesh of some triangles of a source. Each corner gets the normal of the finest mesh there that
// fits its triangle best, so smooth parts stay smooth and edges stay hard.
Mesh with_normals(const Source& source, const Indices& indices) {
  constexpr std::uint32_t kMaxNormals = 64;  // normals compared per vertex
  Mesh out;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const std::uint32_t* triangle = &indices[k / 3 * 3];
    const auto at = [&](int i) { return source.mesh.vertices[triangle[i]].position; };
    const glm::vec3 across = glm::cross(at(1) - at(0), at(2) - at(0));
    Vertex v = source.mesh.vertices[indices[k]];
    const std::uint32_t first = source.first[indices[k]], end = source.first[indices[k] + 1];
    for (std::uint32_t n = first; n < std::min(end, first + kMaxNormals); ++n) {
      if (glm::dot(source.normals[n], across) > glm::dot(v.normal, across))
        v.normal = source.normals[n];
    }
    out.vertices.push_back(v);
    out.indices.push_back(static_cast<std::uint32_t>(k));
  }
  std::vector<unsigned> remap;
  return welded(out.vertices, out.indices, Keep::kAll, remap);
}

// Fewer triangles over some of the same vertices, and their distance from all triangles.
struct Simplified {
  Indices indices;
  double error_m = 0;
};

Simplified simplified(const Mesh& mesh, std::size_t triangles, bool sloppily) {
  const float* const places = &mesh.vertices.front().position.x;
  const std::size_t count = mesh.vertices.size(), stride = sizeof(Vertex);
  const std::size_t target = std::min(3 * triangles, mesh.indices.size());
  Simplified result{Indices(mesh.indices.size()), 0};
  float error = 0;
  const std::size_t left =
      sloppily
          ? meshopt_simplifySloppy(result.indices.data(), mesh.indices.data(), mesh.indices.size(),
                                   places, count, stride, target, kMaxError, &error)
          : meshopt_simplify(result.indices.data(), mesh.indices.data(), mesh.indices.size(),
                             places, count, stride, target, kMaxError, 0, &error);
  result.indices.resize(left);
  result.error_m = static_cast<double>(error * meshopt_simplifyScale(places, count, stride));
  return result;
}

// The sources of all levels: with vertices of different colour kept apart, and with them merged.
struct Sources {
  Source coloured, plain;
};

// A mesh with about as many triangles as requested, and its error.
std::pair<Mesh, double> coarser(const Sources& sources, std::size_t triangles) {
  const float most = kNearlyThere * static_cast<float>(3 * triangles);
  for (const bool sloppily : {false, true}) {
    for (const Source* source : {&sources.coloured, &sources.plain}) {
      if (sloppily && source == &sources.coloured) continue;
      const Simplified found = simplified(source->mesh, triangles, sloppily);
      if (found.indices.empty() || (!sloppily && static_cast<float>(found.indices.size()) > most))
        continue;
      return {with_normals(*source, found.indices), found.error_m};
    }
  }
  return {};
}

Level packed(Mesh mesh, double error_m) {
  meshopt_optimizeVertexCache(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(),
                              mesh.vertices.size());
  Level level;
  level.vertices.resize(mesh.vertices.size());
  level.vertices.resize(meshopt_optimizeVertexFetch(level.vertices.data(), mesh.indices.data(),
                                                    mesh.indices.size(), mesh.vertices.data(),
                                                    mesh.vertices.size(), sizeof(Vertex)));
  for (const std::uint32_t i : mesh.indices)
    level.indices.push_back(static_cast<std::uint16_t>(i));
  level.error_m = error_m;
  return level;
}

// The input of coarser levels: loose leaves are kept apart if there are many.
class Parts {
 public:
  explicit Parts(const Mesh& finest)
      : leaves_(indices_of(finest, true)), foliage_(finest.vertices, leaves_) {
    is_loose_ = foliage_.piece_count() >= kManyPieces;
    Mesh rest{finest.vertices, is_loose_ ? indices_of(finest, false) : finest.indices};
    if (rest.indices.empty()) return;
    triangles_ = rest.indices.size() / 3;
    std::vector<unsigned> remap;
    rest = welded(rest.vertices, rest.indices, Keep::kAll, remap);
    sources_ = {source_of(rest, Keep::kColours), source_of(rest, Keep::kPositions)};
  }

  // About as many triangles as wanted, and their distance from the finest ones.
  std::pair<Mesh, double> coarse(std::size_t wanted) const {
    if (!is_loose_) return coarser(sources_, wanted);
    const std::size_t leaves = leaves_.size() / 3;
    const std::size_t solid =
        std::min(triangles_, std::max(wanted * triangles_ / (triangles_ + leaves), kMinSolid));
    std::pair<Mesh, double> made;
    if (solid > 0) made = coarser(sources_, solid);
    const double error_m =
        foliage_.add(wanted - std::min(wanted, solid), made.first.vertices, made.first.indices);
    made.second = std::max(made.second, error_m);
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
  std::size_t triangles_ = 0;  // of the parts that are not leaves
  Sources sources_;
};

}  // namespace

std::vector<Level> levels_of(const Triangles& triangles, int most) {
  const Indices sound = without_slivers(triangles.vertices, triangles.indices);
  if (sound.empty()) return {};
  std::vector<unsigned> remap;
  Mesh finest = welded(triangles.vertices, sound, Keep::kAll, remap);
  const Parts parts(finest);
  std::vector<Level> levels;
  std::size_t wanted = finest.indices.size() / 3;
  while (finest.vertices.size() > kMaxLevelVertices) {
    wanted = std::min(wanted * 9 / 10, wanted * kMaxLevelVertices / finest.vertices.size());
    finest = parts.coarse(wanted).first;
    if (finest.indices.empty()) return {};
  }
  wanted = finest.indices.size() / 3;
  levels.push_back(packed(std::move(finest), 0));
  while (static_cast<int>(levels.size()) < most && wanted > kMinTriangles) {
    wanted = std::max(wanted / kStep, kMinTriangles);
    auto [mesh, error_m] = parts.coarse(wanted);
    const float before = static_cast<float>(levels.back().indices.size());
    if (mesh.indices.empty() || static_cast<float>(mesh.indices.size()) > kMinGain * before ||
        mesh.vertices.size() > kMaxLevelVertices)
      break;
    error_m = std::max(error_m, 1.01 * levels.back().error_m);
    levels.push_back(packed(std::move(mesh), std::max(error_m, 1e-4)));
  }
  return levels;
}

}  // namespace psygen::handmade
