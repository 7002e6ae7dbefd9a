// Synthesises the sounds of the game; no file is read. Pure functions of a few milliseconds each;
// the music takes about 0.1 s.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/audio/clip.hpp"

namespace cairns {

using namespace psygen;
using ClipPtr = std::shared_ptr<const audio::Clip>;

ClipPtr wind_sound();  // this one and the next four are loops
ClipPtr rain_sound();
ClipPtr water_sound();
ClipPtr fire_sound();
ClipPtr music_sound(std::uint64_t seed);  // a minute of slow chords
ClipPtr step_sound(float hardness);       // 0 (snow) to 1 (rock)
ClipPtr splash_sound();
ClipPtr chop_sound();
ClipPtr fall_sound();  // a falling tree
ClipPtr stone_sound();
ClipPtr bird_sound(int which);
ClipPtr chime_sound();  // a discovered cairn

}  // namespace cairns
