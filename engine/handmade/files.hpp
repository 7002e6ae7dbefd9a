// Reads the files that a world file names beside itself (world/files/files_beside.hpp): glTF models
// as model types with levels of detail, and pictures as grey values. Not for objects of a game with
// textures and animations (engine/prefab). Any thread; too slow for the tick.
#pragma once

#include "engine/world/files/files_beside.hpp"

namespace psygen::handmade {

// The reader of this program. Models of .glb files that some registry still has are not read again,
// unless their file has changed.
const world::FilesBeside& files();

}  // namespace psygen::handmade
