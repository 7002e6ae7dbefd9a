#include "engine/scene/nodes/ground_patches.hpp"

#include <algorithm>

#include "engine/core/log.hpp"
#include "engine/models/edits.hpp"
#include "engine/scene/facts/levels.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"

namespace psygen::scene {
namespace {

using models::network::TileKey;

// More are forgotten at once, and requested again where they are needed.
constexpr std::size_t kMaxKnown = 1 << 16;
// Before all meshes except those that a frame lacks, which a main thread may make; never a patch.
constexpr auto kGroup = synthesis::RankGroup::kDrawn;

const models::RiverNetwork* network_of(const world::World& world) {
  return world.layer() != nullptr ? world.layer()->ground.network.get() : nullptr;
}

}  // namespace

void GroundPatches::begin(const WorldFacts& facts) {
  wanted_.clear();
  const models::RiverNetwork* const network = network_of(facts.world);
  const std::uint64_t identity = network != nullptr ? network->identity() : 0;
  if (identity != network_ || made_.size() > kMaxKnown) {
    made_.clear();
    requested_.clear();
  }
  network_ = identity;
}

bool GroundPatches::ready(const WorldFacts& facts, const visibility::NodeCoord& at) {
  if (network_ == 0) return true;
  bool all = true;
  for (const TileKey& tile : models::ground_patches(node_terrain(facts.world, at))) {
    if (made_.contains(tile)) continue;
    all = false;
    if (std::ranges::find(wanted_, tile) == wanted_.end()) wanted_.push_back(tile);
  }
  return all;
}

void GroundPatches::want_all(const WorldFacts& facts, synthesis::MeshSupply& supply) {
  parameters_.clear();
  parameters_.reserve(wanted_.size());
  for (const TileKey& tile : wanted_) {
    const models::Parameters& p =
        parameters_.emplace_back(models::ground_patch_parameters(facts.world.layer().get(), tile));
    const synthesis::MeshKey key{{}, 0, facts.patch_model, 0, p.hash()};
    // A change of the world may have taken the finished request.
    const synthesis::MeshHandle handle = supply.find(key);
    const synthesis::MeshRecord* const record = supply.get(handle);
    if (record != nullptr && (record->state == synthesis::MeshState::kReady ||
                              record->state == synthesis::MeshState::kFailed)) {
      made_.insert(tile);
      supply.forget(handle);
      continue;
    }
    requested_.emplace(key.parameters_hash, tile);
    supply.want({key, &p, owner_of(ecs::kNullEntity), synthesis::Rank::by_layer(kGroup, 0, 0.0F)});
  }
}

// A failed patch is made again by the meshes that need it, which then fail by themselves.
bool GroundPatches::take(const synthesis::Completion& job, const WorldFacts& facts,
                         synthesis::MeshSupply& supply) {
  if (facts.patch_model == 0 || job.key.model != facts.patch_model) return false;
  if (!job.ok) core::log_warning("a part of a river network could not be made: " + job.error);
  if (const auto asked = requested_.find(job.key.parameters_hash); asked != requested_.end()) {
    made_.insert(asked->second);
    requested_.erase(asked);
  }
  supply.forget(job.handle);
  return true;
}

}  // namespace psygen::scene
