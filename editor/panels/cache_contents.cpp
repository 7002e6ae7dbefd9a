#include "editor/panels/cache_contents.hpp"

#include <algorithm>

#include "ecs/ecs.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

constexpr std::size_t kSampled = 256;  // entities per table whose synthesis time is predicted

// Mean predicted seconds of the drawn meshes, by model type; 0 without a sample.
std::vector<double> mean_seconds(const scene::Scene& scene) {
  std::vector<double> sums(scene.registry().size());
  std::vector<double> counts(sums.size());
  scene.entities().each<const scene::MeshSource, const scene::MeshDemand>(
      [&](std::span<const ecs::Entity>, std::span<const scene::MeshSource> sources,
          std::span<const scene::MeshDemand> demands) {
        const std::size_t step = std::max<std::size_t>(sources.size() / kSampled, 1);
        for (std::size_t i = 0; i < sources.size(); i += step) {
          const scene::MeshSource& source = sources[i];
          if (demands[i].drawn_level == scene::kNoLevel || source.model >= sums.size()) continue;
          sums[source.model] += scene.meshes().costs().predict(
              source.model, source.parameters, source.first_level + demands[i].drawn_level);
          ++counts[source.model];
        }
      });
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

}  // namespace

std::map<std::string, TypeContents> contents_by_type(const scene::Scene& scene) {
  std::vector<TypeContents> types(scene.registry().size());
  for (const synthesis::MeshRecord& record : scene.meshes().records()) {
    if (record.state != synthesis::MeshState::kReady || record.key.model >= types.size()) continue;
    TypeContents& of = types[record.key.model];
    of.model = record.key.model;
    ++of.meshes;
    of.triangles += record.size.triangle_count();
    of.vertices += record.size.vertex_count;
    of.bytes += record.range.bytes;
  }
  std::map<std::string, TypeContents> held;
  for (const TypeContents& of : types)
    if (of.meshes > 0) held.emplace(scene.registry()[of.model].name(), of);
  return held;
}

CacheContents contents_of(const scene::Scene& scene) {
  using Kind = HeldMeshes::Kind;
  CacheContents contents;
  contents.budget_bytes = static_cast<double>(scene.meshes().stats().budget_bytes);
  contents.modelers =
      std::max(static_cast<unsigned>(scene.meshes().modeler_stats().modelers.size()), 1U);
  const scene::WorldFacts& facts = scene.facts();
  const std::vector<double> seconds = mean_seconds(scene);
  for (const auto& [name, of] : contents_by_type(scene)) {
    HeldMeshes held;
    held.type = name;
    held.kind = of.model == facts.world.terrain_model ? Kind::kGround
                : of.model >= facts.given_types       ? Kind::kDerived
                                                      : Kind::kModel;
    held.meshes = of.meshes;
    held.bytes = static_cast<double>(of.bytes);
    held.seconds = seconds[of.model] * static_cast<double>(held.meshes);
    contents.held.push_back(std::move(held));
  }
  return contents;
}

}  // namespace psygen::editor
