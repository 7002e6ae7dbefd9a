// Builds replies about a session as JSON: statistics, times of systems, entities, the text of the
// world. Reads only. Main thread.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::app {
class Session;
}

namespace psygen::inspect {

// JSON with members in the order of insertion.
using Json = nlohmann::ordered_json;

// Statistics of the frames since the last reply.
struct FrameNotes {
  std::uint64_t frames = 0;   // of the connection
  std::uint64_t figures = 0;  // since the last reply
  double longest_ms = 0, sum_ms = 0, synthesis_s = 0;
  double last_frame_s = 0;  // end of the last frame on the real clock; 0: none
  double figures_since_s = 0;
  std::uint64_t timed = 0;  // for systems()
  std::vector<double> system_sum_ms, system_longest_ms;

  // Adds the last frame. Call after every tick.
  void note(const scene::Scene& scene);
};

Json figures(const app::Session& session, FrameNotes& notes);
Json systems(const scene::Scene& scene, FrameNotes& notes);
// Counts of entities by model type, and of objects, lights and emitters, and the nodes for a map,
// coarse ones first.
Json entities(const scene::Scene& scene);

// Conversion of poses; pose_from() fails with kInvalidArgument for invalid members.
Json pose_json(const core::CameraPose& pose);
core::Result<core::CameraPose> pose_from(const Json& json, double block_m);

// Text of a session's world: its file if that is unchanged, else a text written from its values.
std::string world_text(const app::Session& session);

}  // namespace psygen::inspect
