// The sounds of the game, made by code: no file is read. Pure functions; some milliseconds each,
// the music about a tenth of a second.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/audio/clip.hpp"

namespace cairns {

using namespace psygen;
using ClipPtr = std::shared_ptr<const audio::Clip>;

ClipPtr wind_sound();  // loops, as those that follow
ClipPtr rain_sound();
ClipPtr water_sound();
ClipPtr fire_sound();
ClipPtr music_sound(std::uint64_t seed);  // a minute of slow chords
ClipPtr step_sound(float hardness);       // 0 snow … 1 rock
ClipPtr splash_sound();
ClipPtr chop_sound();
ClipPtr fall_sound();  // of a tree
ClipPtr stone_sound();
ClipPtr bird_sound(int which);
ClipPtr chime_sound();  // a cairn is found

}  // namespace cairns
