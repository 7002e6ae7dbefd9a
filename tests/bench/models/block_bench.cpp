// Time of one whole block of the paper on one core: terrain of 64 vertices a side and 9 octaves, 23
// trees of 3 to 5 iterations and 2 to 4 branches, 40 rocks of 2 subdivisions. On every instruction
// set that kernels are compiled for.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/rock.hpp"
#include "engine/models/simd_targets.hpp"
#include "engine/models/terrain.hpp"
#include "engine/models/tree.hpp"

namespace psygen::models {
namespace {

struct Destination {
  std::vector<std::byte> vertices;
  std::vector<std::uint16_t> indices;
  double triangles = 0;

  void synthesize(const ModelType& type, const Parameters& p) {
    const MeshSize size = type.mesh_size(p, 0);
    const std::size_t bytes = size.vertex_count * core::vertex_stride_bytes(size.layout);
    const std::size_t own = size.shared_indices == 0 ? size.index_count : 0;
    if (vertices.size() < bytes) vertices.resize(bytes);
    if (indices.size() < own) indices.resize(own);
    benchmark::DoNotOptimize(
        type.synthesize(p, 0, {std::span(vertices).first(bytes), std::span(indices).first(own)}));
    triangles += size.triangle_count();
  }
};

// parts: the sum of 1 for terrain, 2 for rocks, 4 for trees.
void block_of_the_paper(benchmark::State& state, const std::string& target) {
  pin_simd_target(target);
  const Registry registry = make_standard_registry();
  const ModelType &terrain_type = registry[0], &rock_type = registry[1], &tree_type = registry[2];
  Parameters terrain = default_parameters(terrain_type), rock = default_parameters(rock_type),
             tree = default_parameters(tree_type);
  const bool with_terrain = (state.range(0) & 1) != 0, with_rocks = (state.range(0) & 2) != 0,
             with_trees = (state.range(0) & 4) != 0;
  Destination out;
  std::int32_t block = 0;
  for (auto _ : state) {
    core::RandomStream random(1, block, 0, 0, core::Purpose::kParameters);
    terrain.set_integer(kTerrainBlockX, block++);
    if (with_terrain) out.synthesize(terrain_type, terrain);
    for (int i = 0; with_rocks && i < 40; ++i) {
      rock.set_integer(kRockSeed, static_cast<std::int64_t>(random.next_u64()));
      out.synthesize(rock_type, rock);
    }
    for (int i = 0; with_trees && i < 23; ++i) {
      tree.set_integer(kTreeSeed, static_cast<std::int64_t>(random.next_u64()));
      tree.set_integer(kTreeIterations, random.next_integer(3, 5));
      tree.set_integer(kTreeBranches, random.next_integer(2, 4));
      out.synthesize(tree_type, tree);
    }
  }
  unpin_simd_target();
  state.counters["triangles"] = out.triangles / static_cast<double>(state.iterations());
  state.counters["triangles_per_second"] =
      benchmark::Counter(out.triangles, benchmark::Counter::kIsRate);
}

const bool kRegistered = [] {
  for (const std::string_view target : simd_targets()) {
    const std::string name(target);
    benchmark::RegisterBenchmark(("block_of_the_paper/" + name).c_str(), block_of_the_paper, name)
        ->Arg(7)
        ->Arg(1)
        ->Arg(2)
        ->Arg(4)
        ->ArgName("parts");
  }
  return true;
}();

}  // namespace
}  // namespace psygen::models

BENCHMARK_MAIN();
