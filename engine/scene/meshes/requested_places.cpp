#include "engine/scene/meshes/requested_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/meshes/mesh_choice.hpp"
#include "engine/scene/nodes/edits.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"

namespace psygen::scene {
namespace {

// Meshes of places go before nodes that are expected in view later than this.
constexpr float kDeadlineSeconds = 1;

// The nodes that a camera at this position would draw up to the radius.
visibility::Cut cut_at(const StreamingContext& s, const core::WorldPosition& position,
                       double radius_m) {
  const WorldFacts& facts = s.facts;
  std::vector<visibility::LevelDistances> distances;
  split_distances(facts.levels, s.frame.settings, s.camera.pixels_per_radian,
                  s.quality.error_pixels, distances);
  std::vector<visibility::NodeCoord> roots;
  visibility::Cut cut;
  visibility::select_cut(cut_input(facts.world, facts.levels, position, distances, radius_m, roots),
                         cut);
  return cut;
}

// Collects the meshes of one place.
struct Collector {
  const StreamingContext& s;
  const core::WorldPosition& position;
  ChoiceRules choice;
  std::vector<RequestedMesh>& meshes;
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
    if (const auto water = water_placement(s.facts, node.node))
      add(columns_of(s.facts, block, *water), 0, node.distance_m);
    NodeView view;
    view.level = node.node.level;
    if (view.level > 0) {
      if (!has_merged(s.facts, node.node)) return;
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
      if (level != kNoLevel) add(mesh, level, distance_m);  // otherwise too small to be drawn
    }
  }
};

core::Result<void> check(const core::WorldPosition& position, double radius_m) {
  const glm::dvec3& local = position.local;
  if (!core::is_finite(local))
    return core::invalid_argument("the position of a place is not finite");
  if (radius_m > 0 && radius_m <= kMaxReadyRadiusM) return {};
  return core::invalid_argument(
      fmt::format("the radius of a place must be above 0 and at most {} m", kMaxReadyRadiusM));
}

// Lists the nodes and meshes of a place by its position and radius.
void list(const StreamingContext& context, RequestedPlace& place) {
  place.nodes.clear();
  place.meshes.clear();
  place.sun = context.daylight;
  place.pixels_per_radian = context.camera.pixels_per_radian;
  place.stale = false;
  place.layer = context.facts.world.layer();
  const core::WorldPosition normal =
      core::normalised(place.position, context.facts.world.block_size_m());
  Collector collector{context, normal, choice_of_picture(context), place.meshes};
  for (const visibility::CutNode& node : cut_at(context, normal, place.radius_m).nodes) {
    if (!node.leaf) continue;
    place.nodes.push_back(node.node);
    collector.add_ground(node);
    collector.add_models(node);
  }
  place.readiness.meshes = static_cast<std::uint32_t>(place.meshes.size());
}

// Updates the ground of a place to the present sun.
void light(const StreamingContext& context, RequestedPlace& place) {
  const Daylight& sun = context.daylight;
  if (std::exchange(place.sun, sun) == sun) return;
  const models::ModelType& terrain = context.facts.registry[context.facts.world.terrain_model];
  for (RequestedMesh& mesh : place.meshes) {
    if (mesh.key.model != context.facts.world.terrain_model) continue;
    world::set_sun(mesh.parameters, sun.azimuth_deg, sun.elevation_deg);
    mesh.key.parameters_hash = models::parameters_hash(terrain, mesh.parameters);
  }
}

bool is_there(const synthesis::MeshSupply& meshes, const synthesis::MeshKey& key) {
  const synthesis::MeshRecord* record = meshes.get(meshes.find(key));
  // Failed meshes are not waited for.
  return record != nullptr && (record->state == synthesis::MeshState::kReady ||
                               record->state == synthesis::MeshState::kFailed);
}

synthesis::Want want_of(const RequestedMesh& mesh) {
  const auto rank = synthesis::Rank::by_deadline(kDeadlineSeconds, mesh.distance_m);
  return {mesh.key, &mesh.parameters, owner_of(ecs::kNullEntity), rank, kDeadlineSeconds, false};
}

// Marks a place whose nodes an edit has changed since it was listed. Otherwise its parameters refer
// to the present edit layer from now on.
void sync_edits(const WorldFacts& facts, RequestedPlace& place) {
  if (place.stale || place.layer == facts.world.layer()) return;
  const LayerChange change(facts.world, place.layer, facts.world.layer());
  place.stale = std::ranges::any_of(place.nodes, [&](const visibility::NodeCoord& node) {
    const NodeChange of = change.of(node);
    return of.ground || of.models;
  });
  if (place.stale) return;
  place.layer = facts.world.layer();
  for (RequestedMesh& mesh : place.meshes) {
    if (mesh.parameters.edits() != nullptr)
      mesh.parameters.set_edits(place.layer.get(), mesh.parameters.edits_hash());
  }
}

}  // namespace

const RequestedPlace* RequestedPlaces::find(PlaceId id) const {
  const auto found = std::ranges::find(places, id, &RequestedPlace::id);
  return found == places.end() ? nullptr : &*found;
}

core::Result<RequestedPlace> place_at(const StreamingContext& context,
                                      const core::WorldPosition& position, double radius_m) {
  if (const auto ok = check(position, radius_m); !ok) return tl::unexpected(ok.error());
  RequestedPlace place;
  place.position = position;
  place.radius_m = radius_m;
  list(context, place);
  return place;
}

Readiness readiness_of(std::span<const RequestedMesh> meshes, const synthesis::MeshSupply& supply,
                       std::uint32_t modelers) {
  Readiness result;
  result.meshes = static_cast<std::uint32_t>(meshes.size());
  for (const RequestedMesh& mesh : meshes) {
    if (is_there(supply, mesh.key)) continue;
    ++result.missing;
    result.expected_s += supply.predict(want_of(mesh)) / modelers;
  }
  return result;
}

void release_place(PlaceId id, RequestedPlaces& requested, synthesis::MeshSupply& supply) {
  const RequestedPlace* place = requested.find(id);
  if (place == nullptr) return;
  for (const RequestedMesh& mesh : place->meshes) {
    const synthesis::MeshHandle handle = supply.find(mesh.key);
    const synthesis::MeshRecord* record = supply.get(handle);
    if (record != nullptr && record->rank == want_of(mesh).rank)
      supply.rank(handle, synthesis::Rank::unwanted());
  }
  std::erase_if(requested.places, [id](const RequestedPlace& other) { return other.id == id; });
}

void update_requested_places(const StreamingContext& context, RequestedPlaces& requested,
                             synthesis::MeshSupply& supply, ecs::EventQueue<PlaceReady>& ready) {
  for (RequestedPlace& place : requested.places) {
    sync_edits(context.facts, place);
    if (place.stale || place.pixels_per_radian != context.camera.pixels_per_radian)
      list(context, place);
    light(context, place);
    place.readiness.missing = 0;
    place.readiness.expected_s = 0;
    for (const RequestedMesh& mesh : place.meshes) {
      const synthesis::Want want = want_of(mesh);
      const synthesis::MeshHandle handle = supply.find(mesh.key);
      const synthesis::MeshRecord* record = supply.get(handle);
      if (record != nullptr && record->state == synthesis::MeshState::kReady) {
        // An entity that draws it ranks it. The place keeps meshes that no entity wants any more.
        const bool free = record->rank == synthesis::Rank::unwanted();
        if (free || record->owner == want.owner) supply.rank(handle, want.rank);
      } else if (record == nullptr || record->state != synthesis::MeshState::kFailed) {
        ++place.readiness.missing;
        place.readiness.expected_s += supply.predict(want) / context.frame.settings.modelers;
        supply.want(want);
      }
    }
    if (place.readiness.ready() && !std::exchange(place.told, true)) ready.emit({place.id});
  }
}

}  // namespace psygen::scene
