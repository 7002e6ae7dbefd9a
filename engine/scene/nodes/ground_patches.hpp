// The patches of a river network that modelers have made (models/terrain/ground_patch.hpp). A node
// waits for those that its ground reads, so that the main thread makes none. What is known here
// decides, not the network's store: what a store drops depends on threads, and virtual frames must
// not. It knows fewer than a store keeps, unless a tick needs more. Main thread only.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/models/terrain/ground_patch.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

struct Daylight;
struct WorldFacts;

class GroundPatches {
 public:
  // About half of what a network's store keeps (models/network/store.hpp).
  static constexpr std::size_t kMaxKnown = 256;
  static constexpr double kAskedM = 256;

  // Begins a tick of a world: wants nothing yet, forgets patches of another network, and keeps
  // kMaxKnown patches or those of the last tick, the last ones that nodes have asked for.
  void begin(const WorldFacts& facts);
  // True if all patches of a node are made, or if the world has no network; wants the others.
  bool ready(const WorldFacts& facts, const Daylight& daylight, const visibility::NodeCoord& at);
  // Requests the patches within kAskedM of a block (at most 512 cells) at full detail, because
  // games ask about the ground there.
  void want_around(const WorldFacts& facts, const Daylight& daylight, core::BlockCoord block);
  // Wants them as requests. Part of the cache system.
  void want_all(const WorldFacts& facts, synthesis::MeshSupply& supply);
  // Takes a finished request. False if it was for something else. Part of the upload system.
  bool take(const synthesis::Completion& job, const WorldFacts& facts,
            synthesis::MeshSupply& supply);
  // Patches that are made or wanted.
  std::size_t known() const { return patches_.size(); }

 private:
  using TileKey = models::network::TileKey;
  struct Patch {
    std::uint64_t asked = 0;  // number of the last time that a node needed it
    bool made = false;
  };
  bool ask(const std::vector<TileKey>& tiles);
  void forget_oldest();

  std::uint64_t network_ = 0;  // its identity; 0: none
  std::int64_t asked_cells_ = 0;
  // The block that patches were last wanted around, and these.
  std::optional<std::pair<core::BlockCoord, std::vector<TileKey>>> around_;
  std::uint64_t asks_ = 0, tick_begin_ = 0;  // so far, and before this tick
  std::unordered_map<TileKey, Patch, models::network::TileKeyHash> patches_;
  std::vector<TileKey> wanted_;
  std::vector<models::Parameters> parameters_;  // of the requests
};

}  // namespace psygen::scene
