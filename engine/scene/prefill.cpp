// The work before the first frame: fills the cache for a pose, or amplifies a region.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/render/renderer.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

// Nodes around the camera are revisited every 8th tick, so nothing is missing after 9 quiet ones.
constexpr int kQuietTicks = 9;
// Filling ends after 40 ticks in a row in which no mesh became ready, or after 300 ticks in which a
// request was refused for want of memory.
constexpr int kIdleTicks = 40, kRefusedTicks = 300;

struct RegionSize {
  std::uint64_t meshes = 0, bytes = 0;
};

// Makes the pipelines of light and particles, which the first frame would wait for otherwise. What
// fails here fails there too.
void prepare_effects(const ecs::World& entities, render::Renderer& renderer) {
  if (entities.count<PointLight>() > 0)
    static_cast<void>(renderer.prepare(render::Feature::kPointLights));
  if (entities.count<ParticleEmitter>() > 0)
    static_cast<void>(renderer.prepare(render::Feature::kParticles));
}

// How many levels of a mesh entity amplification makes, finest first.
int levels_needed(const Settings& settings, const Detail& detail) {
  return settings.levels_of_detail ? static_cast<int>(detail.level_count) : 1;
}

// The size of all meshes of the entities that exist now.
RegionSize region_size(const State& s) {
  RegionSize size;
  s.entities.each<const Source, const Detail>([&](std::span<const ecs::Entity>,
                                                  std::span<const Source> sources,
                                                  std::span<const Detail> details) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      for (int level = 0; level < levels_needed(s.settings, details[i]); ++level) {
        const models::MeshSize mesh = s.facts.registry[sources[i].model].mesh_size(
            sources[i].parameters, sources[i].first_level + level);
        size.bytes +=
            s.memory->charged_bytes(mesh.layout, mesh.vertex_count, mesh.own_index_count());
        ++size.meshes;
      }
    }
  });
  return size;
}

// Wants for all meshes of the entities that exist now.
std::vector<synthesis::Want> want_everything(const State& s) {
  std::vector<synthesis::Want> wants;
  s.entities.each<const Placed, const Source, const Detail>(
      [&](std::span<const ecs::Entity> entities, std::span<const Placed> placed,
          std::span<const Source> sources, std::span<const Detail> details) {
        for (std::size_t i = 0; i < entities.size(); ++i) {
          for (int level = 0; level < levels_needed(s.settings, details[i]); ++level) {
            const synthesis::MeshKey key =
                key_of(placed[i], details[i], sources[i], static_cast<std::uint8_t>(level));
            wants.push_back({key, &sources[i].parameters, owner_of(entities[i]),
                             synthesis::Rank(synthesis::RankGroup::kDrawn, 0, 0.0F), 0.0F});
          }
        }
      });
  return wants;
}

void land_everything(State& s) {
  Settings unlimited = s.settings;
  unlimited.upload_budget_bytes = UINT64_MAX;
  synthesis_system(s.settings, s.rules, s.meshes, s.counters, s.trace);
  s.found.meshes.clear();
  upload_system(unlimited, s.rules, s.clock, s.facts, s.found, UploadQuery(s.entities), s.meshes,
                s.output, s.events.landed, s.counters, s.totals);
}

// False if it was ended early.
bool create_all_nodes(State& s, const std::function<bool()>& go_on) {
  do {
    streaming_system(s.settings, s.rules, s.camera, s.quality, s.facts, s.daylight, s.streaming,
                     s.entities, s.meshes, s.events.created, s.events.removed, s.counters);
    if (!go_on()) return false;
  } while (!s.streaming.missing.empty());
  return true;
}

}  // namespace

void Scene::tick_without_drawing(const core::CameraPose& pose, const std::function<bool()>& go_on) {
  State& s = state_;
  s.input.pose = pose;
  s.clock.real_s = s.clock.read_real_s();
  s.counters = {};
  s.rules = rules_of(s.settings, true);
  s.pressure.awaited = 0;  // nothing is drawn
  input_system(s.input, s.clock, s.facts, s.camera);
  quality_system(s.settings, s.rules, s.input, s.pressure, s.meshes, s.quality);
  daylight_system(s.clock, s.facts, DaylightQuery(s.entities), s.daylight);
  edits_system(s.daylight, s.editing, s.facts, s.entities, s.meshes, s.foresight, s.events.created,
               s.events.removed);
  streaming_system(s.settings, s.rules, s.camera, s.quality, s.facts, s.daylight, s.streaming,
                   s.entities, s.meshes, s.events.created, s.events.removed, s.counters);
  visibility_system(s.settings, s.rules, s.camera, s.facts, s.streaming,
                    VisibilityQuery(s.entities), s.view, s.counters);
  cache_system(s.settings, s.rules, s.clock, s.camera, s.quality, s.facts, s.daylight, s.streaming,
               s.view, CacheQuery(s.entities), s.assets, s.output, s.meshes, s.found, s.foresight,
               s.pressure, s.events.evicted, s.events.places_ready, s.counters);
  s.meshes.wait(go_on);
  synthesis_system(s.settings, s.rules, s.meshes, s.counters, s.trace);
  upload_system(s.settings, s.rules, s.clock, s.facts, s.found, UploadQuery(s.entities), s.meshes,
                s.output, s.events.landed, s.counters, s.totals);
  objects_system(s.settings, s.rules, s.input, s.clock, s.camera, s.quality, s.facts, s.streaming,
                 s.view, ObjectQuery(s.entities), s.meshes, s.assets, s.object_draws, s.counters);
  ++s.clock.tick;
}

std::uint64_t Scene::settle(const core::CameraPose& pose, const Progress& progress) {
  State& s = state_;
  std::uint64_t synthesised = 0;
  int quiet = 0, idle = 0, refused = 0;
  double fraction = 0;
  const auto go_on = [&] { return !progress || progress("filling the cache", fraction); };
  s.pressure = {};
  s.quality.coarsening = 1;
  s.camera.predictor.reset();  // no movement led here
  // What frames in flight may read cannot be given back before they are done, and none follows.
  if (s.output.renderer != nullptr) s.output.renderer->wait_idle();
  while (quiet < kQuietTicks && idle < kIdleTicks && refused < kRefusedTicks) {
    const float coarsening = s.quality.coarsening;
    tick_without_drawing(pose, go_on);
    synthesised += s.counters.models_synthesised;
    const bool moved = s.counters.models_synthesised > 0 || s.counters.failed > 0 ||
                       s.counters.nodes_created > 0 || s.quality.coarsening != coarsening;
    refused += s.counters.refused > 0 ? 1 : 0;
    idle = moved ? 0 : idle + 1;
    const bool complete = s.streaming.missing.empty() && !s.meshes.has_arrived();
    quiet = complete && s.counters.requests == 0 ? quiet + 1 : 0;
    const double missing = s.counters.requests + static_cast<double>(s.streaming.missing.size()) *
                                                     (1.0 + s.facts.models_per_block);
    const double made = static_cast<double>(synthesised);
    fraction = made / (made + missing + 1.0);
    if (!go_on()) break;
  }
  if (s.output.renderer != nullptr) prepare_effects(s.entities, *s.output.renderer);
  return synthesised;
}

core::Result<void> Scene::check_region() const {
  const RegionSize size = region_size(state_);
  const std::uint64_t budget_bytes = state_.meshes.stats().budget_bytes;
  if (size.bytes <= budget_bytes) return {};
  constexpr double kMiB = 1 << 20;
  return core::fail(
      core::ErrorCode::kOverBudget,
      fmt::format("amplifying the {} nodes around the camera takes {:.0f} MiB for {} meshes, more "
                  "than the budget of {:.0f} MiB; lower the view distance or raise the budget",
                  state_.entities.count<Node>(), static_cast<double>(size.bytes) / kMiB,
                  size.meshes, static_cast<double>(budget_bytes) / kMiB));
}

core::Result<std::uint64_t> Scene::amplify(const core::CameraPose& pose, const Progress& progress) {
  State& s = state_;
  s.input.pose = pose;
  s.rules = rules_of(s.settings, false);
  input_system(s.input, s.clock, s.facts, s.camera);
  quality_system(s.settings, s.rules, s.input, s.pressure, s.meshes, s.quality);
  daylight_system(s.clock, s.facts, DaylightQuery(s.entities), s.daylight);
  edits_system(s.daylight, s.editing, s.facts, s.entities, s.meshes, s.foresight, s.events.created,
               s.events.removed);
  double fraction = 0;
  const auto go_on = [&] { return !progress || progress("amplifying", fraction); };
  if (!create_all_nodes(s, go_on)) return 0;
  if (auto fits = check_region(); !fits) return tl::unexpected(fits.error());
  const std::vector<synthesis::Want> all = want_everything(s);
  constexpr std::size_t kBatch = 2048;
  std::uint64_t done = 0, failed = 0;
  for (std::size_t first = 0; first < all.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, all.size() - first);
    s.meshes.plan(std::span(all).subspan(first, count),
                  {std::numeric_limits<double>::infinity(), UINT32_MAX},
                  synthesis::Policy::kLongest);
    s.meshes.wait(go_on);
    s.counters = {};
    land_everything(s);
    done += s.counters.models_synthesised;
    failed += s.counters.failed;
    fraction = static_cast<double>(first + count) / static_cast<double>(all.size());
    if (!go_on()) return done;
  }
  if (done + failed < all.size()) {
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("only {} of {} meshes found room in the geometry memory; lower "
                                  "the view distance or raise the budget",
                                  done, all.size()));
  }
  return done;
}

}  // namespace psygen::scene
