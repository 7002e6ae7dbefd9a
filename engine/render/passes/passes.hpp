// All passes, in the order of a frame, and their recording: Vulkan's renderings begin and end
// between the stages of the passes. A new pass is its include and one line here. It submits
// nothing. Main thread. Private to engine/render.
#pragma once

#include <tuple>
#include <type_traits>

#include "engine/render/passes/landscape.hpp"
#include "engine/render/passes/lines.hpp"
#include "engine/render/passes/overlay.hpp"
#include "engine/render/passes/particles.hpp"
#include "engine/render/passes/scale_up.hpp"
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

static_assert(std::tuple_size_v<Passes> == kPassNames.size(), "each pass has a name");
static_assert(std::is_same_v<std::tuple_element_t<0, Passes>, Shadows> &&
                  kPassNames[0] == "shadows",
              "GpuTimer::Mark::kShadows is the end of pass 0");

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

// Records a whole frame, between slot.begin() and slot.end(). Afterwards the colour target is in
// the layout of an attachment.
void record_frame(const Passes& passes, const Recording& to);

// Records a frame with only text and its background.
void record_text(const Passes& passes, const Recording& to);

// Number of submissions that draw all pipelines of a feature once.
int warm_up_steps(const Passes& passes, Feature feature);
// Records submission step.number, 0 … warm_up_steps(passes, step.feature) − 1.
// `textures`: a set with textures of a material, or null if no shader of the feature reads one.
void record_warm_up(const Passes& passes, const Recording& to, WarmUpStep step,
                    VkDescriptorSet textures);

}  // namespace psygen::render
