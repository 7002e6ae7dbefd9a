// Work before the first frame: filling the cache for a pose, or amplifying a region.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/core/rounding.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/state.hpp"

namespace psygen::scene {
namespace {

// Nodes around the camera are visited every 8th tick, so no mesh is missing after 9 quiet ones.
constexpr int kQuietTicks = 9;
// Filling ends after 40 ticks in a row in which no mesh became ready, or after 300 ticks in which a
// request found no memory.
constexpr int kIdleTicks = 40, kRefusedTicks = 300;

// Makes the pipelines of lights and particles, so that the first frame does not wait for them. The
// first frame reports failures.
void prepare_effects(const ecs::World& entities, render::Renderer& renderer) {
  if (entities.count<PointLight>() > 0)
    static_cast<void>(renderer.prepare(render::Feature::kPointLights));
  if (entities.count<ParticleEmitter>() > 0)
    static_cast<void>(renderer.prepare(render::Feature::kParticles));
}

// Wants for all meshes of the existing entities, finest levels first.
std::vector<synthesis::Want> want_everything(const State& s) {
  std::vector<synthesis::Want> wants;
  s.entities.each<const MeshPlacement, const MeshSource, const LodErrors>(
      [&](auto entities, auto placed, auto sources, auto details) {
        for (std::size_t i = 0; i < entities.size(); ++i) {
          const int levels = s.settings.levels_of_detail ? details[i].level_count : 1;
          for (int level = 0; level < levels; ++level) {
            const synthesis::MeshKey key =
                key_of(placed[i], details[i], sources[i], static_cast<std::uint8_t>(level));
            wants.push_back({key, &sources[i].parameters, owner_of(entities[i]),
                             synthesis::Rank(synthesis::RankGroup::kDrawn, 0, 0.0F), 0.0F});
          }
        }
      });
  return wants;
}

void upload_everything(State& s) {
  SceneSettings unlimited = s.settings;
  unlimited.upload_budget_bytes = UINT64_MAX;
  synthesis_system(s.frame(), s.supply, s.meshes, s.trace);
  s.meshes.found.clear();
  upload_system({unlimited, s.rules, s.clock}, s.facts, UploadQuery(s.entities), s.upload_work());
}

// Returns false if `go_on` stopped it.
bool create_all_nodes(State& s, const std::function<bool()>& go_on) {
  do {
    streaming_system(s.streaming_context(), s.streaming, s.patches, s.node_work());
    if (!go_on()) return false;
  } while (!s.streaming.missing.empty());
  return true;
}

// The systems up to edits.
void begin_tick(State& s) {
  input_system(s.input, s.clock, s.facts, s.camera);
  quality_system(s.frame(), s.input, s.pressure, s.supply, s.quality);
  daylight_system(s.clock, s.facts, DaylightQuery(s.entities), s.daylight);
  edits_system(s.daylight, s.pending_edits, s.facts, s.node_work());
}

void tick_without_drawing(State& s, const core::CameraPose& pose,
                          const std::function<bool()>& go_on) {
  s.input.pose = pose;
  s.clock.real_s = s.clock.read_real_s();
  reset_counts(s);
  s.rules = rules_of(s.settings, true);
  s.pressure.awaited = 0;  // nothing is drawn
  begin_tick(s);
  streaming_system(s.streaming_context(), s.streaming, s.patches, s.node_work());
  visibility_system(s.frame(), s.camera, s.facts, s.streaming, VisibilityQuery(s.entities), s.view);
  cache_system(s.streaming_context(), {s.streaming, s.view}, s.assets, CacheQuery(s.entities),
               s.cache_work());
  s.supply.help(go_on);
  synthesis_system(s.frame(), s.supply, s.meshes, s.trace);
  upload_system(s.frame(), s.facts, UploadQuery(s.entities), s.upload_work());
  objects_system(s.render_context(), ObjectQuery(s.entities), {s.supply, s.assets, s.object_draws});
  ++s.clock.tick;
}

// Fails if all these meshes do not fit into the budget.
core::Result<void> check_region(const State& s, std::span<const synthesis::Want> meshes) {
  std::uint64_t bytes = 0;
  for (const synthesis::Want& mesh : meshes)
    bytes += bytes_of(mesh.key, *mesh.parameters, s);
  const std::uint64_t budget_bytes = s.supply.stats().budget_bytes;
  if (bytes <= budget_bytes) return {};
  constexpr double kMiB = 1 << 20;
  return core::fail(
      core::ErrorCode::kOverBudget,
      fmt::format("amplifying the {} nodes around the camera takes {:.0f} MiB for {} meshes, more "
                  "than the budget of {:.0f} MiB; lower the view distance or raise the budget",
                  s.entities.count<QuadtreeNode>(), static_cast<double>(bytes) / kMiB,
                  meshes.size(), static_cast<double>(budget_bytes) / kMiB));
}

}  // namespace

std::uint64_t Scene::settle(const core::CameraPose& pose, const Progress& progress) {
  const core::RoundToNearest rounding;
  State& s = *state_;
  std::uint64_t synthesised = 0;
  int quiet = 0, idle = 0, refused = 0;
  bool tried_again = false;
  float first_try = std::numeric_limits<float>::infinity();  // its coarsening
  double fraction = 0;
  const auto go_on = [&] { return !progress || progress("filling the cache", fraction); };
  s.pressure = {};
  s.quality.coarsening = 1;
  s.camera.predictor.reset();  // no movement led here
  // The cache cannot reuse memory that frames in flight may read, and no frame will follow.
  if (s.output.renderer != nullptr) s.output.renderer->wait_idle();
  while (quiet < kQuietTicks && idle < kIdleTicks && refused < kRefusedTicks) {
    const float coarsening = s.quality.coarsening;
    tick_without_drawing(s, pose, go_on);
    const MeshCounts& made = s.meshes.counts;
    synthesised += made.models_synthesised;
    const bool moved = made.models_synthesised > 0 || made.failed > 0 ||
                       s.streaming.counts.created > 0 || s.quality.coarsening != coarsening;
    refused += made.refused > 0 ? 1 : 0;
    idle = moved ? 0 : idle + 1;
    const bool complete = s.streaming.missing.empty() && !s.supply.has_arrived();
    quiet = complete && made.requests == 0 ? quiet + 1 : 0;
    const double missing = made.requests + static_cast<double>(s.streaming.missing.size()) *
                                               (1.0 + s.facts.models_per_block);
    const double done = static_cast<double>(synthesised);
    fraction = done / (done + missing + 1.0);
    if (!go_on()) break;
    // Memory may have been short only until the meshes of another place were evicted: tries full
    // detail once more, and returns if that is no better.
    if (quiet == kQuietTicks && !tried_again && s.quality.coarsening > 1) {
      tried_again = true;
      quiet = refused = 0;
      first_try = std::exchange(s.quality.coarsening, 1.0F);
    } else if (tried_again && s.quality.coarsening > first_try) {
      quiet = 0;
      s.quality.coarsening = std::exchange(first_try, std::numeric_limits<float>::infinity());
    }
  }
  if (s.output.renderer != nullptr) prepare_effects(s.entities, *s.output.renderer);
  return synthesised;
}

core::Result<std::uint64_t> Scene::amplify(const core::CameraPose& pose, const Progress& progress) {
  const core::RoundToNearest rounding;
  State& s = *state_;
  s.input.pose = pose;
  s.rules = rules_of(s.settings, false);
  s.rules.request = false;  // all nodes are created before anything is requested
  begin_tick(s);
  double fraction = 0;
  const auto go_on = [&] { return !progress || progress("amplifying", fraction); };
  if (!create_all_nodes(s, go_on)) return 0;
  const std::vector<synthesis::Want> all = want_everything(s);
  if (auto fits = check_region(s, all); !fits) return tl::unexpected(fits.error());
  constexpr std::size_t kBatch = 2048;
  std::uint64_t done = 0, failed = 0;
  for (std::size_t first = 0; first < all.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, all.size() - first);
    s.supply.plan(std::span(all).subspan(first, count),
                  {std::numeric_limits<double>::infinity(), UINT32_MAX},
                  synthesis::Policy::kLongest);
    s.supply.help(go_on);
    reset_counts(s);
    upload_everything(s);
    done += s.meshes.counts.models_synthesised;
    failed += s.meshes.counts.failed;
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
