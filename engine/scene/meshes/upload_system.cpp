// Collects finished requests, makes their meshes resident and writes them into their entities.
// Where memory is shared with the device, the modeler has already written the final bytes, and this
// is only book-keeping with the annotations of meshes (mesh_annotations.hpp).
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/assert.hpp"
#include "engine/core/log.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/meshes/fading.hpp"
#include "engine/scene/meshes/mesh_annotations.hpp"
#include "engine/scene/meshes/tree_impostors.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"

namespace psygen::scene {
namespace {

// Key of the tiles' index list, in place of the list of a block's finest ground. No type uses this
// number.
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
                                const UploadWork& work) {
  if (record.size.shared_indices == 0) return render::kNoSharedIndices;
  const bool tiled =
      facts.tiles && record.key.model == facts.world.terrain_model && record.key.level == 0;
  const std::uint64_t key =
      (std::uint64_t{record.key.model} << 32) | (tiled ? kTiles : record.size.shared_indices);
  SharedIndices& shared = work.meshes.shared_indices;
  const auto known = shared.find(key);
  if (known != shared.end()) return known->second;
  std::uint32_t name = static_cast<std::uint32_t>(shared.size()) + 1;
  if (work.output.renderer != nullptr) {
    const std::vector<std::uint16_t> list = index_list(record, facts, tiled);
    const auto uploaded = work.output.renderer->upload_shared_indices(list);
    if (!uploaded) {
      core::log_error(fmt::format("index list not uploaded: {}", uploaded.error().message));
      return render::kNoSharedIndices;
    }
    name = *uploaded;
  }
  shared.emplace(key, name);
  return name;
}

// Returns true if an entity has a use for a mesh of this level now, and records that it has it.
// `fresh`: the mesh is of the entity's present parameters.
bool accept(MeshDemand& demand, std::uint8_t level, bool fresh, double now_s, MeshCounts& counts) {
  const bool asked_for = level == demand.requested_level && fresh;
  if (!asked_for && demand.drawn_level != kNoLevel) return false;
  demand.drawn_level = level;
  demand.stale = !fresh;
  demand.stale_light = demand.stale && demand.stale_light;
  demand.ranked = kNotRanked;
  if (asked_for) demand.requested_level = kNoLevel;
  if (demand.seen_s >= 0) {
    counts.time_to_visible_ms.push_back((static_cast<float>(now_s) - demand.seen_s) * 1000.0F);
    demand.seen_s = -1;
  }
  return true;
}

void note_failure(const synthesis::Completion& job, const UploadQuery& entities,
                  SceneMeshes& meshes) {
  if (job.late) return;  // counted when it was abandoned
  if (meshes.failed++ == 0)
    core::log_warning(fmt::format("a model could not be synthesised: {}", job.error));
  if (MeshDemand* demand = entities.get<MeshDemand>(entity_of(job.owner))) {
    const std::uint8_t level = level_of(*entities.get<LodErrors>(entity_of(job.owner)),
                                        *entities.get<MeshSource>(entity_of(job.owner)), job.key);
    if (level < kMaxLevels) demand->failed_levels |= static_cast<std::uint8_t>(1u << level);
    demand->requested_level = kNoLevel;
  }
}

// The modeler's annotation of a mesh.
template <class T>
const T& note_of(const synthesis::MeshRecord& record) {
  const T* note = std::any_cast<T>(&record.note);
  PSYGEN_CHECK(note != nullptr, "a mesh landed without its note");
  return *note;
}

// Sets the height range of a node, its occluder lines and its sunlight from its new mesh. The range
// includes the error of the mesh.
void note_ground(ecs::Entity owner, QuadtreeNode& node, const synthesis::MeshRecord& record,
                 const WorldFacts& facts, const UploadQuery& entities) {
  const core::Bounds& bounds = facts.levels[node.at.level].bounds;
  const GroundAnnotation& note = note_of<GroundAnnotation>(record);
  const float possible_m =
      possible_error_m(facts, node.at.level, record.key.level) + note.edits_error_m;
  node.low_m = std::max(bounds.min.y, record.tight.min.y - possible_m);
  node.high_m = std::min(bounds.max.y, record.tight.max.y + possible_m);
  *entities.get<GroundOccluder>(owner) = note.occluder;
  *entities.get<GroundSunlight>(owner) = note.sun;
}

// The mesh that an entity draws so far. A mesh handed over in this tick is not in its component
// yet; the component may hold an evicted one. `ranked`: no mesh was handed over since the cache
// system ranked it.
const Mesh& mesh_before(ecs::Entity owner, bool ranked, const UploadQuery& entities,
                        std::span<const ecs::Landing<Mesh>> landings) {
  for (std::size_t i = ranked ? 0 : landings.size(); i-- > 0;) {
    if (landings[i].entity == owner) return landings[i].value;
  }
  return *entities.get<Mesh>(owner);
}

// A mesh that is ready for an entity.
struct Offer {
  ecs::Entity owner;
  synthesis::MeshHandle handle;
  const synthesis::MeshRecord& record;
  std::uint32_t shared_indices = 0;
};

// Hands the mesh to the entity, if it has a use for it.
void hand_over(const Offer& offer, const WorldFacts& facts, double now_s,
               const UploadQuery& entities, const UploadWork& work,
               std::vector<ecs::Landing<Mesh>>& landings) {
  const auto& [owner, handle, record, shared_indices] = offer;
  MeshDemand* demand = entities.get<MeshDemand>(owner);
  if (demand == nullptr) {  // destroyed since the request
    work.supply.rank(handle, synthesis::Rank::unwanted());
    return;
  }
  const std::uint8_t level_before = demand->drawn_level;
  const bool pictured_before = demand->pictured;
  const bool ranked = demand->ranked != kNotRanked;
  QuadtreeNode* node = entities.get<QuadtreeNode>(owner);
  const MeshSource& source = *entities.get<MeshSource>(owner);
  const LodErrors& detail = *entities.get<LodErrors>(owner);
  const std::uint8_t level = level_of(detail, source, record.key);
  const bool fresh = record.key.parameters_hash == hash_of(source, level == detail.picture_level);
  if (level == kNoLevel || !accept(*demand, level, fresh, now_s, work.meshes.counts)) {
    work.supply.rank(handle, synthesis::Rank::unwanted());
    return;
  }
  demand->pictured = level == detail.picture_level;
  bool before_goes = false;
  if (level_before != kNoLevel) {
    const Mesh& before = mesh_before(owner, ranked, entities, landings);
    work.supply.rank(before.handle, synthesis::Rank::unwanted());
    if (Fading* fading = entities.get<Fading>(owner))
      before_goes = replace_mesh(*fading, before, level_before, pictured_before);
  }
  if (node != nullptr) {
    note_ground(owner, *node, record, facts, entities);
    // The next tick's cut depends on it before the cache system looks again.
    MissingMeshes& missing = *entities.get<MissingMeshes>(owner);
    if (level_before == kNoLevel && missing.meshes > 0) --missing.meshes;
  }
  if (MeshParts* parts = entities.get<MeshParts>(owner)) {
    if (before_goes) entities.get<ReplacedParts>(owner)->parts = *parts;
    *parts = note_of<MeshParts>(record);
  }
  landings.push_back({owner, {record.range, handle, shared_indices, record.tight}});
}

// Modelers that replace hung ones get their own tracks. The cache system's span shows the meshes
// that the main thread made. Virtual time traces no jobs: they have no place on the trace's real
// clock.
void trace_job(const synthesis::Completion& job, Tracing& trace) {
  if (job.modeler == synthesis::kMainThreadModeler) return;
  while (trace.modelers.size() <= job.modeler)
    add_modeler(trace);
  trace.log->add_span(trace.modelers[job.modeler], trace.models[job.key.model], job.started_s,
                      job.finished_s);
}

}  // namespace

void synthesis_system(FrameContext frame, synthesis::MeshSupply& supply, SceneMeshes& meshes,
                      Tracing& trace) {
  if (frame.rules.wait) supply.wait();
  MeshCounts& counts = meshes.counts;
  for (const synthesis::Completion& job : supply.collect()) {
    ++(job.ok ? counts.completed : counts.failed);
    if (!job.remote) counts.synthesis_seconds += job.seconds;
    if (job.ok && !job.remote)
      counts.costs.push_back({job.predicted_seconds, job.seconds, job.key.model});
    if (trace.log != nullptr && !job.late && !frame.settings.virtual_time) trace_job(job, trace);
  }
}

void upload_system(FrameContext frame, const WorldFacts& facts, UploadQuery entities,
                   UploadWork work) {
  auto& [supply, meshes, patches, output, ready] = work;
  std::vector<ecs::Landing<Mesh>> landings;
  const auto offer = [&](ecs::Entity entity, synthesis::MeshHandle handle,
                         const synthesis::MeshRecord& record) {
    hand_over({entity, handle, record, shared_indices_of(record, facts, work)}, facts,
              frame.clock.real_s, entities, work, landings);
  };
  for (const SceneMeshes::FoundMesh& mesh : meshes.found) {
    const synthesis::MeshRecord* record = supply.ready(mesh.handle);
    if (record != nullptr) offer(mesh.entity, mesh.handle, *record);
  }
  // Meshes made for this frame are drawn in it, whatever the budget.
  const synthesis::MeshSupply::Landed landed =
      supply.land(frame.rules.wait ? UINT64_MAX : frame.settings.upload_budget_bytes);
  meshes.counts.bytes_synthesised = landed.bytes;
  for (const synthesis::Completion& job : landed.completions) {
    if (take_picture(job, facts, work) || patches.take(job, facts, supply)) continue;
    if (!job.ok) note_failure(job, entities, meshes);
    const synthesis::MeshRecord* record = supply.ready(job.handle);
    if (record == nullptr) continue;
    ++meshes.counts.models_synthesised;
    meshes.counts.triangles_synthesised += record->size.triangle_count();
    offer(entity_of(job.owner), job.handle, *record);
  }
  entities.land<Mesh>(std::span<const ecs::Landing<Mesh>>(landings));
  for (const ecs::Landing<Mesh>& landing : landings)
    ready.emit({landing.entity, supply.get(landing.value.handle)->key});
}

}  // namespace psygen::scene
