// The paper's world with edits, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/models/edits.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/source_file.hpp"

namespace psygen::world::testing {

// A hash of all edits; 0: none.
inline std::uint64_t hash_of(const Edits& edits) {
  return edits.empty() ? 0 : edits.layer()->blocks.root()->hash;
}

struct EditedWorld {
  models::Registry registry = models::make_standard_registry();
  World function = *load_world(source_file("game/worlds/paper.toml"), registry);
  World world = function;
  Edits edits;

  void apply() { set_edits(world, edits.layer()); }
  std::vector<Placement> placements(core::BlockCoord block) const { return of(world, block); }
  std::vector<Placement> unedited(core::BlockCoord block) const { return of(function, block); }

 private:
  std::vector<Placement> of(const World& which, core::BlockCoord block) const {
    std::vector<Placement> out;
    place_models(which, registry, block, out);
    return out;
  }
};

}  // namespace psygen::world::testing
