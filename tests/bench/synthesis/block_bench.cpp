// Time of one of the paper's blocks on one core: terrain with 64 vertices per side and 9 octaves,
// 23 trees of 3 to 5 iterations and 2 to 4 branches, 40 rocks of 2 subdivisions. On every compiled
// instruction set, and with the double-precision references (without packing vertices).
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/rock/rock.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/models/tree/tree.hpp"
#include "tests/bench/synthesis/per_target.hpp"
#include "tests/engine/models/oracle/rock.hpp"
#include "tests/engine/models/oracle/terrain.hpp"
#include "tests/engine/models/oracle/tree.hpp"

namespace psygen::models {
namespace {

// Parts of a block; combine them with |.
constexpr int kTerrain = 1, kRocks = 2, kTrees = 4;

// Generates the models of consecutive blocks.
struct Blocks {
  Registry registry = make_standard_registry();
  Parameters terrain = default_parameters(registry[0]), rock = default_parameters(registry[1]),
             tree = default_parameters(registry[2]);
  std::int32_t block = 0;

  // Calls make(type, parameters) for each model of the next block.
  template <class Make>
  void next(int parts, const Make& make) {
    core::RandomStream random(1, block, 0, 0, core::Purpose::kParameters);
    terrain.set_integer(kTerrainBlockX, block++);
    if ((parts & kTerrain) != 0) make(registry[0], terrain);
    for (int i = 0; (parts & kRocks) != 0 && i < 40; ++i) {
      rock.set_integer(kRockSeed, static_cast<std::int64_t>(random.next_u64()));
      make(registry[1], rock);
    }
    for (int i = 0; (parts & kTrees) != 0 && i < 23; ++i) {
      tree.set_integer(kTreeSeed, static_cast<std::int64_t>(random.next_u64()));
      tree.set_integer(kTreeIterations, random.next_integer(3, 5));
      tree.set_integer(kTreeBranches, random.next_integer(2, 4));
      make(registry[2], tree);
    }
  }
};

void report(benchmark::State& state, double triangles) {
  state.counters["triangles"] = triangles / static_cast<double>(state.iterations());
  bench::report_triangles(state, triangles);
  bench::report_seconds_each(state, 1);
}

void paper_block(benchmark::State& state) {
  Blocks blocks;
  std::vector<std::byte> vertices(65536 * sizeof(core::ModelVertex));
  std::vector<std::uint16_t> indices(3 * 131072);
  double triangles = 0;
  for (auto _ : state) {
    blocks.next(static_cast<int>(state.range(0)), [&](const ModelType& type, const Parameters& p) {
      const MeshSize size = type.mesh_size(p, 0);
      const std::size_t bytes = size.vertex_count * core::vertex_stride_bytes(size.layout);
      const std::size_t own = size.shared_indices == 0 ? size.index_count : 0;
      benchmark::DoNotOptimize(
          type.synthesise(p, 0, {std::span(vertices).first(bytes), std::span(indices).first(own)}));
      triangles += size.triangle_count();
    });
  }
  report(state, triangles);
}

const bool kRegistered = bench::for_each_target("paper_block", paper_block, [](auto* b, bool) {
  b->Arg(kTerrain | kRocks | kTrees)->Arg(kTerrain)->Arg(kRocks)->Arg(kTrees)->ArgName("parts");
});

void make_by_reference(const ModelType& type, const Parameters& p) {
  if (type.name() == "rock") {
    benchmark::DoNotOptimize(test::rock_oracle(p).places.data());
  } else if (type.name() == "tree") {
    benchmark::DoNotOptimize(test::TreeOracle(plan_of_tree(p)).mesh(0));
  } else {
    const test::TerrainOracle oracle{
        .seed = 1, .height = 1.2, .offset = 0.88, .cells_per_step = 1.0 / 600};
    const std::int64_t first = 63 * p.integer(kTerrainBlockX);
    double sum = 0;
    for (std::int64_t z = 0; z < 64; ++z)
      for (std::int64_t x = 0; x < 64; ++x)
        sum += oracle.value(first + x, z);
    benchmark::DoNotOptimize(sum);
  }
}

void paper_block_reference(benchmark::State& state) {
  Blocks blocks;
  double triangles = 0;
  for (auto _ : state) {
    blocks.next(static_cast<int>(state.range(0)), [&](const ModelType& type, const Parameters& p) {
      make_by_reference(type, p);
      triangles += type.mesh_size(p, 0).triangle_count();
    });
  }
  report(state, triangles);
}
BENCHMARK(paper_block_reference)
    ->Name("paper_block/reference")
    ->Arg(kTerrain | kRocks | kTrees)
    ->ArgName("parts");

}  // namespace
}  // namespace psygen::models
