// Worlds for the tests of queries: the shipped ones, and a small bounded one of 8 x 4 blocks.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "engine/core/hash.hpp"
#include "engine/query/world.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::query::testing {

// A world with the registry that its file fills.
struct Loaded {
  models::Registry registry = models::make_standard_registry();
  world::World world;

  // `name` is a file name in game/worlds without its extension.
  static Loaded shipped(const std::string& name) {
    Loaded loaded;
    auto world =
        world::load_world(world::testing::game_file("worlds/" + name + ".toml"), loaded.registry);
    EXPECT_TRUE(world.has_value()) << world.error().message;
    loaded.world = *world;
    return loaded;
  }
  static Loaded parsed(const std::string& text) {
    Loaded loaded;
    auto world = world::parse_world(text, "test.toml", loaded.registry);
    EXPECT_TRUE(world.has_value()) << world.error().message;
    loaded.world = *world;
    return loaded;
  }
};

inline constexpr const char* kWorldNames[] = {"paper",         "endless",      "lakes",
                                              "silver_combe",  "five_species", "ember_pass",
                                              "thorn_country", "frost_isle"};

inline constexpr const char* kBounded = world::testing::kSmallWorld;

// Returns a block in the world, near its middle, or far out if it is endless.
inline core::BlockCoord some_block(const world::World& world) {
  if (!world.is_endless()) return {3, 2};
  return {1 << 30, -(1 << 30) + 5};
}

}  // namespace psygen::query::testing
