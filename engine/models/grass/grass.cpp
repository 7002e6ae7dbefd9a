#include "engine/models/grass/grass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/assert.hpp"
#include "engine/models/grass/blades.hpp"

namespace psygen::models {
namespace {

constexpr int kLevels = 4;

std::uint32_t blades_of(const Parameters& p) {
  return static_cast<std::uint32_t>(p.integer(kGrassBlades));
}
std::uint32_t flowers_of(const Parameters& p) {
  return static_cast<std::uint32_t>(p.integer(kGrassFlowers));
}
// Number of blades or flowers of `all` that a level keeps.
std::uint32_t left(std::uint32_t all, int level) {
  const std::uint32_t each = level < 2 ? 1 : level == 2 ? 3 : 9;
  return (all + each - 1) / each;
}

GrassPatch patch_of(const Parameters& p) {
  GrassPatch patch;
  patch.key = core::mix64(static_cast<std::uint64_t>(p.integer(kGrassSeed)));
  patch.slope = {p.real(kGrassSlopeX), p.real(kGrassSlopeZ)};
  patch.tufts = grass_tufts(blades_of(p));
  patch.radius = static_cast<float>(p.real(kGrassRadiusM));
  patch.height = static_cast<float>(p.real(kGrassHeightM));
  patch.width = static_cast<float>(p.real(kGrassWidthM));
  patch.lean = static_cast<float>(p.real(kGrassLean));
  patch.brightness = std::sqrt(static_cast<float>(p.real(kGrassAlbedo)));
  patch.dryness = static_cast<float>(p.real(kGrassDryness));
  constexpr std::array<glm::vec3, kFlowerCount> kPetals{
      {{0.90F, 0.90F, 0.86F}, {0.90F, 0.76F, 0.16F}, {0.72F, 0.42F, 0.62F}, {0.38F, 0.42F, 0.78F}}};
  patch.petals = kPetals[static_cast<std::size_t>(p.integer(kGrassFlower))];
  return patch;
}

class GrassType final : public ModelType {
 public:
  std::string_view name() const override { return "grass"; }
  std::string_view doc() const override {
    return "patch of grass: tufts of blades, 3 triangles each, and flowers";
  }
  std::span<const ParameterSpec> parameters() const override { return kGrassSchema; }
  int level_count() const override { return kLevels; }
  int level_count_of(const Parameters& p) const override {
    const std::uint32_t most = std::max(blades_of(p), flowers_of(p));
    return most == 1 ? 2 : most <= 3 ? 3 : kLevels;
  }
  bool is_seen_from_far() const override { return false; }
  double seen_size_m(const Parameters& p) const override { return 0.5 * p.real(kGrassHeightM); }
  double level_error_m(const Parameters& p, int level) const override;
  core::Bounds bounds(const Parameters& p) const override;
  MeshSize mesh_size(const Parameters& p, int level) const override;
  bool may_run_on_main_thread() const override { return true; }
  double step_seconds() const override { return 40e-9; }
  double complexity(const Parameters& p, int level) const override {
    return 0.2 * mesh_size(p, level).vertex_count;
  }
  double log2_cost(const Parameters& p) const override {
    const auto blades = std::max(static_cast<double>(p.integer(kGrassBlades)), 1.0);
    const auto flowers = std::max(static_cast<double>(p.integer(kGrassFlowers)), 0.0);
    return std::log2(kBladeTriangles * blades + kFlowerTriangles * flowers);
  }
  core::Bounds synthesise(const Parameters& p, int level, const MeshView& out) const override;
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {
    PSYGEN_CHECK(false, "grass shares no indices");
  }
};

// Level 1 omits the bends, level 2 most blades of a tuft, level 3 whole tufts.
double GrassType::level_error_m(const Parameters& p, int level) const {
  const int at = std::min(level, level_count_of(p) - 1);
  if (at == 0) return 0;
  const double height = p.real(kGrassHeightM), width = p.real(kGrassWidthM);
  const double depth = static_cast<double>(foot_depth(patch_of(p)));
  const double middle = (kBendHeight * height + depth) / (height + depth) - kBendShift;
  const double bend = middle * height * p.real(kGrassLean) + 0.5 * width;
  if (at == 1) return bend;
  const double tuft = bend + kTuftSpread * height + 0.5 * width;
  if (at == 2) return tuft;
  return tuft + p.real(kGrassRadiusM) / std::sqrt(static_cast<double>(left(blades_of(p), at)));
}

core::Bounds GrassType::bounds(const Parameters& p) const {
  const GrassPatch patch = patch_of(p);
  // Blades of level 3 are up to 9 times as wide.
  const float broadest = kBroadBlade * 9 * patch.width;
  const float feet = patch.radius + 1.5F * kTuftSpread * patch.height;
  const float aside = (feet + patch.lean * patch.height + broadest) * 1.001F;
  const float rise = (std::abs(patch.slope.x) + std::abs(patch.slope.y)) * feet;
  const float up = (rise + 1.3F * patch.height + broadest) * 1.001F;
  return {{-aside, -1.001F * (rise + foot_depth(patch)), -aside}, {aside, up, aside}};
}

MeshSize GrassType::mesh_size(const Parameters& p, int level) const {
  const std::uint32_t blades = left(blades_of(p), level), flowers = left(flowers_of(p), level);
  if (level == 0)
    return {kBladeVertices * blades + kFlowerVertices * flowers,
            3 * (kBladeTriangles * blades + kFlowerTriangles * flowers)};
  return {3 * (blades + flowers), 3 * (blades + flowers)};
}

core::Bounds GrassType::synthesise(const Parameters& p, int level, const MeshView& out) const {
  const MeshSize size = mesh_size(p, level);
  PSYGEN_CHECK(out.vertices.size() == size.vertex_count * sizeof(core::ModelVertex) &&
                   out.indices.size() == size.index_count,
               "the destination has exactly the size of the mesh");
  const GrassPatch patch = patch_of(p);
  GrassWriter writer(patch, bounds(p), out);
  const std::uint32_t blades = left(blades_of(p), level), flowers = left(flowers_of(p), level);
  const float broader = static_cast<float>(blades_of(p)) / static_cast<float>(blades);
  for (std::uint32_t i = 0; i < blades; ++i) {
    if (level == 0)
      writer.add_blade(blade_of(patch, i));
    else
      writer.add_coarse_blade(blade_of(patch, i), kBroadBlade * broader);
  }
  const float larger =
      std::sqrt(static_cast<float>(flowers_of(p)) / static_cast<float>(std::max(flowers, 1U)));
  for (std::uint32_t i = 0; i < flowers; ++i) {
    const GrassBlade stem = blade_of(patch, kFirstStem + i);
    if (level == 0)
      writer.add_flower(stem);
    else
      writer.add_coarse_flower(stem, larger);
  }
  return writer.tight();
}

}  // namespace

std::unique_ptr<ModelType> make_grass_type() {
  return std::make_unique<GrassType>();
}

}  // namespace psygen::models
