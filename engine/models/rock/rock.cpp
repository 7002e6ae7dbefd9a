#include "engine/models/rock/rock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/rock/kernel.hpp"

namespace psygen::models {
namespace {

constexpr float kLift = 0.45F;    // height of the centre above the ground over the half-height
constexpr float kWidest = 1.2F;   // largest stretch along x and z
constexpr float kHighest = 0.9F;  // largest stretch along y
constexpr std::uint32_t kLayerItem = 1U << 31;

// The differences between the families.
struct Family {
  float amplitude;    // factor of the parameter
  float height;       // factor of the stretch along y
  float facet;        // weight of the triangle's normal at its corners; 0: shared vertices
  float ledge, tint;  // of layers: fractions of the distance from the centre and of the stored
                      // colour
};
constexpr Family kFamilies[kRockFamilyCount] = {
    {.amplitude = 0.8F, .height = 1.0F, .facet = 0, .ledge = 0, .tint = 0},
    {.amplitude = 1.0F, .height = 1.0F, .facet = 0.7F, .ledge = 0, .tint = 0},
    {.amplitude = 0.8F, .height = 0.75F, .facet = 0, .ledge = 0.13F, .tint = 0.14F}};
const Family& family_of(const Parameters& p) {
  return kFamilies[static_cast<std::size_t>(p.integer(kRockFamily))];
}

RockShape shape_of(const Parameters& p, const core::Bounds& box) {
  const Family& family = family_of(p);
  RockShape shape;
  const std::uint64_t key = core::mix64(static_cast<std::uint64_t>(p.integer(kRockSeed)));
  shape.key = key;
  const RockRandom turn(key, 0);
  std::ranges::copy(turn.f, shape.turn);
  shape.turn[3] = std::abs(turn.f[3]) + 0.1F;
  shape.amplitude = static_cast<float>(p.real(kRockAmplitude)) * family.amplitude;
  shape.decay = static_cast<float>(p.real(kRockDecay));
  const auto moss = static_cast<float>(p.real(kRockMoss));
  shape.moss = moss * (2.0F - moss);
  shape.facet = family.facet;
  shape.ledge = family.ledge;
  shape.tint = family.tint;
  const auto radius = static_cast<float>(p.real(kRockRadiusM));
  const RockRandom s(key, 1);
  shape.stretch = {(1.0F + 0.2F * s.f[0]) * radius,
                   (0.75F + 0.15F * s.f[1]) * radius * family.height,
                   (1.0F + 0.2F * s.f[2]) * radius};
  shape.lift = kLift * shape.stretch.y;
  shape.rise = 0.8F / shape.stretch.y;
  const float warmth = static_cast<float>(p.real(kRockWarmth)) * 0.22F;
  const float albedo = static_cast<float>(p.real(kRockAlbedo)) * (1.0F + 0.15F * s.f[3]);
  shape.colour = glm::vec3(std::sqrt((1.0F + warmth) * albedo), std::sqrt(albedo),
                           std::sqrt((1.0F - warmth) * albedo)) *
                 255.0F;
  const RockRandom layers(key, kLayerItem);
  shape.layer_axis =
      glm::vec3(0.35F * layers.f[1], 1.0F, 0.35F * layers.f[2]) * (2.2F + 0.6F * layers.f[3]);
  shape.layer_phase = layers.f[0];
  const glm::vec3 half = box.half_extent();
  shape.box_centre = box.centre();
  shape.box_scale = {32767.0F / half.x, 32767.0F / half.y, 32767.0F / half.z};
  return shape;
}

int subdivisions_at(const Parameters& p, int level) {
  return std::max(static_cast<int>(p.integer(kRockSubdivisions)) - level, 0);
}

// Returns the id of a shared index list.
constexpr std::uint32_t index_list(int subdivisions, bool faceted) {
  return (2U << 24) | (faceted ? 0x100U : 0U) | static_cast<std::uint32_t>(subdivisions + 1);
}

// The tables of all rocks: constant, and too expensive to make for each registry.
const RockTopology& all_topology() {
  static const RockTopology topology;
  return topology;
}

class RockType final : public ModelType {
 public:
  std::string_view name() const override { return "rock"; }
  std::string_view doc() const override {
    return "rock: midpoint displacement on a tetrahedron, 4*4^subdivisions triangles";
  }
  std::span<const ParameterSpec> parameters() const override { return kRockSchema; }
  int level_count() const override { return kMaxSubdivisions + 1; }
  int level_count_of(const Parameters& p) const override { return subdivisions_at(p, 0) + 1; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const Parameters& p, int level) const override;
  core::Bounds bounds(const Parameters& p) const override;
  MeshSize mesh_size(const Parameters& p, int level) const override;
  double complexity(const Parameters& p, int level) const override;
  double steps(const Parameters& p, int level) const override;
  double step_seconds() const override { return 8e-9; }
  core::SurfaceKind surface() const override { return core::SurfaceKind::kStone; }
  Collider collider(const Parameters& p) const override;
  double log2_cost(const Parameters& p) const override {
    return 2 + 2 * static_cast<double>(p.integer(kRockSubdivisions));
  }
  core::Bounds synthesise(const Parameters& p, int level, const MeshView& out) const override;
  void write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const override;

 private:
  const RockTopology& topology_ = all_topology();
};

// The distance of a unit sphere from its tetrahedron of n subdivisions, plus the displacements that
// the level omits.
double RockType::level_error_m(const Parameters& p, int level) const {
  constexpr std::array<double, kMaxSubdivisions + 1> kSagitta{0.667, 0.423, 0.130, 0.036,
                                                              0.009, 0.002, 0.0006};
  const int full = subdivisions_at(p, 0), n = subdivisions_at(p, level);
  double amplitude = p.real(kRockAmplitude) * family_of(p).amplitude, left_out = 0;
  for (int k = 1; k <= full; ++k) {
    amplitude *= p.real(kRockDecay);
    if (k > n) left_out += 0.5 * amplitude;
  }
  return p.real(kRockRadiusM) * (left_out + kSagitta[static_cast<std::size_t>(n)] -
                                 kSagitta[static_cast<std::size_t>(full)]);
}

core::Bounds RockType::bounds(const Parameters& p) const {
  const Family& family = family_of(p);
  double reach = 1 + family.ledge, amplitude = p.real(kRockAmplitude) * family.amplitude;
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
  const bool faceted = family_of(p).facet > 0;
  return {rock_mesh_vertices(n, faceted), rock_triangles(n) * 3, index_list(n, faceted),
          core::VertexLayout::kModel};
}

double RockType::complexity(const Parameters& p, int level) const {
  const int n = subdivisions_at(p, level);
  return n == 0 ? 0.25 : std::ldexp(n, 2 * (n - 1));
}

// A step is the time of a vertex (1.25 ns, AVX-512, Zen 5). Faceted rocks have the most vertices,
// because their triangles share none. For the smallest rocks the set-up dominates.
double RockType::steps(const Parameters& p, int level) const {
  constexpr double kSetUp = 70, kFirstMidpoints = 15, kTriangle = 0.6;
  const int n = subdivisions_at(p, level);
  return kSetUp + (n > 0 ? kFirstMidpoints : 0) + kTriangle * rock_triangles(n) +
         rock_mesh_vertices(n, family_of(p).facet > 0);
}

void RockType::write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const {
  const int n = static_cast<int>(id & 0xFFU) - 1;
  const bool faceted = id == index_list(n, true);
  PSYGEN_CHECK(n >= 0 && n <= kMaxSubdivisions && (faceted || id == index_list(n, false)),
               "the index list is one of mesh_size()");
  PSYGEN_CHECK(out.size() == rock_triangles(n) * 3, "the span has exactly the size of the list");
  if (faceted) {
    std::iota(out.begin(), out.end(), std::uint16_t{0});
  } else {
    std::ranges::copy(topology_.indices(n), out.begin());
  }
}

core::Bounds RockType::synthesise(const Parameters& p, int level, const MeshView& out) const {
  const core::RoundToNearest rounding;
  const int n = subdivisions_at(p, level);
  PSYGEN_CHECK(out.vertices.size() ==
                   rock_mesh_vertices(n, family_of(p).facet > 0) * sizeof(core::ModelVertex),
               "the destination has exactly the size of the mesh");
  return mesh_rock(shape_of(p, bounds(p)), topology_, n, out.vertices.data());
}

// Returns the points that are farthest in 56 directions, each once. The directions lead to the
// surface of a lattice of 4 x 4 x 4 points.
std::vector<glm::vec3> farthest(const std::vector<glm::vec3>& points) {
  std::vector<std::size_t> chosen;
  for (int i = 0; i < 64; ++i) {
    const glm::ivec3 at = 2 * glm::ivec3(i % 4, i / 4 % 4, i / 16) - 3;
    if (std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) < 3) continue;
    const glm::vec3 direction(at);
    chosen.push_back(static_cast<std::size_t>(
        std::ranges::max_element(points, {},
                                 [&](const glm::vec3& p) { return glm::dot(p, direction); }) -
        points.begin()));
  }
  std::ranges::sort(chosen);
  std::vector<glm::vec3> result;
  for (const std::size_t i : std::span(chosen.begin(), std::unique(chosen.begin(), chosen.end())))
    result.push_back(points[i]);
  return result;
}

// Up to two subdivisions the hull has all corners. Finer rocks use the mesh of at most four
// subdivisions, and only its farthest corners in 56 directions.
Collider RockType::collider(const Parameters& p) const {
  const core::RoundToNearest rounding;
  constexpr int kAll = 2, kFinest = 4;
  constexpr std::uint32_t kMax = rock_mesh_vertices(kFinest, true);
  const int n = std::min(subdivisions_at(p, 0), kFinest);
  const core::Bounds box = bounds(p);
  std::array<core::ModelVertex, kMax> vertices;
  const std::span mesh = std::span(vertices).first(rock_mesh_vertices(n, family_of(p).facet > 0));
  mesh_rock(shape_of(p, box), topology_, n, std::as_writable_bytes(mesh).data());
  // Triangles of faceted rocks share no vertices.
  const auto place = [](const core::ModelVertex& v) { return std::to_array(v.position); };
  std::ranges::sort(mesh, {}, place);
  Collider::Hull hull;
  const auto same = [&](const auto& a, const auto& b) { return place(a) == place(b); };
  for (const core::ModelVertex& v :
       std::span(mesh.begin(), std::unique(mesh.begin(), mesh.end(), same)))
    hull.points.push_back(unpack_position(v, box));
  if (n > kAll) hull.points = farthest(hull.points);
  Collider collider;
  collider.shapes.emplace_back(std::move(hull));
  return collider;
}

}  // namespace

std::unique_ptr<ModelType> make_rock_type() {
  return std::make_unique<RockType>();
}

}  // namespace psygen::models
