#include "engine/scene/meshes/mesh_annotations.hpp"

#include <algorithm>

#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

bool same(const GroundOccluder& a, const GroundOccluder& b) {
  return a.points == b.points && a.place == b.place && a.height_m == b.height_m &&
         a.top_m == b.top_m;
}

struct Noted {
  std::size_t ground = 0, fine = 0, merged = 0, single = 0;
};

// Checks the annotations of everything in the cache against the meshes in memory.
Noted check_records(const State& s) {
  Noted noted;
  for (const synthesis::MeshRecord& record : s.supply.records()) {
    if (record.state != synthesis::MeshState::kReady) {
      EXPECT_FALSE(record.note.has_value());
    } else if (record.key.model == s.facts.world.terrain_model) {
      EXPECT_NE(std::any_cast<GroundAnnotation>(&record.note), nullptr);
      ++noted.ground;
    } else if (record.key.model == s.facts.merged_model) {
      const auto* parts = std::any_cast<MeshParts>(&record.note);
      ++noted.merged;
      if (parts == nullptr) {
        ADD_FAILURE() << "no parts";
        continue;
      }
      const MeshParts now =
          mesh_parts(core::vertices_of<core::ModelVertex>(s.memory->vertex_bytes(record.range)),
                     s.memory->indices(record.range), {});
      EXPECT_EQ(parts->count, now.count);
      EXPECT_EQ(parts->index_count, now.index_count);
    } else {
      EXPECT_FALSE(record.note.has_value());
      ++noted.single;
    }
  }
  return noted;
}

// Checks the occluder of every node with ground against its drawn mesh; adds to `noted`.
void check_occluders(Scene& scene, Noted& noted) {
  const State& s = state_of(scene);
  s.entities.each<const QuadtreeNode, const GroundOccluder, const MeshDemand, const Mesh,
                  const MeshSource>(
      [&](std::span<const ecs::Entity>, std::span<const QuadtreeNode> nodes,
          std::span<const GroundOccluder> occluders, std::span<const MeshDemand> demands,
          std::span<const Mesh> meshes, std::span<const MeshSource> sources) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          if (demands[i].drawn_level == kNoLevel) continue;
          const int level = sources[i].first_level + demands[i].drawn_level;
          const NodeLevel& facts = s.facts.levels[nodes[i].at.level];
          // Ground of a block that its finest mesh may replace.
          const bool coarse = nodes[i].at.level == 0 && level > 0;
          const float lower_by_m = coarse ? static_cast<float>(facts.ground_bound_m) : 0.0F;
          const GroundOccluder now = ground_occluder(
              core::vertices_of<core::TerrainVertex>(s.memory->vertex_bytes(meshes[i].range)),
              s.facts.grids[static_cast<std::size_t>(level)], facts.bounds.min.y,
              facts.bounds.max.y - facts.bounds.min.y, lower_by_m);
          EXPECT_GT(occluders[i].points, 0u);
          EXPECT_TRUE(same(occluders[i], now)) << int{nodes[i].at.level} << " " << level;
          EXPECT_LE(nodes[i].low_m, meshes[i].tight.min.y);
          EXPECT_GE(nodes[i].high_m, meshes[i].tight.max.y);
          ++(level == 0 ? noted.fine : noted.ground);
        }
      });
}

TEST(MeshAnnotations, BelongToTheirMeshesAlsoWhenTheseAreFoundAgain) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 1000;
  settings.max_error_pixels = 2;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  const std::uint64_t evictions = state_of(*scene).supply.stats().evictions;
  for (const std::int32_t block : {256, 330, 256}) {  // away from all blocks and back
    const std::uint64_t hits = state_of(*scene).supply.stats().hits;
    const bool back = state_of(*scene).camera.pose.position.block.x > block;
    scene->settle(pose_at(block, 256));
    const Noted kept = check_records(state_of(*scene));
    EXPECT_GT(kept.ground, 100u);
    EXPECT_GT(kept.merged, 20u);
    EXPECT_GT(kept.single, 100u);
    Noted drawn;
    check_occluders(*scene, drawn);
    EXPECT_GT(drawn.ground, 100u);
    EXPECT_GT(drawn.fine, 3u);
    if (back) {
      EXPECT_GT(state_of(*scene).supply.stats().hits, hits + 1000);
    }
  }
  EXPECT_EQ(state_of(*scene).supply.stats().evictions, evictions);
}

TEST(MeshAnnotations, ExistInEveryParadigm) {
  for (const Paradigm paradigm : {Paradigm::kParallelLazyAmplification, Paradigm::kLazyEvaluation,
                                  Paradigm::kDataAmplification}) {
    SceneSettings settings = small_settings();
    settings.paradigm = paradigm;
    if (paradigm == Paradigm::kDataAmplification) {
      settings.view_distance_m = 64;
      settings.budget_bytes = 512ull << 20;
    }
    const auto scene = make_scene(settings);
    if (paradigm == Paradigm::kDataAmplification) {
      ASSERT_TRUE(scene->amplify(pose_at(260, 256)));
    }
    for (int i = 0; i < 20; ++i) {
      tick_at(*scene, pose_at(260, 256));
      state_of(*scene).supply.wait();
    }
    Noted noted = check_records(state_of(*scene));
    EXPECT_GT(noted.ground, 10u);
    check_occluders(*scene, noted);
    EXPECT_GT(noted.fine, 0u);
  }
}

}  // namespace
}  // namespace psygen::scene
