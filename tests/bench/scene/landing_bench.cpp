// Cost of mesh annotations (bounds of the parts of a merged mesh, occluder lines and light of a
// node's ground): on the modeler that writes them, and on the main thread that reads them.
#include <benchmark/benchmark.h>

#include <any>
#include <memory>
#include <span>
#include <vector>

#include "engine/scene/meshes/mesh_annotations.hpp"
#include "engine/scene/nodes/ground_occluder.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"
#include "tests/source_file.hpp"

namespace psygen::scene {
namespace {

world::World paper_world(const models::Registry& registry) {
  return world::load_world(source_file("game/worlds/paper.toml"), registry).value();
}

template <class Vertex>
struct Synthesised {
  std::vector<Vertex> vertices;
  std::vector<std::uint16_t> indices;

  Synthesised(const models::ModelType& type, const models::Parameters& p, int level) {
    const models::MeshSize size = type.mesh_size(p, level);
    vertices.resize(size.vertex_count);
    indices.resize(size.shared_indices == 0 ? size.index_count : 0);
    type.synthesise(p, level, {std::as_writable_bytes(std::span(vertices)), indices});
  }
};

void parts_of_a_merged_mesh(benchmark::State& state) {
  const models::Registry registry = models::make_standard_registry();
  const auto world = std::make_shared<const world::World>(paper_world(registry));
  const auto type = world::make_merged_type(world, registry);
  const auto p = world::merged_parameters({5, 7}, static_cast<int>(state.range(0)));
  const Synthesised<core::ModelVertex> mesh(*type, p, 0);
  const core::Bounds box = type->bounds(p);
  for (auto _ : state)
    benchmark::DoNotOptimize(mesh_parts(mesh.vertices, mesh.indices, box));
  state.counters["triangles"] = static_cast<double>(mesh.indices.size()) / 3;
}
BENCHMARK(parts_of_a_merged_mesh)->ArgName("node_level")->DenseRange(1, 5);

void note_of_ground(benchmark::State& state) {
  const models::Registry registry = models::make_standard_registry();
  const world::World world = paper_world(registry);
  const models::ModelType& type = registry[world.terrain_model];
  const auto level = static_cast<int>(state.range(0));
  const models::Parameters p = world::terrain_parameters(world, {5, 7});
  const Synthesised<core::TerrainVertex> mesh(type, p, level);
  const models::TerrainGrid grid(static_cast<int>(world.terrain.integer(models::kTerrainSize)),
                                 level);
  const core::Bounds box = type.bounds(p);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        ground_occluder(mesh.vertices, grid, box.min.y, box.max.y - box.min.y, 0.0F));
    benchmark::DoNotOptimize(ground_sunlight(mesh.vertices, static_cast<std::size_t>(grid.n)));
  }
}
BENCHMARK(note_of_ground)->ArgName("level")->DenseRange(0, 1);

// Meshes applied long after their synthesis: more annotations than the processor's caches hold.
template <class T>
void note_lands(benchmark::State& state) {
  constexpr std::size_t kNotes = 20'000;
  const std::vector<std::any> notes(kNotes, std::any(T{}));
  T component;
  std::size_t next = 0;
  for (auto _ : state) {
    component = *std::any_cast<T>(&notes[next]);
    benchmark::DoNotOptimize(component);
    next = (next + 7919) % kNotes;
  }
}
BENCHMARK(note_lands<GroundAnnotation>);
BENCHMARK(note_lands<MeshParts>);

}  // namespace
}  // namespace psygen::scene

BENCHMARK_MAIN();
