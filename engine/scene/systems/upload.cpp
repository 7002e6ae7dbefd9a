// Makes finished meshes resident and lands them in their entities. Where memory is shared with the
// device the modeler has already written the final bytes, and this is only book-keeping: what must
// be known of a mesh comes with it (mesh_notes.hpp).
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/assert.hpp"
#include "engine/core/log.hpp"
#include "engine/scene/draws/fading.hpp"
#include "engine/scene/mesh_notes.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/systems.hpp"
#include "engine/scene/tree_pictures.hpp"

namespace psygen::scene {
namespace {

// In place of the list of a block's finest ground: that of its tiles. No type names a list so.
constexpr std::uint32_t kTiles = UINT32_MAX;

std::vector<std::uint16_t> index_list(const synthesis::MeshRecord& record, const WorldFacts& facts,
                                      bool tiled) {
  std::vector<std::uint16_t> list(tiled ? facts.tiles->index_count() : record.size.index_count);
  if (tiled) {
    facts.tiles->write_indices(list);
  } else {
    facts.registry[record.key.model].write_shared_indices(record.size.shared_indices, list);
  }
  return list;
}

std::uint32_t shared_indices_of(const synthesis::MeshRecord& record, const WorldFacts& facts,
                                Output& output) {
  if (record.size.shared_indices == 0) return render::kNoSharedIndices;
  const bool tiled =
      facts.tiles && record.key.model == facts.world.terrain_model && record.key.level == 0;
  const std::uint64_t key =
      (std::uint64_t{record.key.model} << 32) | (tiled ? kTiles : record.size.shared_indices);
  SharedIndices& shared = output.shared_indices;
  const auto known = shared.find(key);
  if (known != shared.end()) return known->second;
  std::uint32_t name = static_cast<std::uint32_t>(shared.size()) + 1;
  if (output.renderer != nullptr) {
    const std::vector<std::uint16_t> list = index_list(record, facts, tiled);
    const auto uploaded = output.renderer->upload_shared_indices(list);
    if (!uploaded) {
      core::log_error(fmt::format("index list not uploaded: {}", uploaded.error().message));
      return render::kNoSharedIndices;
    }
    name = *uploaded;
  }
  shared.emplace(key, name);
  return name;
}

// Whether an entity has a use for a mesh of this level now; if so, notes that it has it. `fresh`:
// it is of the entity's present parameters.
bool accept(Demand& demand, std::uint8_t level, bool fresh, double now_s, Counters& counters) {
  const bool asked_for = level == demand.requested_level && fresh;
  if (!asked_for && demand.drawn_level != kNoLevel) return false;
  demand.drawn_level = level;
  demand.stale = !fresh;
  demand.ranked = kNotRanked;
  if (asked_for) demand.requested_level = kNoLevel;
  if (demand.seen_s >= 0) {
    counters.time_to_visible_ms.push_back((static_cast<float>(now_s) - demand.seen_s) * 1000.0F);
    demand.seen_s = -1;
  }
  return true;
}

void give_up(const synthesis::Completion& job, const UploadQuery& entities, Totals& totals) {
  if (job.late) return;  // it was given up before
  if (totals.failed++ == 0) {
    core::log_warning(fmt::format("a model could not be synthesised: {}", job.error));
  }
  if (Demand* demand = entities.get<Demand>(entity_of(job.owner))) {
    const std::uint8_t level = level_of(*entities.get<Detail>(entity_of(job.owner)),
                                        *entities.get<Source>(entity_of(job.owner)), job.key);
    if (level < kMaxLevels) demand->failed_levels |= static_cast<std::uint8_t>(1u << level);
    demand->requested_level = kNoLevel;
  }
}

// What the modeler noted of a mesh.
template <class T>
const T& note_of(const synthesis::MeshRecord& record) {
  const T* note = std::any_cast<T>(&record.note);
  PSYGEN_CHECK(note != nullptr, "a mesh landed without its note");
  return *note;
}

// From now on the ground of a node is known, and its light: as far as the mesh is off, it may be
// higher or lower.
void note_ground(ecs::Entity owner, Node& node, const synthesis::MeshRecord& record,
                 const WorldFacts& facts, const UploadQuery& entities) {
  const core::Bounds& bounds = facts.levels[node.at.level].bounds;
  const GroundNote& note = note_of<GroundNote>(record);
  const float possible_m =
      possible_error_m(facts, node.at.level, record.key.level) + note.edits_error_m;
  node.low_m = std::max(bounds.min.y, record.tight.min.y - possible_m);
  node.high_m = std::min(bounds.max.y, record.tight.max.y + possible_m);
  *entities.get<GroundRelief>(owner) = note.relief;
  *entities.get<GroundSun>(owner) = note.sun;
}

// What an entity draws so far. What landed in this tick is not in its component yet, where a mesh
// may be that was evicted. `ranked`: not since the cache system ranked it.
const Mesh& mesh_before(ecs::Entity owner, bool ranked, const UploadQuery& entities,
                        std::span<const ecs::Landing<Mesh>> landings) {
  for (std::size_t i = ranked ? 0 : landings.size(); i-- > 0;) {
    if (landings[i].entity == owner) return landings[i].value;
  }
  return *entities.get<Mesh>(owner);
}

// Notes that `handle` is what the entity draws from now on, if it has a use for it.
void offer(ecs::Entity owner, synthesis::MeshHandle handle, const synthesis::MeshRecord& record,
           std::uint32_t shared_indices, const WorldFacts& facts, double now_s,
           const UploadQuery& entities, synthesis::MeshSupply& meshes, Counters& counters,
           std::vector<ecs::Landing<Mesh>>& landings) {
  Demand* demand = entities.get<Demand>(owner);
  if (demand == nullptr) {
    meshes.rank(handle, synthesis::Rank::unwanted());  // destroyed meanwhile
    return;
  }
  const std::uint8_t level_before = demand->drawn_level;
  const bool pictured_before = demand->pictured;
  const bool ranked = demand->ranked != kNotRanked;
  Node* node = entities.get<Node>(owner);
  const Source& source = *entities.get<Source>(owner);
  const Detail& detail = *entities.get<Detail>(owner);
  const std::uint8_t level = level_of(detail, source, record.key);
  const bool fresh = record.key.parameters_hash == hash_of(source, level == detail.picture_level);
  if (level == kNoLevel || !accept(*demand, level, fresh, now_s, counters)) {
    meshes.rank(handle, synthesis::Rank::unwanted());
    return;
  }
  demand->pictured = level == detail.picture_level;
  bool before_goes = false;
  if (level_before != kNoLevel) {
    const Mesh& before = mesh_before(owner, ranked, entities, landings);
    meshes.rank(before.handle, synthesis::Rank::unwanted());
    if (Fading* fading = entities.get<Fading>(owner))
      before_goes = replace_mesh(*fading, before, level_before, pictured_before);
  }
  if (node != nullptr) {
    note_ground(owner, *node, record, facts, entities);
    // The next tick's cut is drawn by what is there, before the cache system looks again.
    Lacking& lacking = *entities.get<Lacking>(owner);
    if (level_before == kNoLevel && lacking.meshes > 0) --lacking.meshes;
  }
  if (MeshParts* parts = entities.get<MeshParts>(owner)) {
    if (before_goes) entities.get<OldParts>(owner)->parts = *parts;
    *parts = note_of<MeshParts>(record);
  }
  landings.push_back({owner, {record.range, handle, shared_indices, record.tight}});
}

}  // namespace

void upload_system(const Settings& settings, const Rules& rules, const Clock& clock,
                   const WorldFacts& facts, const Found& found, UploadQuery entities,
                   synthesis::MeshSupply& meshes, Output& output,
                   ecs::EventQueue<MeshLanded>& landed_meshes, Counters& counters, Totals& totals) {
  std::vector<ecs::Landing<Mesh>> landings;
  const auto offer_to = [&](ecs::Entity entity, synthesis::MeshHandle handle,
                            const synthesis::MeshRecord& record) {
    offer(entity, handle, record, shared_indices_of(record, facts, output), facts, clock.real_s,
          entities, meshes, counters, landings);
  };
  for (const Found::Mesh& mesh : found.meshes) {
    const synthesis::MeshRecord* record = meshes.ready(mesh.handle);
    if (record != nullptr) offer_to(mesh.entity, mesh.handle, *record);
  }
  // What was made for this frame is drawn in it.
  const synthesis::MeshSupply::Landed landed =
      meshes.land(rules.wait ? UINT64_MAX : settings.upload_budget_bytes);
  counters.bytes_synthesised = landed.bytes;
  for (const synthesis::Completion& job : landed.completions) {
    if (take_picture(job, facts, meshes, output)) continue;
    if (!job.ok) give_up(job, entities, totals);
    const synthesis::MeshRecord* record = meshes.ready(job.handle);
    if (record == nullptr) continue;
    ++counters.models_synthesised;
    counters.triangles_synthesised += record->size.triangle_count();
    offer_to(entity_of(job.owner), job.handle, *record);
  }
  entities.land<Mesh>(std::span<const ecs::Landing<Mesh>>(landings));
  for (const ecs::Landing<Mesh>& landing : landings)
    landed_meshes.emit({landing.entity, meshes.get(landing.value.handle)->key});
}

}  // namespace psygen::scene
