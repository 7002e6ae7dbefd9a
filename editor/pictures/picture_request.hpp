// Requests to the rendering process and its replies, as values and as lines of JSON: images of
// worlds and models, costs, exports. Renders nothing (picture_server.hpp) and starts no process
// (picture_service.hpp). Pure functions; any thread.
#pragma once

#include <QByteArray>
#include <QImage>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

#include "editor/cost/block_cost.hpp"
#include "engine/core/surface_provider.hpp"

namespace psygen::editor {

enum class PictureKind : std::uint8_t {
  kPicture,      // image of the world
  kPortrait,     // image of the first scatter's model, near and alone (model_world.hpp)
  kCost,         // cost of a block, without an image
  kMeasure,      // camera distance of a portrait
  kExportModel,  // file with one model of a block
  kExportBlock,  // file with a block and its models
};

// The camera of an image: metres of the world and radians, as core::CameraPose.
struct PicturePlace {
  glm::dvec3 at_m{0};
  double yaw = 0, pitch = 0;
  bool above_ground = false;  // at_m.y counts from the ground, or from the water above it
};

// The state of the view that other images copy: its camera, clock and size.
struct ViewState {
  PicturePlace place;
  double above_m = 0;   // height of the camera above ground or water
  double now_s = 0;     // time of the clock
  core::Extent size{};  // device pixels
};
// Returns nullopt while there is no view.
using AskView = std::function<std::optional<ViewState>()>;

// One request. The world is a text, so that unsaved changes are rendered too.
struct PictureRequest {
  std::uint64_t id = 0;
  PictureKind kind = PictureKind::kPicture;
  std::string text;
  std::string file;  // of the world: for messages, and for the folder of its images
  std::string out;   // output file: .png, or .glb and .obj
  core::Extent size{};
  double distance_m = 0;              // of a portrait; 0: frames the whole model
  std::optional<PicturePlace> place;  // none: home of the world
  double now_s = 0;                   // time of the clock, for worlds with a day
  std::int32_t block_x = 0, block_z = 0;
  std::uint32_t index = 0;  // of the model within the block
  int level = 0;            // level of detail
  // Unsaved images of the world: temporary files by image name.
  std::map<std::string, std::string> pictures = {};
};

// The answer. `error` is empty for success.
struct PictureReply {
  std::uint64_t id = 0;
  std::string error;
  bool dropped = false;  // another request was more urgent
  std::optional<BlockCost> cost;
  double distance_m = 0;  // for kMeasure
  std::string note;       // for exports: summary of the file
  QImage image;           // loaded from the file by the service; not in the JSON
};

// Returns one line, with its line break.
QByteArray to_line(const PictureRequest& request);
QByteArray to_line(const PictureReply& reply);
// Parses a line; nullopt for other lines. The values are not validated.
std::optional<PictureRequest> request_from(const QByteArray& line);
std::optional<PictureReply> reply_from(const QByteArray& line);

}  // namespace psygen::editor
