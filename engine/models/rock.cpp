#include "engine/models/rock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numeric>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/models/packing.hpp"
#include "engine/models/rock_topology.hpp"

namespace psygen::models {
namespace {

constexpr ParameterType kInteger = ParameterType::kInteger;
constexpr ParameterType kReal = ParameterType::kReal;

constexpr ParameterSpec kSchema[kRockParameterCount] = {
    {"seed", kInteger, "", 1, -0x1.0p63, 0x1.0p63, 0, 1000, "which of all rocks",
     ParameterSource::kPlaced},
    {"subdivisions", kInteger, "", 2, 0, kMaxSubdivisions, 0, 4,
     "how often every triangle is split into four"},
    {"radius_m", kReal, "m", 0.6, 0.01, 100, 0.1, 4, "mean radius"},
    {"amplitude", kReal, "1", 0.24, 0, 0.6, 0, 0.4,
     "roughness: displacement relative to the radius"},
    {"decay", kReal, "1", 0.55, 0, 1, 0.3, 0.9, "ratio of the displacements of two subdivisions"},
    {"albedo", kReal, "1", 0.26, 0.02, 0.9, 0.1, 0.5, "mean reflected share of light"},
    {"warmth", kReal, "1", 0.25, -1, 1, -0.5, 0.7, "blue-grey (-1) to red-brown (1)"},
    {"moss", kReal, "1", 0.3, 0, 1, 0, 1, "cover of moss on what faces up"},
};

constexpr float kLift = 0.45F;    // height of the centre over the ground, of the half-height
constexpr float kWidest = 1.2F;   // largest stretch along x and z
constexpr float kHighest = 0.9F;  // largest stretch along y
constexpr float kJitter = 0.15F;  // of the tetrahedron's corners; below 1 / (3·√3)
constexpr float kFacet = 0.7F;    // share of the triangle's own normal in its vertices' normals
constexpr std::size_t kMaxVertices = rock_vertices(kMaxSubdivisions);

// Numbers in [−1, 1) that belong to item `index` of the rock of this key.
struct Signed {
  float f[4];
  Signed(std::uint64_t key, std::uint64_t index) {
    const std::uint64_t h = core::mix64(key + 0x9E3779B97F4A7C15ull * (index + 1));
    for (int i = 0; i < 4; ++i)
      f[i] = static_cast<float>(static_cast<std::int32_t>((h >> (16 * i)) & 0xFFFFU)) *
                 (1.0F / 32768.0F) -
             1.0F;
  }
};

struct RockShape {
  std::uint64_t key;
  float amplitude, decay;
  glm::vec3 stretch;  // metres
  float lift;         // metres
  glm::vec3 colour;   // albedo

  explicit RockShape(const Parameters& p)
      : key(core::mix64(static_cast<std::uint64_t>(p.integer(kRockSeed)))),
        amplitude(static_cast<float>(p.real(kRockAmplitude))),
        decay(static_cast<float>(p.real(kRockDecay))) {
    const auto radius = static_cast<float>(p.real(kRockRadiusM));
    const Signed s(key, 1);
    stretch = {(1.0F + 0.2F * s.f[0]) * radius, (0.75F + 0.15F * s.f[1]) * radius,
               (1.0F + 0.2F * s.f[2]) * radius};
    lift = kLift * stretch.y;
    const float warmth = static_cast<float>(p.real(kRockWarmth)) * 0.22F;
    const float albedo = static_cast<float>(p.real(kRockAlbedo)) * (1.0F + 0.15F * s.f[3]);
    colour = glm::vec3(1.0F + warmth, 1.0F, 1.0F - warmth) * albedo;
  }
};

// The corners of the tetrahedron, turned and jittered, and all midpoints, in units of the radius.
// Midpoints move along the normal of the sphere that the rock grew from, so that every triangle
// keeps facing away from the centre.
void displace(const RockShape& shape, std::span<const RockTopology::Edge> parents, int subdivisions,
              std::span<glm::vec3> position) {
  std::array<float, kMaxVertices> radius;
  const Signed turn(shape.key, 0);
  const float w = std::abs(turn.f[3]) + 0.1F;
  const glm::vec3 axis{turn.f[0], turn.f[1], turn.f[2]};
  const float unit = 1.0F / std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z + w * w);
  const glm::vec3 q = axis * unit;
  constexpr float kCorner = 0.577350269F;
  constexpr std::array<glm::vec3, 4> kTetrahedron{glm::vec3{kCorner, kCorner, kCorner},
                                                  {kCorner, -kCorner, -kCorner},
                                                  {-kCorner, kCorner, -kCorner},
                                                  {-kCorner, -kCorner, kCorner}};
  for (std::size_t v = 0; v < 4; ++v) {
    const Signed s(shape.key, 2 + v);
    const glm::vec3 corner = kTetrahedron[v] + glm::vec3(s.f[0], s.f[1], s.f[2]) * kJitter;
    const glm::vec3 twice = glm::cross(q, corner) * 2.0F;
    const glm::vec3 turned = corner + twice * (w * unit) + glm::cross(q, twice);
    radius[v] = 1.0F + shape.amplitude * s.f[3];
    position[v] = turned * (radius[v] / std::sqrt(glm::dot(turned, turned)));
  }
  float amplitude = shape.amplitude;
  for (int n = 1; n <= subdivisions; ++n) {
    amplitude *= shape.decay;
    for (std::size_t v = rock_vertices(n - 1); v < rock_vertices(n); ++v) {
      const RockTopology::Edge edge = parents[v - 4];
      const glm::vec3 middle = (position[edge.a] + position[edge.b]) * 0.5F;
      radius[v] = (radius[edge.a] + radius[edge.b]) * 0.5F *
                  (1.0F + amplitude * Signed(shape.key, 2 + v).f[0]);
      position[v] = middle * (radius[v] / std::sqrt(glm::dot(middle, middle)));
    }
  }
}

// Colour and ambient light of a vertex at `height` metres over the ground. `up` is the y of its
// smooth normal.
void paint(const RockShape& shape, float moss, float height, float up, float grain,
           core::ModelVertex& out) {
  const float rise = std::clamp((height / shape.stretch.y + 0.2F) * 0.8F, 0.0F, 1.0F);
  out.ambient = pack_unorm8((0.3F + 0.7F * rise) * (0.8F + 0.2F * up));
  const float cover = moss * std::clamp((up - 0.35F) * 2.5F + grain * 0.8F, 0.0F, 1.0F);
  const glm::vec3 stone = shape.colour * ((1.0F + 0.22F * grain) * (0.75F + 0.25F * rise));
  const glm::vec3 colour = stone + (glm::vec3(0.07F, 0.11F, 0.03F) - stone) * cover;
  out.colour[0] = pack_albedo(colour.x);
  out.colour[1] = pack_albedo(colour.y);
  out.colour[2] = pack_albedo(colour.z);
  out.sway = 0;
  out.material = 0;
}

// Writes the triangles with facets: each corner takes place and colour of its vertex and a normal
// between the triangle's and the vertex's. `face` holds unit normals.
void write_facets(std::span<const std::uint16_t> corners, std::span<const glm::vec3> face,
                  std::span<const glm::vec3> normal, std::span<const core::ModelVertex> vertices,
                  std::byte* out) {
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    std::array<core::ModelVertex, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint16_t v = corners[i + k];
      triangle[k] = vertices[v];
      const glm::vec2 packed = encode_octahedral(normal[v] + (face[i / 3] - normal[v]) * kFacet);
      triangle[k].normal[0] = pack_snorm16(packed.x);
      triangle[k].normal[1] = pack_snorm16(packed.y);
    }
    std::memcpy(out + i * sizeof(core::ModelVertex), triangle.data(), sizeof triangle);
  }
}

int subdivisions_at(const Parameters& p, int level) {
  return std::max(static_cast<int>(p.integer(kRockSubdivisions)) - level, 0);
}

class RockType final : public ModelType {
 public:
  std::string_view name() const override { return "rock"; }
  std::string_view doc() const override {
    return "rock: midpoint displacement on a tetrahedron, 4*4^subdivisions triangles";
  }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return kMaxSubdivisions + 1; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const Parameters& p, int level) const override;
  core::Bounds bounds(const Parameters& p) const override;
  MeshSize mesh_size(const Parameters& p, int level) const override;
  double complexity(const Parameters& p, int level) const override;
  double log2_cost(const Parameters& p) const override {
    return 2 + 2 * static_cast<double>(p.integer(kRockSubdivisions));
  }
  core::Bounds synthesize(const Parameters& p, int level, const MeshView& out) const override;
  void write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const override;

 private:
  RockTopology topology_;
};

// How far the surface of a sphere of radius 1 lies from its tetrahedron of n subdivisions, and the
// displacements that are left out.
double RockType::level_error_m(const Parameters& p, int level) const {
  constexpr std::array<double, kMaxSubdivisions + 1> kSagitta{0.667, 0.423, 0.130, 0.036,
                                                              0.009, 0.002, 0.0006};
  const int full = subdivisions_at(p, 0), n = subdivisions_at(p, level);
  double amplitude = p.real(kRockAmplitude), left_out = 0;
  for (int k = 1; k <= full; ++k) {
    amplitude *= p.real(kRockDecay);
    if (k > n) left_out += 0.5 * amplitude;
  }
  return p.real(kRockRadiusM) * (left_out + kSagitta[static_cast<std::size_t>(n)] -
                                 kSagitta[static_cast<std::size_t>(full)]);
}

core::Bounds RockType::bounds(const Parameters& p) const {
  double reach = 1, amplitude = p.real(kRockAmplitude);
  for (int n = 0; n <= subdivisions_at(p, 0); ++n) {
    reach *= 1 + amplitude;
    amplitude *= p.real(kRockDecay);
  }
  const auto radius = static_cast<float>(p.real(kRockRadiusM));
  const float r = radius * static_cast<float>(reach) * 1.0001F;
  return {{-kWidest * r, kHighest * (kLift * radius - r), -kWidest * r},
          {kWidest * r, kHighest * (kLift * radius + r), kWidest * r}};
}

MeshSize RockType::mesh_size(const Parameters& p, int level) const {
  const int n = subdivisions_at(p, level);
  const std::uint32_t corners = rock_triangles(n) * 3;
  return {corners, corners, (2U << 24) | static_cast<std::uint32_t>(n + 1),
          core::VertexLayout::kModel};
}

double RockType::complexity(const Parameters& p, int level) const {
  const int n = subdivisions_at(p, level);
  return n == 0 ? 0.25 : std::ldexp(n, 2 * (n - 1));
}

void RockType::write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const {
  const std::uint32_t n = (id & 0xFFU) - 1;
  PSYGEN_CHECK(id >> 24 == 2 && n <= kMaxSubdivisions, "the index list is one of mesh_size()");
  PSYGEN_CHECK(out.size() == rock_triangles(static_cast<int>(n)) * 3,
               "the span has exactly the size of the list");
  std::iota(out.begin(), out.end(), std::uint16_t{0});
}

core::Bounds RockType::synthesize(const Parameters& p, int level, const MeshView& out) const {
  const int n = subdivisions_at(p, level);
  const std::span<const std::uint16_t> corners = topology_.indices(n);
  PSYGEN_CHECK(out.vertices.size() == corners.size() * sizeof(core::ModelVertex),
               "the destination has exactly the size of the mesh");
  const RockShape shape(p);
  std::array<glm::vec3, kMaxVertices> position, normal;
  displace(shape, topology_.parents(), n, position);
  core::Bounds box{glm::vec3(1e30F), glm::vec3(-1e30F)};
  for (std::uint32_t v = 0; v < rock_vertices(n); ++v) {
    position[v] = position[v] * shape.stretch;
    position[v].y += shape.lift;
    box.min = glm::min(box.min, position[v]);
    box.max = glm::max(box.max, position[v]);
    normal[v] = glm::vec3(0.0F);
  }
  std::array<glm::vec3, rock_triangles(kMaxSubdivisions)> face;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const glm::vec3 a = position[corners[i]];
    const glm::vec3 area = glm::cross(position[corners[i + 1]] - a, position[corners[i + 2]] - a);
    for (std::size_t k = 0; k < 3; ++k)
      normal[corners[i + k]] += area;
    face[i / 3] = area * (1.0F / std::sqrt(glm::dot(area, area)));
  }
  std::array<core::ModelVertex, kMaxVertices> vertices;
  const BoxPacker packer(bounds(p));
  const auto moss = static_cast<float>(p.real(kRockMoss));
  for (std::uint32_t v = 0; v < rock_vertices(n); ++v) {
    normal[v] *= 1.0F / std::sqrt(glm::dot(normal[v], normal[v]));
    packer.pack(position[v], vertices[v].position);
    paint(shape, moss, position[v].y, normal[v].y, Signed(shape.key, 2 + v).f[1], vertices[v]);
  }
  write_facets(corners, face, normal, vertices, out.vertices.data());
  return box;
}

}  // namespace

std::unique_ptr<ModelType> make_rock_type() {
  return std::make_unique<RockType>();
}

}  // namespace psygen::models
