// The world of a save, part by part: hashes of everything that decides what edits refer to. The
// world itself is not stored; a game keeps it in its own files. Plain values; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/world/world.hpp"

namespace psygen::save {

// The parts of a world. Edits depend on all but the last two.
enum class PartKind : std::uint8_t {
  kSeed,
  kBlockSize,  // metres
  kExtent,     // number of blocks
  kGround,     // terrain, stamps and roads
  kWater,      // its level
  kScatter,    // type, limits and mask of one [[scatter]]
  kSpecies,    // the branches of one [[species]]
  kModel,      // the shape of one [[model]]
  kPlaces,     // all [[place]]
  kLooks       // sky and colours
};

struct WorldPart {
  PartKind kind = PartKind::kSeed;
  std::string name;         // of the model type, for kScatter, kSpecies and kModel
  std::uint64_t hash = 0;   // of the content
  std::uint32_t count = 0;  // kScatter: instances per block
  friend bool operator==(const WorldPart&, const WorldPart&) = default;
};

// Two worlds with equal hashes have the same ground and the same models at the same positions. The
// name is for people: messages, and lists of saves.
struct WorldIdentity {
  std::string name;
  std::uint64_t hash = 0;
  std::vector<WorldPart> parts = {};  // in the order of the file; none in saves of format 1
  friend bool operator==(const WorldIdentity&, const WorldIdentity&) = default;
};

// The identity of a world. The hash covers seed, size, ground, scattered models, the branches of
// species, and the water level. It does not cover names, sky, palette, other appearance, and
// parameters with their default values: saves stay valid when the engine gets a new parameter whose
// default changes nothing. O(size of the world file).
WorldIdentity identity_of(const world::World& world, const models::Registry& registry);

// A part that differs between two worlds.
struct PartChange {
  PartKind kind = PartKind::kSeed;
  std::size_t part = 0;  // index in the parts of the earlier world, or of the later one if new
  bool is_new = false;
  std::string text;  // such as "scatter 2 of 5 'birch' is gone"
};

// The parts that differ, in the order of PartKind; empty if one world has no parts. The instances
// of a scatter keep their indices, and so the edits that name them, if the scatters before it have
// the same number of instances: a scatter differs also if its first index does. O(parts²).
std::vector<PartChange> changes_between(const WorldIdentity& before, const WorldIdentity& now);

// The first index of the instances of each scatter in a block, in the order of the parts.
struct ScatterSpan {
  std::size_t part = 0;     // index in WorldIdentity::parts
  std::uint64_t first = 0;  // index of its first instance
  std::uint64_t count = 0;  // of instances
};
std::vector<ScatterSpan> scatter_spans(const WorldIdentity& world);

}  // namespace psygen::save
