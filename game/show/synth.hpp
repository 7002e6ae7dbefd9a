// Synthesises the sounds of the game; no file is read. Pure. Each takes a few milliseconds, and the
// music about 0.1 s.
#pragma once

#include <array>
#include <memory>

#include "engine/audio/clip.hpp"

namespace cairns {

using namespace psygen;
using ClipPtr = std::shared_ptr<const audio::Clip>;

// All clips of the game. The first four are loops; the music is a minute of slow chords.
struct Clips {
  ClipPtr wind, rain, water, fire, music, splash, chop, fall, stone, chime;
  std::array<ClipPtr, 3> steps, birds;  // steps from snow to rock
};
Clips make_clips();

}  // namespace cairns
