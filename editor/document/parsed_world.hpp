// A parsed world text: the world, and the registry that its model indices refer to. Immutable and
// shared, so that views can keep it while the text changes. Knows no Qt. Any thread may read.
#pragma once

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

// The extent of a change of a document.
enum class Change {
  kText,    // values, tables or comments
  kGround,  // also the height of the ground or of the water somewhere
  kFile,    // another file
};

}  // namespace psygen::editor
