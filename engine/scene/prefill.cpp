// What happens before the first frame: filling the cache for a pose, or amplifying a region.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/core/clock.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/synthesize.hpp"

namespace psygen::scene {
namespace {

// A tick looks at each block around the camera once in 8 turns; so long must nothing be missing.
constexpr int kQuietTicks = 9;
// No view needs so many; a bound in case the budget lets nothing settle.
constexpr int kMaxTicks = 20'000;

struct RegionSize {
  std::uint64_t meshes = 0, bytes = 0;
};

int levels_needed(const Settings& settings, const Detail& detail) {
  return settings.levels_of_detail ? static_cast<int>(detail.level_count) : 1;
}

// What amplifying everything that exists now would take.
RegionSize region_size(const State& s) {
  RegionSize size;
  s.entities.each<const Source, const Detail>([&](std::span<const ecs::Entity>,
                                                  std::span<const Source> sources,
                                                  std::span<const Detail> details) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      for (int level = 0; level < levels_needed(s.settings, details[i]); ++level) {
        const models::MeshSize mesh =
            s.facts.registry[sources[i].model].mesh_size(sources[i].parameters, level);
        size.bytes += s.memory->charged_bytes(mesh.layout, mesh.vertex_count,
                                              mesh.shared_indices != 0 ? 0 : mesh.index_count);
        ++size.meshes;
      }
    }
  });
  return size;
}

// Wants for everything that exists now.
void want_everything(State& s) {
  std::vector<synthesis::Want>& wants = s.synthesis.wants;
  wants.clear();
  s.entities.each<const Placed, const Source, const Detail>(
      [&](std::span<const ecs::Entity> entities, std::span<const Placed> placed,
          std::span<const Source> sources, std::span<const Detail> details) {
        for (std::size_t i = 0; i < entities.size(); ++i) {
          for (int level = 0; level < levels_needed(s.settings, details[i]); ++level) {
            const synthesis::MeshKey key{placed[i].block, sources[i].index, sources[i].model,
                                         static_cast<std::uint16_t>(level),
                                         sources[i].parameters_hash};
            wants.push_back({key, &sources[i].parameters, owner_of(entities[i]),
                             synthesis::Rank(synthesis::RankGroup::kDrawn, 0, 0.0F), 0.0F});
          }
        }
      });
}

void land_everything(State& s) {
  Settings unlimited = s.settings;
  unlimited.upload_budget_bytes = UINT64_MAX;
  synthesis_system(s.settings, s.synthesis, s.counters, s.trace);
  s.synthesis.ready.clear();
  upload_system(unlimited, s.clock, s.facts, s.entities, s.synthesis, s.shared_indices, s.renderer,
                s.counters, s.totals);
}

void create_all_blocks(State& s) {
  do {
    streaming_system(s.settings, s.camera, s.facts, s.streaming, s.entities, *s.synthesis.cache,
                     s.counters);
  } while (!s.streaming.missing.empty());
}

}  // namespace

void Scene::tick_without_drawing(const core::CameraPose& pose) {
  State& s = state_;
  s.input.pose = pose;
  s.clock.real_s = core::monotonic_seconds() - s.clock.origin_s;
  s.counters = {};
  input_system(s.input, s.clock, s.facts, s.camera);
  streaming_system(s.settings, s.camera, s.facts, s.streaming, s.entities, *s.synthesis.cache,
                   s.counters);
  visibility_system(s.settings, s.camera, s.facts, s.streaming, s.entities, s.view, s.counters);
  cache_system(s.settings, s.clock, s.camera, s.facts, s.streaming, s.view, s.entities, s.synthesis,
               s.counters, s.totals);
  s.synthesis.manager->wait_all();
  synthesis_system(s.settings, s.synthesis, s.counters, s.trace);
  upload_system(s.settings, s.clock, s.facts, s.entities, s.synthesis, s.shared_indices, s.renderer,
                s.counters, s.totals);
  ++s.clock.tick;
}

std::uint64_t Scene::settle(const core::CameraPose& pose, const Progress& progress) {
  State& s = state_;
  std::uint64_t synthesised = 0;
  int quiet = 0;
  for (int i = 0; i < kMaxTicks && quiet < kQuietTicks; ++i) {
    tick_without_drawing(pose);
    synthesised += s.counters.models_synthesised;
    const bool complete = s.streaming.missing.empty() && s.synthesis.finished.empty();
    // What the budget refuses will not come by waiting; levels get coarser until nothing is
    // refused.
    quiet = complete && s.counters.requests == 0 ? quiet + 1 : 0;
    if (progress) {
      const double missing =
          s.counters.requests + 64.0 * static_cast<double>(s.streaming.missing.size());
      progress("filling the cache", static_cast<double>(synthesised) /
                                        (static_cast<double>(synthesised) + missing + 1.0));
    }
  }
  return synthesised;
}

core::Result<std::uint64_t> Scene::amplify(const core::CameraPose& pose, const Progress& progress) {
  State& s = state_;
  s.input.pose = pose;
  input_system(s.input, s.clock, s.facts, s.camera);
  create_all_blocks(s);
  const RegionSize size = region_size(s);
  if (size.bytes > s.settings.budget_bytes) {
    return core::fail(
        core::ErrorCode::kOverBudget,
        fmt::format("amplifying the {0} × {0} blocks around the camera takes {1:.0f} MiB for {2} "
                    "meshes, more than the budget of {3:.0f} MiB; lower --view-distance or raise "
                    "--budget",
                    s.streaming.grid.side(), static_cast<double>(size.bytes) / (1 << 20),
                    size.meshes, static_cast<double>(s.settings.budget_bytes) / (1 << 20)));
  }
  want_everything(s);
  std::vector<synthesis::Want> all = std::move(s.synthesis.wants);
  constexpr std::size_t kBatch = 2048;
  std::uint64_t done = 0;
  for (std::size_t first = 0; first < all.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, all.size() - first);
    s.synthesis.planner->plan(std::span(all).subspan(first, count), *s.synthesis.cache,
                              *s.synthesis.cost, *s.synthesis.manager,
                              {std::numeric_limits<double>::infinity(), UINT32_MAX},
                              synthesis::Policy::kLongest);
    s.synthesis.manager->wait_all();
    s.counters = {};
    land_everything(s);
    done += s.counters.models_synthesised;
    if (progress) {
      progress("amplifying", static_cast<double>(first + count) / static_cast<double>(all.size()));
    }
  }
  return done;
}

std::uint64_t sample_world_hash(const world::World& world, const models::Registry& registry,
                                core::BlockCoord block) {
  synthesis::WorldHash hash;
  std::vector<world::Placement> placements;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const core::BlockCoord coord{block.x + dx, block.z + dz};
      placements.clear();
      if (!world.contains(coord)) continue;
      world::place_models(world, registry, coord, placements);
      placements.push_back({world.terrain_model, kTerrainIndex, glm::vec3(0.0F),
                            world::terrain_parameters(world, coord)});
      for (const world::Placement& placement : placements) {
        const models::ModelType& type = registry[placement.model];
        for (int level = 0; level < type.level_count(); ++level) {
          const auto mesh = synthesis::HeapDestination::make(type, placement.parameters, level);
          if (!mesh) continue;
          const models::MeshView view = mesh->view();
          if (!synthesis::synthesize_guarded(type, placement.parameters, level, view).ok) continue;
          hash.add(synthesis::content_hash(
              {coord, placement.index, placement.model, static_cast<std::uint16_t>(level),
               placement.parameters.hash()},
              view));
        }
      }
    }
  }
  return hash.value();
}

}  // namespace psygen::scene
