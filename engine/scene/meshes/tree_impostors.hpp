// The impostors of a scene's trees (world/far/tree_impostors.hpp): requests those that the renderer
// lacks, and gives them to it. Modelers bake them as annotations of requests
// (mesh_annotations.hpp). Trees that show them have quads as meshes (nodes/mesh_entity.hpp). Main
// thread.
#pragma once

#include "engine/scene/meshes/scene_meshes.hpp"

namespace psygen::world {
class ImpostorSet;
}

namespace psygen::scene {

// Gives the renderer a rough stand-in for each impostor. If it has as many of this scene already,
// they stay until the new ones are baked, and for good if they equal those of `before` (may be
// null). Returns false if the renderer has no room, and logs it.
bool show_stand_ins(const WorldFacts& facts, const world::ImpostorSet* before, SceneMeshes& meshes,
                    Output& output);

// Wants the impostors that the renderer lacks. Part of the cache system.
void want_pictures(const WorldFacts& facts, const SceneMeshes& meshes,
                   synthesis::MeshSupply& supply);

// Drops finished impostors of a world that will be replaced, if the renderer does not have them.
void forget_pictures(const WorldFacts& facts, synthesis::MeshSupply& supply);

// Gives a finished impostor to the renderer. Returns true if the request was for an impostor. After
// a failure the stand-in stays. Waits for the device. Part of the upload system.
bool take_picture(const synthesis::Completion& job, const WorldFacts& facts,
                  const UploadWork& work);

}  // namespace psygen::scene
