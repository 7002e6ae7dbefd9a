#include "engine/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/clock.hpp"
#include "engine/core/heap_geometry_memory.hpp"
#include "engine/scene/lighting.hpp"
#include "engine/scene/mesh_notes.hpp"
#include "engine/scene/node_solidity.hpp"
#include "engine/scene/systems.hpp"
#include "engine/scene/usual_boxes.hpp"
#include "engine/world/merged_models.hpp"

namespace psygen::scene {
namespace {

// Of the parameters with a range, so many are tried at both ends together.
constexpr std::size_t kMaxVaried = 12;

core::Result<void> check(const Settings& settings) {
  const auto refuse = [](std::string sentence) {
    return core::fail(core::ErrorCode::kInvalidArgument, std::move(sentence));
  };
  if (!(settings.view_distance_m >= 32 && settings.view_distance_m <= 65536)) {
    return refuse("view distance must be between 32 and 65536 m");
  }
  if (!(settings.max_error_pixels > 0 && settings.max_error_pixels <= 1000)) {
    return refuse("the error of levels of detail must be above 0 and at most 1000 pixels");
  }
  if (!(settings.target_frame_ms >= 0 && settings.target_frame_ms <= 10'000)) {
    return refuse("the target of the frame time must be between 0 and 10000 ms");
  }
  if (!(settings.max_error_factor >= 1 && settings.max_error_factor <= 100)) {
    return refuse("the error may grow by a factor between 1 and 100");
  }
  if (!(settings.fade_seconds >= 0 && settings.fade_seconds <= 60)) {
    return refuse("models come and go within 0 to 60 seconds");
  }
  if (settings.streaming_ticks < 1) return refuse("nodes are created over at least one tick");
  if (settings.modelers > 256) return refuse("there may be at most 256 modelers");
  if (settings.budget_bytes < Scene::kMinBudgetBytes) {
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("a budget of {} bytes is too small; at least {} bytes are needed",
                                  settings.budget_bytes, Scene::kMinBudgetBytes));
  }
  return {};
}

// Nodes and models that exist at once at most, before anything is allocated for them. Nodes of a
// level lie in a disc.
core::Result<void> check_size(const world::World& world, const models::Registry& registry,
                              const Settings& settings) {
  const std::vector<NodeLevel> levels = node_levels(world, registry, settings, nullptr);
  const double models = static_cast<double>(world::models_per_block(world));
  double entities = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double radius = window_radius(levels, settings, k);
    entities += std::numbers::pi * radius * radius * (k == 0 ? 1 + models : 2);
  }
  if (entities <= Scene::kMaxEntities) return {};
  return core::fail(
      core::ErrorCode::kOverBudget,
      fmt::format(
          "a view of {:.0f} m over blocks of {:g} m (block_vertices, cell_m) with {} models "
          "each (count) needs {:.3g} entities; at most {:.0f} are allowed",
          settings.view_distance_m, world.block_size_m(), world::models_per_block(world), entities,
          Scene::kMaxEntities));
}

// How far models may reach from their foot, sideways and up: the largest boxes over the corners of
// their ranges.
glm::vec2 models_reach(const world::World& world, const models::Registry& registry) {
  glm::vec2 reach_m(0.0F);
  for (const world::Scatter& scatter : world.scatter) {
    const models::ModelType& type = registry[scatter.model];
    const auto specs = type.parameters();
    std::vector<std::size_t> ranged;
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (scatter.ranges[i].low != scatter.ranges[i].high) ranged.push_back(i);
    }
    const std::size_t varied = std::min(ranged.size(), kMaxVaried);
    for (std::uint32_t corner = 0; corner < (1u << varied); ++corner) {
      models::Parameters p = world::scatter_parameters(registry, scatter);
      for (std::size_t k = 0; k < varied; ++k) {
        const world::ParameterRange& range = scatter.ranges[ranged[k]];
        world::set_parameter(type, p, ranged[k], (corner >> k & 1) != 0 ? range.high : range.low);
      }
      const auto steepest =
          static_cast<float>(std::tan(scatter.max_slope_deg * std::numbers::pi / 180));
      world::set_slope(type, world::slope_parameters(type), glm::vec2(steepest), p);
      const core::Bounds box = type.bounds(p);
      reach_m.x = std::max({reach_m.x, -box.min.x, -box.min.z, box.max.x, box.max.z});
      reach_m.y = std::max(reach_m.y, box.max.y);
    }
  }
  return reach_m;
}

// The levels of the quadtree, and the type of the meshes that stand for everything on a node.
core::Result<void> find_levels(const Settings& settings, WorldFacts& facts) {
  const models::ModelType* merged = nullptr;
  if (settings.levels_of_detail && world::models_per_block(facts.world) > 0) {
    const auto world = std::make_shared<const world::World>(facts.world);
    const auto added = facts.registry.add(world::make_merged_type(world, facts.registry));
    if (!added) return tl::unexpected(added.error());
    facts.merged_model = *added;
    merged = &facts.registry[*added];
  }
  facts.levels = node_levels(facts.world, facts.registry, settings, merged);
  const auto size = static_cast<int>(facts.world.terrain.integer(models::kTerrainSize));
  for (int level = 0; level < models::kTerrainLevels; ++level)
    facts.grids.emplace_back(size, level);
  if (facts.levels[0].mesh_level != 0) facts.tiles.emplace(size);
  const world::FarCover cover = world::far_cover(facts.world, facts.registry);
  facts.canopy = canopy_of(facts.world, cover.albedo);
  facts.cover_share = cover.share;
  return {};
}

// Of the models of a block, and of all that nodes draw.
std::vector<synthesis::CostSample> cost_samples(const WorldFacts& facts) {
  std::vector<world::Placement> placements;
  const core::BlockCoord block{};
  world::place_models(facts.world, facts.registry, block, placements);
  std::vector<synthesis::CostSample> samples;
  for (std::size_t k = 0; k < facts.levels.size(); ++k) {
    const visibility::NodeCoord node{block, static_cast<std::uint8_t>(k)};
    samples.push_back({facts.world.terrain_model, node_terrain(facts.world, node)});
    if (facts.levels[k].merged)
      samples.push_back({facts.merged_model, world::merged_parameters(block, static_cast<int>(k))});
  }
  constexpr std::size_t kPerType = 24;
  std::vector<std::size_t> taken(facts.registry.size(), 0);
  for (const world::Placement& placement : placements) {
    if (taken[placement.model]++ < kPerType) {
      samples.push_back({placement.model, placement.parameters});
    }
  }
  return samples;
}

// Without ground and what is merged, of which it is known how near they are.
std::vector<synthesis::CostSample> single_models(const WorldFacts& facts,
                                                 std::vector<synthesis::CostSample> samples) {
  std::erase_if(samples, [&](const synthesis::CostSample& sample) {
    return sample.model == facts.world.terrain_model ||
           (facts.merged_model != 0 && sample.model == facts.merged_model);
  });
  return samples;
}

Tracing tracing_of(telemetry::TraceLog* log, std::uint32_t modelers,
                   const models::Registry& registry, const ecs::Schedule& tick) {
  Tracing tracing;
  if (log == nullptr) return tracing;
  tracing.log = log;
  tracing.main = log->add_track("main thread");
  tracing.cache_bytes = log->add_counter("cache bytes");
  tracing.requests = log->add_counter("requests");
  tracing.gpu_ms = log->add_counter("device ms");
  tracing.device_wait = log->intern("wait for the device");
  tracing.acquire = log->intern("wait for the window");
  tracing.present = log->intern("present");
  for (const ecs::SystemInfo& system : tick.systems())
    tracing.systems.push_back(log->intern(system.name));
  for (std::uint32_t i = 0; i < modelers; ++i) {
    tracing.modelers.push_back(log->add_track(fmt::format("modeler {}", i)));
  }
  for (models::ModelIndex i = 0; i < registry.size(); ++i) {
    tracing.models.push_back(log->intern(registry[i].name()));
  }
  return tracing;
}

}  // namespace

Scene::~Scene() {
  // Modelers write into the cache's memory: they end first.
  state_.synthesis.manager.reset();
  state_.synthesis.planner.reset();
  state_.synthesis.cache.reset();
}

core::Result<std::unique_ptr<Scene>> Scene::create(world::World world, models::Registry registry,
                                                   const Settings& settings,
                                                   render::Renderer* renderer,
                                                   telemetry::TraceLog* trace,
                                                   const Progress& progress) {
  if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_size(world, registry, settings); !ok) return tl::unexpected(ok.error());
  std::unique_ptr<Scene> scene(new Scene);
  State& s = scene->state_;
  s.settings = settings;
  s.clock.origin_s = core::monotonic_seconds();
  WorldFacts& facts = s.facts;
  facts.world = std::move(world);
  facts.registry = std::move(registry);
  facts.light = light_of(facts.world, settings.view_distance_m);
  facts.palette = palette_of(facts.world);
  facts.models_per_block = static_cast<std::uint32_t>(world::models_per_block(facts.world));
  facts.cell_m = static_cast<float>(facts.world.cell_m());
  facts.models_reach_m = models_reach(facts.world, facts.registry);
  facts.standing = standing_on_block(facts.world, facts.registry);

  if (auto ok = find_levels(settings, facts); !ok) return tl::unexpected(ok.error());
  for (std::size_t k = 0; k < facts.levels.size(); ++k) {
    s.streaming.grids.emplace_back(static_cast<std::uint8_t>(k),
                                   window_radius(facts.levels, settings, k));
  }
  s.output.renderer = renderer;
  facts.shadows = renderer != nullptr && renderer->casts_shadows();
  if (renderer == nullptr) {
    s.heap = std::make_unique<core::HeapGeometryMemory>(settings.budget_bytes);
  }
  s.memory = renderer != nullptr ? &renderer->geometry() : s.heap.get();
  Synthesis& synthesis = s.synthesis;
  synthesis.cache =
      std::make_unique<synthesis::GeometryCache>(*s.memory, facts.registry, settings.budget_bytes);
  synthesis.cost = std::make_unique<synthesis::CostModel>(facts.registry);
  const std::vector<synthesis::CostSample> samples = cost_samples(facts);
  facts.usual_boxes = usual_boxes(facts.registry, single_models(facts, samples));
  scene->calibration_ = synthesis.cost->calibrate(samples, {}, [&](double fraction) {
    if (progress) (void)progress("calibrating", fraction);
  });
  synthesis.planner = std::make_unique<synthesis::Planner>();
  synthesis::SynthesisOptions options;
  options.modelers = settings.modelers;
  options.watchdog_seconds = settings.watchdog_seconds;
  options.annotate = mesh_notes(facts);
  synthesis.manager = std::make_unique<synthesis::SynthesisManager>(facts.registry, options);
  s.settings.modelers = synthesis.manager->modeler_count();
  s.quality.governor =
      Governor({.target_ms = settings.target_frame_ms, .max_factor = settings.max_error_factor});
  build_tick(s);
  s.trace = tracing_of(trace, s.settings.modelers, facts.registry, s.tick);
  return scene;
}

}  // namespace psygen::scene
