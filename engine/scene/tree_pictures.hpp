// The pictures of a scene's trees (world/far/tree_pictures.hpp): which there are, asking for those
// that the renderer lacks, and giving them to it. Modelers bake them, as what is noted of a request
// (mesh_notes.hpp). The trees that show them have quads of their own (nodes/columns.hpp). Main
// thread.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Finds the pictures of the world's trees and adds the types of their meshes to the registry. There
// are none without levels of detail, and none with data amplification, which makes all levels of
// all meshes once. What was measured for those `before` (may be null) is taken over.
core::Result<void> find_pictures(const Settings& settings, WorldFacts& facts,
                                 const world::PictureSet* before);

// Gives the renderer a rough stand-in for each, in place of what it had. Where it has as many of
// this scene already, they stay until the new ones are made, and for good where they are those of
// `before` (may be null). False if the renderer has no room: that is said in the log.
bool show_stand_ins(const WorldFacts& facts, const world::PictureSet* before, Output& output);

// Wants the pictures that the renderer lacks. Part of the cache system.
void want_pictures(const WorldFacts& facts, const Output& output, synthesis::MeshSupply& meshes);

// Of a world that is about to be replaced: pictures that were finished and that the renderer has
// not got.
void forget_pictures(const WorldFacts& facts, synthesis::MeshSupply& meshes);

// Gives a finished picture to the renderer, and returns whether the request was for one. What could
// not be made keeps its stand-in. Waits for the device. Part of the upload system.
bool take_picture(const synthesis::Completion& job, const WorldFacts& facts,
                  synthesis::MeshSupply& meshes, Output& output);

}  // namespace psygen::scene
