// Models that a world file places one by one, each at a point. They are part of the world's
// function, next to scattered models and models placed by edits (edits/edits.hpp). Plain values;
// immutable in use, any thread. They read no files (files/scatter_file.hpp). docs/world-files.md.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/models/registry.hpp"

namespace psygen::world {

struct World;

// One placed model. Its base point is on the ground, or `above_m` over it.
struct Place {
  models::ModelIndex model = 0;
  models::Parameters parameters;  // legal for the type; the slope of the ground is set later
  glm::dvec2 at_m{0.0};           // x and z in the world
  double above_m = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

inline constexpr std::size_t kMaxPlaces = 4096;  // per file

// All models that the file places.
struct Places {
  std::vector<Place> all;
  // The same models by block; an id is the position in `all` plus 1. Null: there are none.
  // sort_places() derives it from `all`, so it is not compared.
  std::shared_ptr<const models::EditLayer> by_block;
  friend bool operator==(const Places& a, const Places& b) { return a.all == b.all; }
};

// Derives Places::by_block. Every place must lie in the world. O(n log n).
void sort_places(World& world, const models::Registry& registry);

// A hash of all places, with types by name; 0: there are none.
std::uint64_t places_hash(const World& world, const models::Registry& registry);

}  // namespace psygen::world
