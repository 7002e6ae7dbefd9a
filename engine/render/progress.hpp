// The check by which a long operation asks whether to continue. Private to engine/render.
#pragma once

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// Reports `fraction` in [0, 1]. Fails with kInterrupted if `progress` returns false; an empty one
// never does.
inline core::Result<void> go_on(const Progress& progress, double fraction) {
  if (!progress || progress(fraction)) return {};
  return core::fail(core::ErrorCode::kInterrupted, "the renderer was given up while it was made");
}

}  // namespace psygen::render
