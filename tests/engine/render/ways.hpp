// The ways of drawing that tests of the renderer are run for.
#pragma once

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"

namespace psygen::render {

using How = std::tuple<RenderPath, Submission, Preset>;

// Every path and submission, with light per vertex and per pixel.
inline auto in_every_way() {
  return testing::ValuesIn(
      std::vector<How>{{RenderPath::kCpu, Submission::kPushed, Preset::kLow},
                       {RenderPath::kCpu, Submission::kMultiDraw, Preset::kLow},
                       {RenderPath::kGpu, Submission::kMultiDraw, Preset::kLow},
                       {RenderPath::kCpu, Submission::kPushed, Preset::kHigh},
                       {RenderPath::kGpu, Submission::kMultiDraw, Preset::kHigh},
                       {RenderPath::kGpu, Submission::kMultiDraw, Preset::kUltra}});
}

}  // namespace psygen::render
