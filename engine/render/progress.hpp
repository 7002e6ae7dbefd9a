// How something long asks whether it shall go on. Private to engine/render.
#pragma once

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// kInterrupted where `progress` says so.
inline core::Result<void> go_on(const Progress& progress, double fraction) {
  if (!progress || progress(fraction)) return {};
  return core::fail(core::ErrorCode::kInterrupted, "the renderer was given up while it was made");
}

}  // namespace psygen::render
