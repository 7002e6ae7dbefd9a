// What a session is told about as JSON: figures, times of systems, entities, the text of the world.
// Reads, changes nothing. Main thread.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"
#include "engine/scene/state.hpp"

namespace psygen::app {
class Session;
}

namespace psygen::inspect {

using Json = nlohmann::ordered_json;

// What frames were like since the last answer about them.
struct FrameNotes {
  std::uint64_t frames = 0;   // of the visit
  std::uint64_t figures = 0;  // since the last answer
  double longest_ms = 0, sum_ms = 0, synthesis_s = 0;
  double last_frame_s = 0;  // when the last one ended, on the real clock; 0: there was none
  double figures_since_s = 0;
  std::uint64_t timed = 0;  // for systems()
  std::vector<double> system_sum_ms, system_longest_ms;

  void note(const scene::State& state);
};

Json figures(const app::Session& session, FrameNotes& notes);
Json systems(const scene::State& state, FrameNotes& notes);
// Counts of entities by kind, and the nodes for a map, coarse ones first.
Json entities(const scene::State& state);

Json pose_json(const core::CameraPose& pose);
core::Result<core::CameraPose> pose_from(const Json& json, double block_m);

// The text of the world of a session: that of its file where it is the same world, else one that is
// written from its values.
std::string world_text(const app::Session& session);

}  // namespace psygen::inspect
