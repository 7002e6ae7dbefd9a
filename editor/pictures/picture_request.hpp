// What the editor asks of its drawing process, and what comes back, as values and as lines of JSON:
// pictures of worlds and models, costs, exports. It draws nothing (picture_server.hpp) and starts
// no process (picture_service.hpp). Pure functions, any thread.
#pragma once

#include <QByteArray>
#include <QImage>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

#include "editor/cost/block_cost.hpp"
#include "engine/core/surface_provider.hpp"

namespace psygen::editor {

// What is asked for.
enum class PictureKind : std::uint8_t {
  kPicture,      // of the world at a place
  kPortrait,     // of the first scatter's model, near and alone (model_world.hpp)
  kCost,         // of a block, without a picture
  kMeasure,      // how far away a portrait would be taken
  kExportModel,  // a file with one model of a block
  kExportBlock,  // a file with everything on a block
};

// Where a picture is taken: metres of the world and radians, as core::CameraPose.
struct PicturePlace {
  glm::dvec3 at_m{0};
  double yaw = 0, pitch = 0;
  bool above_ground = false;  // at_m.y counts from the ground, or the water on it
};

// One request. The world is always a text: what is drawn is what is edited, saved or not.
struct PictureRequest {
  std::uint64_t id = 0;
  PictureKind kind = PictureKind::kPicture;
  std::string text;
  std::string file;  // of the world: for messages, and the folder of its pictures
  std::string out;   // to be written: .png, or .glb and .obj
  core::Extent size{};
  double distance_m = 0;              // of a portrait; 0: what shows it whole
  std::optional<PicturePlace> place;  // none: where the camera stands in a new world
  double now_s = 0;                   // of the clock, for worlds with a day
  std::int32_t block_x = 0, block_z = 0;
  std::uint32_t index = 0;  // of the model within the block
  int level = 0;            // of detail
  // Pictures beside the world that are not written there yet: files that hold them, by name.
  std::map<std::string, std::string> pictures = {};
};

// The answer. `error` is empty for success.
struct PictureReply {
  std::uint64_t id = 0;
  std::string error;
  bool dropped = false;  // another request was more urgent
  std::optional<BlockCost> cost;
  double distance_m = 0;  // of kMeasure
  std::string note;       // of an export: what was written
  QImage image;           // read from the file by the service; not in the JSON
};

// One line each, with its end.
QByteArray to_line(const PictureRequest& request);
QByteArray to_line(const PictureReply& reply);
// Nothing for lines that are none of these. Values are what the line says: nothing trusts them.
std::optional<PictureRequest> request_from(const QByteArray& line);
std::optional<PictureReply> reply_from(const QByteArray& line);

}  // namespace psygen::editor
