// The frame record of a tick. Main thread only.
#pragma once

#include "engine/scene/draws/draw_lists.hpp"
#include "engine/scene/meshes/scene_meshes.hpp"
#include "engine/telemetry/frame_log.hpp"

namespace psygen::scene {

struct Telemetry {
  telemetry::FrameRecord record;  // of the last tick; a flight adds times to a copy
  synthesis::CacheStats cache;    // at the end of the last tick
};

// System: records the tick.
void telemetry_system(const Clock& clock, const Quality& quality, const SceneMeshes& meshes,
                      const DrawLists& draws, const synthesis::MeshSupply& supply,
                      Telemetry& telemetry);

}  // namespace psygen::scene
