#include "engine/scene/nodes/ground_patches.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/log.hpp"
#include "engine/models/edits.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/nodes/daylight.hpp"
#include "engine/scene/nodes/entities.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {
namespace {

using models::network::TileKey;

// Below every group that the main thread may make (PlanLimits::here_up_to), above all meshes out of
// view.
constexpr auto kGroup = synthesis::RankGroup::kDrawn;

// A tile is at least a block wide, so its numbers fit those of blocks.
synthesis::MeshKey key_of(const TileKey& tile, const models::Parameters& p,
                          const WorldFacts& facts) {
  return {{static_cast<std::int32_t>(tile.i), static_cast<std::int32_t>(tile.j)},
          static_cast<std::uint32_t>(tile.level),
          facts.patch_model,
          0,
          p.hash()};
}

}  // namespace

void GroundPatches::begin(const WorldFacts& facts) {
  wanted_.clear();
  const models::RiverNetwork* const network = facts.world.network();
  const std::uint64_t identity = network != nullptr ? network->identity() : 0;
  if (identity != network_) {
    patches_.clear();
    around_.reset();
  }
  network_ = identity;
  asked_cells_ = static_cast<std::int64_t>(
      std::ceil(world::ground_reach_m(facts.world) / facts.world.cell_m()));
  if (patches_.size() > kMaxKnown) forget_oldest();
  tick_begin_ = asks_;
}

// Patches of the last tick stay, however many they are: their nodes still wait for others.
void GroundPatches::forget_oldest() {
  std::vector<std::uint64_t> asked;
  asked.reserve(patches_.size());
  for (const auto& [tile, patch] : patches_)
    asked.push_back(patch.asked);
  const auto oldest = asked.begin() + static_cast<std::ptrdiff_t>(asked.size() - kMaxKnown);
  std::ranges::nth_element(asked, oldest);
  const std::uint64_t kept_from = std::min(*oldest, tick_begin_ + 1);
  std::erase_if(patches_, [&](const auto& known) { return known.second.asked < kept_from; });
}

bool GroundPatches::ready(const WorldFacts& facts, const Daylight& daylight,
                          const visibility::NodeCoord& at) {
  if (network_ == 0) return true;
  return ask(
      models::ground_patches(lit_ground(facts, daylight, at), at.level == 0 ? asked_cells_ : 0));
}

void GroundPatches::want_around(const WorldFacts& facts, const Daylight& daylight,
                                core::BlockCoord block) {
  if (network_ == 0) return;
  if (!around_ || around_->first != block) {
    const auto cells = static_cast<std::int64_t>(kAskedM / facts.world.cell_m());
    around_.emplace(block, models::ground_patches(lit_ground(facts, daylight, {block, 0}), cells));
  }
  static_cast<void>(ask(around_->second));
}

bool GroundPatches::ask(const std::vector<TileKey>& tiles) {
  bool all = true;
  for (const TileKey& tile : tiles) {
    Patch& patch = patches_[tile];
    const bool asked = patch.asked > tick_begin_;
    patch.asked = ++asks_;
    if (patch.made) continue;
    all = false;
    if (!asked) wanted_.push_back(tile);
  }
  return all;
}

void GroundPatches::want_all(const WorldFacts& facts, synthesis::MeshSupply& supply) {
  const models::EditLayer* const layer = facts.world.layer().get();
  parameters_.clear();
  parameters_.reserve(wanted_.size());
  for (const TileKey& tile : wanted_) {
    const models::Parameters& p =
        parameters_.emplace_back(models::ground_patch_parameters(layer, tile));
    const synthesis::MeshKey key = key_of(tile, p, facts);
    // A change of the world may have taken the finished request.
    const synthesis::MeshHandle handle = supply.find(key);
    const synthesis::MeshRecord* const record = supply.get(handle);
    if (record != nullptr && (record->state == synthesis::MeshState::kReady ||
                              record->state == synthesis::MeshState::kFailed)) {
      patches_[tile].made = true;
      supply.forget(handle);
      continue;
    }
    supply.want({key, &p, owner_of(ecs::kNullEntity), synthesis::Rank::by_layer(kGroup, 0, 0.0F)});
  }
}

// Nodes go on without a patch that could not be made: they make it, or fail to, like any other
// part of themselves.
bool GroundPatches::take(const synthesis::Completion& job, const WorldFacts& facts,
                         synthesis::MeshSupply& supply) {
  if (facts.patch_model == 0 || job.key.model != facts.patch_model) return false;
  if (!job.ok && !job.late)
    core::log_warning("a part of a river network could not be made: " + job.error);
  const TileKey tile{static_cast<int>(job.key.index), job.key.block.x, job.key.block.z};
  const auto known = patches_.find(tile);
  const models::EditLayer* const layer = facts.world.layer().get();
  if (known != patches_.end() &&
      models::ground_patch_parameters(layer, tile).hash() == job.key.parameters_hash)
    known->second.made = true;
  supply.forget(job.handle);
  return true;
}

}  // namespace psygen::scene
