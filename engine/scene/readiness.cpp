#include "engine/scene/readiness.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/scene/nodes/columns.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/quality/mesh_choice.hpp"
#include "engine/scene/state.hpp"

namespace psygen::scene {
namespace {

// Meshes of places come before nodes that a camera is expected to see later than this.
constexpr float kDeadlineSeconds = 1;
constexpr double kMaxShare = 0.5;  // of the memory for meshes

// The nodes that a camera at the position would draw up to the radius.
visibility::Cut cut_at(const PlaceRules& s, const core::WorldPosition& position, double radius_m) {
  const WorldFacts& facts = s.facts;
  const auto top = static_cast<std::uint8_t>(facts.levels.size() - 1);
  std::vector<visibility::LevelDistances> distances;
  split_distances(facts.levels, s.settings, s.camera.pixels_per_radian, s.quality.error_pixels,
                  distances);
  visibility::CutInput input;
  input.camera = position;
  input.block_size_m = facts.world.block_size_m();
  input.levels = distances;
  input.view_distance_m = radius_m;
  input.world = {{},
                 static_cast<std::uint32_t>(facts.world.blocks_x),
                 static_cast<std::uint32_t>(facts.world.blocks_z)};
  std::vector<visibility::NodeCoord> roots;
  visibility::roots_around(position, input.block_size_m, radius_m, top, roots, input.world);
  input.roots = roots;
  visibility::Cut cut;
  visibility::select_cut(input, cut);
  return cut;
}

// Collects the meshes of one place.
struct Collector {
  const PlaceRules& s;
  const core::WorldPosition& position;
  ChoiceRules choice;
  std::vector<Foresight::Mesh>& meshes;
  std::vector<world::Placement> scratch = {};

  void add(const MeshColumns& mesh, std::uint8_t level, float distance_m) {
    meshes.push_back(
        {key_of(mesh.placed, mesh.detail, mesh.source, level), mesh.source.parameters, distance_m});
  }

  void add_ground(const visibility::CutNode& node) {
    models::Parameters ground = node_terrain(s.facts.world, node.node);
    world::set_sun(ground, s.daylight.azimuth_deg, s.daylight.elevation_deg);
    const int level = node.fine ? 0 : s.facts.levels[node.node.level].mesh_level;
    add(columns_of(s.facts, visibility::corner_block(node.node),
                   {s.facts.world.terrain_model, kTerrainIndex, glm::vec3(0.0F), ground}, level,
                   level),
        0, node.distance_m);
  }

  void add_models(const visibility::CutNode& node) {
    const core::BlockCoord block = visibility::corner_block(node.node);
    NodeView view;
    view.level = node.node.level;
    if (view.level > 0) {
      if (!s.facts.levels[view.level].merged) return;
      const MeshColumns mesh = columns_of(s.facts, block, merged_placement(s.facts, node.node));
      return add(mesh, model_level(choice, view, mesh.detail, 0, node.distance_m, kNoLevel),
                 node.distance_m);
    }
    world::place_models(s.facts.world, s.facts.registry, block, scratch);
    const glm::vec3 corner(core::offset_m(block, position, s.facts.world.block_size_m()));
    const float near_m = s.camera.projection.near_m;
    for (const world::Placement& model : scratch) {
      const MeshColumns mesh = columns_of(s.facts, block, model);
      const float distance_m = distance_to(mesh.placed, corner + model.position, near_m);
      const float pixels =
          size_pixels(mesh.placed, mesh.detail, distance_m, choice.pixels_per_radian, near_m);
      const std::uint8_t level =
          model_level(choice, view, mesh.detail, pixels, distance_m, kNoLevel);
      if (level != kNoLevel) add(mesh, level, distance_m);  // else it is too small to be drawn
    }
  }
};

core::Result<void> check(const core::WorldPosition& position, double radius_m) {
  const glm::dvec3& local = position.local;
  if (!core::is_finite(local))
    return core::fail(core::ErrorCode::kInvalidArgument, "the position of a place is not finite");
  if (radius_m > 0 && radius_m <= kMaxReadyRadiusM) return {};
  return core::fail(
      core::ErrorCode::kInvalidArgument,
      fmt::format("the radius of a place must be above 0 and at most {} m", kMaxReadyRadiusM));
}

PlaceRules rules_for(const State& s) {
  return {s.settings, s.facts, s.camera, s.quality, s.daylight};
}

// Lists the nodes and meshes of a place by its position and radius.
void list(const PlaceRules& rules, Foresight::Place& place) {
  place.nodes.clear();
  place.meshes.clear();
  place.sun_azimuth_deg = rules.daylight.azimuth_deg;
  place.sun_elevation_deg = rules.daylight.elevation_deg;
  place.pixels_per_radian = rules.camera.pixels_per_radian;
  place.stale = false;
  const core::WorldPosition normal =
      core::normalised(place.position, rules.facts.world.block_size_m());
  Collector collector{rules, normal,
                      choice_of_picture(rules.settings, rules.camera, rules.quality, rules.facts),
                      place.meshes};
  for (const visibility::CutNode& node : cut_at(rules, normal, place.radius_m).nodes) {
    if (!node.leaf) continue;
    place.nodes.push_back(node.node);
    collector.add_ground(node);
    collector.add_models(node);
  }
  place.readiness.meshes = static_cast<std::uint32_t>(place.meshes.size());
}

core::Result<Foresight::Place> place_at(const State& s, const core::WorldPosition& position,
                                        double radius_m) {
  if (const auto ok = check(position, radius_m); !ok) return tl::unexpected(ok.error());
  Foresight::Place place;
  place.position = position;
  place.radius_m = radius_m;
  list(rules_for(s), place);
  return place;
}

// The ground of a place under the present sun.
void light(const PlaceRules& rules, Foresight::Place& place) {
  const Daylight& sun = rules.daylight;
  if (place.sun_azimuth_deg == sun.azimuth_deg && place.sun_elevation_deg == sun.elevation_deg)
    return;
  place.sun_azimuth_deg = sun.azimuth_deg;
  place.sun_elevation_deg = sun.elevation_deg;
  const models::ModelType& terrain = rules.facts.registry[rules.facts.world.terrain_model];
  for (Foresight::Mesh& mesh : place.meshes) {
    if (mesh.key.model != rules.facts.world.terrain_model) continue;
    world::set_sun(mesh.parameters, sun.azimuth_deg, sun.elevation_deg);
    mesh.key.parameters_hash = models::parameters_hash(terrain, mesh.parameters);
  }
}

bool is_there(const synthesis::MeshSupply& meshes, const synthesis::MeshKey& key) {
  const synthesis::MeshRecord* record = meshes.get(meshes.find(key));
  // What cannot be made is not waited for.
  return record != nullptr && (record->state == synthesis::MeshState::kReady ||
                               record->state == synthesis::MeshState::kFailed);
}

synthesis::Want want_of(const Foresight::Mesh& mesh) {
  const auto rank = synthesis::Rank::by_deadline(kDeadlineSeconds, mesh.distance_m);
  return {mesh.key, &mesh.parameters, owner_of(ecs::kNullEntity), rank, kDeadlineSeconds, false};
}

std::uint64_t bytes_of(const State& s, std::span<const Foresight::Mesh> meshes) {
  std::uint64_t bytes = 0;
  for (const Foresight::Mesh& mesh : meshes) {
    const models::MeshSize size =
        s.facts.registry[mesh.key.model].mesh_size(mesh.parameters, mesh.key.level);
    bytes += s.memory->charged_bytes(size.layout, size.vertex_count, size.own_index_count());
  }
  return bytes;
}

const Foresight::Place* find(const Foresight& foresight, PlaceId id) {
  const auto found = std::ranges::find(foresight.places, id, &Foresight::Place::id);
  return found == foresight.places.end() ? nullptr : &*found;
}

}  // namespace

core::Result<Readiness> readiness(const State& state, const core::WorldPosition& position,
                                  double radius_m) {
  const auto place = place_at(state, position, radius_m);
  if (!place) return tl::unexpected(place.error());
  Readiness result = place->readiness;
  for (const Foresight::Mesh& mesh : place->meshes) {
    if (is_there(state.meshes, mesh.key)) continue;
    ++result.missing;
    result.expected_s += state.meshes.predict(want_of(mesh)) / state.settings.modelers;
  }
  return result;
}

core::Result<PlaceId> ask_ready(State& state, const core::WorldPosition& position,
                                double radius_m) {
  auto place = place_at(state, position, radius_m);
  if (!place) return tl::unexpected(place.error());
  place->bytes = bytes_of(state, place->meshes);
  std::uint64_t all = place->bytes;
  for (const Foresight::Place& other : state.foresight.places)
    all += other.bytes;
  constexpr double kMiB = 1 << 20;
  const double most = kMaxShare * static_cast<double>(state.meshes.stats().budget_bytes);
  if (static_cast<double>(all) > most) {
    return core::fail(
        core::ErrorCode::kOverBudget,
        fmt::format("{:.0f} MiB are needed for a place of {:g} m, with all places {:.0f} MiB; half "
                    "of the budget, {:.0f} MiB, is allowed",
                    static_cast<double>(place->bytes) / kMiB, radius_m,
                    static_cast<double>(all) / kMiB, most / kMiB));
  }
  place->id = ++state.foresight.last_id;
  place->readiness.missing = place->readiness.meshes;
  return state.foresight.places.emplace_back(std::move(*place)).id;
}

Readiness readiness(const State& state, PlaceId id) {
  const Foresight::Place* place = find(state.foresight, id);
  return place != nullptr ? place->readiness : Readiness{};
}

void stop_asking(State& state, PlaceId id) {
  const Foresight::Place* place = find(state.foresight, id);
  if (place == nullptr) return;
  for (const Foresight::Mesh& mesh : place->meshes) {
    const synthesis::MeshHandle handle = state.meshes.find(mesh.key);
    const synthesis::MeshRecord* record = state.meshes.get(handle);
    if (record != nullptr && record->rank == want_of(mesh).rank)
      state.meshes.rank(handle, synthesis::Rank::unwanted());
  }
  std::erase_if(state.foresight.places, [id](const auto& asked) { return asked.id == id; });
}

void want_places(const PlaceRules& rules, Foresight& foresight, synthesis::MeshSupply& meshes,
                 ecs::EventQueue<PlaceReady>& ready) {
  for (Foresight::Place& place : foresight.places) {
    if (place.stale || place.pixels_per_radian != rules.camera.pixels_per_radian)
      list(rules, place);
    light(rules, place);
    place.readiness.missing = 0;
    place.readiness.expected_s = 0;
    for (const Foresight::Mesh& mesh : place.meshes) {
      const synthesis::Want want = want_of(mesh);
      const synthesis::MeshHandle handle = meshes.find(mesh.key);
      const synthesis::MeshRecord* record = meshes.get(handle);
      if (record != nullptr && record->state == synthesis::MeshState::kReady) {
        // Whoever draws it ranks it; what nobody wants any more is kept for the place.
        const bool free = record->rank == synthesis::Rank::unwanted();
        if (free || record->owner == want.owner) meshes.rank(handle, want.rank);
      } else if (record == nullptr || record->state != synthesis::MeshState::kFailed) {
        ++place.readiness.missing;
        place.readiness.expected_s += meshes.predict(want) / rules.settings.modelers;
        meshes.want(want);
      }
    }
    if (place.readiness.ready() && !std::exchange(place.told, true)) ready.emit({place.id});
  }
}

}  // namespace psygen::scene
