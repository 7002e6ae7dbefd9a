// The pictures of a scene's trees (world/far/tree_pictures.hpp): which there are, asking for those
// that the renderer lacks, and giving them to it. Modelers bake them, as what is noted of a request
// (mesh_notes.hpp). The trees that show them have quads of their own (nodes/columns.hpp). Main
// thread.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Finds the pictures of the world's trees, which take the place of another scene's, adds the types
// of their meshes to the registry, and gives the renderer a rough stand-in for each. There are none
// without levels of detail, none with data amplification, which makes all levels of all meshes
// once, and none where the renderer has no room: that is said in the log.
core::Result<void> find_pictures(const Settings& settings, WorldFacts& facts, Output& output);

// Wants the pictures that the renderer lacks. Part of the cache system.
void want_pictures(const WorldFacts& facts, const Output& output, synthesis::MeshSupply& meshes);

// Gives a finished picture to the renderer, and returns whether the request was for one. What could
// not be made keeps its stand-in. Waits for the device. Part of the upload system.
bool take_picture(const synthesis::Completion& job, const WorldFacts& facts,
                  synthesis::MeshSupply& meshes, Output& output);

}  // namespace psygen::scene
