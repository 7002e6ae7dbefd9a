// Small worlds for pictures of one thing: a model alone on flat, plain ground, a terrain, a sky.
// Texts of world files; nothing is drawn here. Pure functions, any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "editor/document/parsed_world.hpp"
#include "editor/pictures/picture_request.hpp"
#include "engine/core/camera.hpp"

namespace psygen::editor {

// A world with the model of scatter number `scatter` of a world text, with its values, once on each
// block of some kilometres. Fails with kInvalidArgument where there is no such scatter, and with
// kParse where the text is not TOML.
core::Result<std::string> scatter_portrait(std::string_view text, std::size_t scatter);
// The same of species number `species`, as its defaults are.
core::Result<std::string> species_portrait(std::string_view text, std::size_t species);
// A world with this snippet (text_snippet.hpp) of a species, scatter, terrain or sky and little
// else. Fails with kInvalidArgument for snippets of other tables.
core::Result<std::string> snippet_world(std::string_view snippet);
// Whether snippet_world() makes a portrait of a model.
bool is_portrait(std::string_view snippet);
// From where the other worlds of snippet_world() are seen: over a valley, higher over terrains that
// are high.
PicturePlace country_place(std::string_view snippet);

// The model of a portrait world that has most room around it.
struct LonelyModel {
  core::WorldPosition foot;
  models::ModelIndex model = 0;
  models::Parameters parameters;
};
// Of some blocks around the origin; nothing where nothing stands.
std::optional<LonelyModel> lonely_model(const world::World& world,
                                        const models::Registry& registry);

// Where a portrait is taken: in front of the model, on its sunny side.
struct PortraitPose {
  core::CameraPose pose;
  core::WorldPosition middle;  // of the model
  double distance_m = 0;       // to it
};
// Such that a box (from the foot) is seen whole, or from `distance_m` where that is above 0.
PortraitPose pose_before(const core::WorldPosition& foot, const core::Bounds& box, double block_m,
                         const core::Projection& projection, double distance_m = 0);
// The same of the lonely model of a world. Nothing where nothing stands. Makes a mesh of the model,
// so a model that hangs hangs here.
std::optional<PortraitPose> portrait_pose(const ParsedWorld& parsed,
                                          const core::Projection& projection,
                                          double distance_m = 0);

}  // namespace psygen::editor
