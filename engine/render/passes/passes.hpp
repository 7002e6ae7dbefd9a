// All passes, in the order of a frame. A new pass is its include and one line here. Private to
// engine/render.
#pragma once

#include <tuple>

#include "engine/render/passes/landscape.hpp"
#include "engine/render/passes/lines.hpp"
#include "engine/render/passes/overlay.hpp"
#include "engine/render/passes/particles.hpp"
#include "engine/render/passes/scale_up.hpp"
#include "engine/render/passes/shadows.hpp"
#include "engine/render/passes/sky.hpp"
#include "engine/render/passes/water.hpp"

namespace psygen::render {

using Passes = std::tuple<  //
    Shadows,                // the sun's cascades
    Landscape,              // ground, models and objects
    Sky,                    // behind them
    Water,                  // blended over both
    Particles,              //
    Lines,                  // of debugging views
    ScaleUp,                // a landscape of fewer pixels
    Overlay>;               // text and ImGui

// Calls visit(pass) for each pass, in order.
template <class AnyPasses, class Visit>
void for_each_pass(AnyPasses& passes, const Visit& visit) {
  std::apply([&](auto&... pass) { (visit(pass), ...); }, passes);
}

// The same for a `visit` that returns a Result<void>; ends at the first error.
template <class AnyPasses, class Visit>
core::Result<void> try_each_pass(AnyPasses& passes, const Visit& visit) {
  core::Result<void> done;
  std::apply([&](auto&... pass) { (void)((done = visit(pass), done.has_value()) && ...); }, passes);
  return done;
}

static_assert(
    []<class... P>(std::type_identity<std::tuple<P...>>) {
      Stage last = Stage::kBefore;
      return ((P::kStage >= last && (last = P::kStage, true)) && ...);
    }(std::type_identity<Passes>{}),
    "passes are listed in the order of their stages");

}  // namespace psygen::render
