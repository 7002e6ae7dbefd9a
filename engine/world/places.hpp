// Models that a world's file places by hand, each at a point. They are part of the world's
// function, beside what scatters place and what edits place (edits/edits.hpp). Plain values;
// immutable in use, any thread. They read no files (files/place_file.hpp). docs/world-files.md.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/models/registry.hpp"

namespace psygen::world {

struct World;

// One model. Its foot stands on the ground, or `above_m` over it.
struct Place {
  models::ModelIndex model = 0;
  models::Parameters parameters;  // legal for the type; the slope of the ground is set later
  glm::dvec2 at_m{0.0};           // x and z in the world
  double above_m = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

inline constexpr std::size_t kMaxPlaces = 4096;  // per file

// All of them.
struct Places {
  std::vector<Place> all;
  // Them by blocks, with the position in `all` plus 1 as id; null: there are none. Made by
  // sort_places(). It follows from the rest, and is not compared.
  std::shared_ptr<const models::EditLayer> by_block;
  friend bool operator==(const Places& a, const Places& b) { return a.all == b.all; }
};

// Makes Places::by_block. Requires places in the world. O(n log n).
void sort_places(World& world, const models::Registry& registry);

// Of all places, by names of types; 0: there are none.
std::uint64_t places_hash(const World& world, const models::Registry& registry);

}  // namespace psygen::world
