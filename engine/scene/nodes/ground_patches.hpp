// The patches of a river network that modelers have made (models/terrain/ground_patch.hpp). A node
// waits for those that its ground reads, so that the main thread makes none. What is known here
// decides, not the network's store: what a store drops depends on threads, and virtual frames must
// not. Main thread only.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "engine/models/terrain/ground_patch.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

struct WorldFacts;

class GroundPatches {
 public:
  // Begins a tick of a world: nothing is wanted, and patches of another network are forgotten.
  void begin(const WorldFacts& facts);
  // True if all patches of a node are made, or if the world has no network; wants the others.
  bool ready(const WorldFacts& facts, const visibility::NodeCoord& at);
  // Wants them as requests. Part of the cache system.
  void want_all(const WorldFacts& facts, synthesis::MeshSupply& supply);
  // Takes a finished request. False if it was for something else. Part of the upload system.
  bool take(const synthesis::Completion& job, const WorldFacts& facts,
            synthesis::MeshSupply& supply);
  // Patches wanted in this tick.
  std::size_t wanted() const { return wanted_.size(); }

 private:
  using TileKey = models::network::TileKey;

  std::uint64_t network_ = 0;  // its identity
  std::unordered_set<TileKey, models::network::TileKeyHash> made_;
  std::unordered_map<std::uint64_t, TileKey> requested_;  // by the hash of their parameters
  std::vector<TileKey> wanted_;
  std::vector<models::Parameters> parameters_;  // of the requests
};

}  // namespace psygen::scene
