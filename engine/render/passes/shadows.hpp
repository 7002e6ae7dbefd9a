// The sun's shadows: the meshes of the frame, drawn into each cascade. Private to engine/render.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Its images and renderings are those of FrameSets::shadows(), its pipelines those of MeshTables.
class Shadows {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kBefore;
  void list(const FrameInput&, const FrameFacts& facts) { active_ = facts.frame.shadow.y > 0; }
  void record(const Recording& to) const;

 private:
  bool active_ = false;  // the preset has cascades, and the sun shines
};
static_assert(Pass<Shadows>);

}  // namespace psygen::render
