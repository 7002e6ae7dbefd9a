// A world text as the engine reads it: the world, and the registry that its model indices mean.
// Immutable and shared, so views may keep an old one while the text goes on. It knows no document
// and no Qt but flags. Any thread may read.
#pragma once

#include <QFlags>
#include <functional>
#include <memory>
#include <string>

#include "engine/core/error.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/files/files_beside.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

// Adds the model types of a program to the standard ones (app::Plugin has the same member).
using RegisterModels = std::function<core::Result<void>(models::Registry&)>;

// The registry has the species of the file too.
struct ParsedWorld {
  models::Registry registry;
  world::World world;
};
using ParsedWorldPtr = std::shared_ptr<const ParsedWorld>;

// Reads a text as a session does, with a registry of its own. Fails like world::parse_world(), and
// like `register_models`, which may be empty. `files` reads those beside it; null:
// handmade::files().
core::Result<ParsedWorldPtr> parse_world_text(const std::string& text, const std::string& file_name,
                                              const RegisterModels& register_models,
                                              const world::FilesBeside* files = nullptr);

// What differs between two texts and their worlds.
enum class Change : unsigned {
  kText = 1,     // any byte; alone: comments, or the same values written in another way
  kWorld = 2,    // name, seed, number of blocks
  kTerrain = 4,  // parameters of the ground, with cell_m and block_vertices
  kSky = 8,
  kWater = 16,
  kPalette = 32,
  kSpecies = 64,
  kScatter = 128,  // also models that were made by hand
  kTables = 256,   // how many tables there are, or the model of one: controls must be made anew
  kFile = 512,     // another file was opened
  kAll = 1023,     // what comes with kFile
};
Q_DECLARE_FLAGS(Changes, Change)
Q_DECLARE_OPERATORS_FOR_FLAGS(Changes)

// All but kText and kFile.
Changes changes_between(const ParsedWorld& before, const ParsedWorld& after);

}  // namespace psygen::editor
