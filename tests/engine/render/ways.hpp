// The ways of drawing that tests of the renderer are run for. Under the thread sanitizer the first
// and the last are enough: what the others have of their own knows no threads.
#pragma once

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "engine/render/preset.hpp"
#include "engine/render/render_path.hpp"
#include "engine/render/renderer.hpp"

namespace psygen::render {

using How = std::tuple<RenderPath, Submission, Preset>;

template <class Way>
auto in_ways(std::vector<Way> ways) {
#ifdef __SANITIZE_THREAD__
  if (ways.size() > 2) ways.erase(ways.begin() + 1, ways.end() - 1);
#endif
  return testing::ValuesIn(ways);
}

// Every path and submission, with light per vertex and per pixel.
inline auto in_every_way() {
  return in_ways<How>({{RenderPath::kCpu, Submission::kPushed, Preset::kLow},
                       {RenderPath::kCpu, Submission::kMultiDraw, Preset::kLow},
                       {RenderPath::kGpu, Submission::kMultiDraw, Preset::kLow},
                       {RenderPath::kCpu, Submission::kPushed, Preset::kHigh},
                       {RenderPath::kGpu, Submission::kMultiDraw, Preset::kHigh},
                       {RenderPath::kGpu, Submission::kMultiDraw, Preset::kUltra}});
}

}  // namespace psygen::render
