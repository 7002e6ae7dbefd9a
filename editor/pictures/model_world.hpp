// Small worlds for images of one subject: a model alone on flat, plain ground, a terrain, or a sky.
// Makes texts of world files; draws nothing. Pure functions; any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "editor/document/parsed_world.hpp"
#include "editor/pictures/picture_request.hpp"
#include "engine/core/camera.hpp"
#include "engine/world/files/text_path.hpp"

namespace psygen::editor {

// Returns the species or scatter that contains a path; nullopt for other paths.
std::optional<world::TextPath> subject_of(const world::TextPath& path);
// Returns a world with one model per block of some kilometres: that of a scatter of a world text,
// with its values, or of a species with its default values. `subject` as from subject_of(). Fails
// with kInvalidArgument if the text has no such table, and with kParse if it is not TOML.
core::Result<std::string> portrait_of(std::string_view text, const world::TextPath& subject);
// Returns a small world with this snippet (text_snippet.hpp) of a species, scatter, terrain or sky.
// Fails with kInvalidArgument for snippets of other tables.
core::Result<std::string> snippet_world(std::string_view snippet);
// True if snippet_world() makes a portrait of a model.
bool is_portrait(std::string_view snippet);
// The camera for the other worlds of snippet_world(): above a valley, higher above high terrains.
PicturePlace landscape_viewpoint(std::string_view snippet);

// The model of a portrait world with the most space around it.
struct IsolatedModel {
  core::WorldPosition base;
  models::ModelIndex model = 0;
  models::Parameters parameters;
};
// Searches some blocks at the origin; nullopt if they have no model.
std::optional<IsolatedModel> isolated_model(const world::World& world,
                                            const models::Registry& registry);

// The camera of a portrait: in front of the model, on its sunny side.
struct PortraitPose {
  core::CameraPose pose;
  core::WorldPosition middle;  // of the model
  double distance_m = 0;       // to it
};
// Returns a pose that frames a box (relative to the base point), or one at `distance_m` if that is
// above 0.
PortraitPose framing_pose(const core::WorldPosition& base, const core::Bounds& box, double block_m,
                          const core::Projection& projection, double distance_m = 0);
// Frames the isolated model of a world; nullopt if there is none. Synthesises a mesh of the model,
// so a model that hangs makes this call hang.
std::optional<PortraitPose> portrait_pose(const ParsedWorld& parsed,
                                          const core::Projection& projection,
                                          double distance_m = 0);

}  // namespace psygen::editor
