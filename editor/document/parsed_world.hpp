// A parsed world text: the world, and the registry that its model indices refer to. Immutable and
// shared, so that views can keep it while the text changes. Uses only flags of Qt. Any thread may
// read.
#pragma once

#include <QFlags>
#include <functional>
#include <memory>
#include <string>

#include "engine/core/error.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/files/resource_loader.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

// Adds the model types of a program to the standard ones (app::Plugin has the same member).
using RegisterModels = std::function<core::Result<void>(models::Registry&)>;

// The registry contains the species of the file too.
struct ParsedWorld {
  models::Registry registry;
  world::World world;
};
using ParsedWorldPtr = std::shared_ptr<const ParsedWorld>;

// Parses a text like a session, with a new registry. Fails like world::parse_world(), and like
// `register_models`, which may be empty. `files` loads the resources of the world; null:
// handmade::files().
core::Result<ParsedWorldPtr> parse_world_text(const std::string& text, const std::string& file_name,
                                              const RegisterModels& register_models,
                                              const world::ResourceLoader* files = nullptr);

// Parts in which two texts and their worlds differ.
enum class Change : unsigned {
  kText = 1,     // any byte; alone: comments, or the same values in another notation
  kWorld = 2,    // name, seed, number of blocks
  kTerrain = 4,  // parameters of the ground, with cell_m and block_vertices
  kSky = 8,
  kWater = 16,
  kPalette = 32,
  kSpecies = 64,
  kScatter = 128,  // also models from files
  kTables = 256,   // number of tables, or the model type of one: controls must be recreated
  kFile = 512,     // another file was opened
  kAll = 1023,     // all of the above, after opening another file
};
Q_DECLARE_FLAGS(Changes, Change)
Q_DECLARE_OPERATORS_FOR_FLAGS(Changes)

// The differences except kText and kFile.
Changes changes_between(const ParsedWorld& before, const ParsedWorld& after);

}  // namespace psygen::editor
