// Worlds for the tests of queries: the shipped ones, and a small bounded one.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "engine/core/hash.hpp"
#include "engine/query/world.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::query::testing {

// A world with the registry that its file fills.
struct Loaded {
  models::Registry registry = models::make_standard_registry();
  world::World world;

  // `name` is that of a file in game/worlds, without its ending.
  static Loaded shipped(const std::string& name) {
    Loaded loaded;
    const auto file =
        std::filesystem::path(PSYGEN_SOURCE_DIR) / "game" / "worlds" / (name + ".toml");
    auto world = world::load_world(file, loaded.registry);
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

inline constexpr const char* kWorldNames[] = {"paper", "endless", "lakes", "silver_combe",
                                              "five_species"};

inline constexpr const char* kBounded = R"(format = 1

[world]
name = "bounded"
seed = 5
blocks = [8, 4]
cell_m = 2
block_vertices = 33

[terrain]
octaves = 4
relief_m = 60

[[scatter]]
model = "tree"
count = 3
iterations = [2, 3]
size_m = [1.5, 2.5]

[[scatter]]
model = "rock"
count = 5
subdivisions = 1
)";

// A block that the world contains, near its middle or far out if it is endless.
inline core::BlockCoord some_block(const world::World& world) {
  if (!world.is_endless()) return {3, 2};
  return {1 << 30, -(1 << 30) + 5};
}

}  // namespace psygen::query::testing
