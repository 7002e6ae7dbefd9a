// Draw lists of a game's objects, point lights and particle emitters, and the systems that fill
// them. Values; main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/render/types.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/objects/effects.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/scene/view/visibility.hpp"
#include "engine/synthesis/mesh_key.hpp"

namespace psygen::scene {

class Assets;

struct ObjectDraws {
  std::vector<render::ObjectDraw> objects;
  std::vector<synthesis::MeshHandle> meshes;  // of objects in view
  DrawnTick last;
  ObjectCounts counts;
};

struct LightDraws {
  std::vector<render::PointLight> lights;
  DrawnTick last;
  LightCounts counts;
};

struct ParticleDraws {
  std::vector<render::ParticleDraw> emitters;  // back to front
  ParticleCounts counts;
};

// Bundle: all lists of this room.
struct SceneDraws {
  const ObjectDraws& objects;
  const LightDraws& lights;
  const ParticleDraws& particles;
};

// Bundle: everything that objects_system() writes besides components.
struct ObjectWork {
  synthesis::MeshSupply& supply;
  Assets& assets;
  ObjectDraws& draws;
};

// System: draws the objects in view whose meshes are ready, each at the LOD for its distance, and
// fades them in and out. Meshes that objects lack are wanted in the next tick (Assets).
using ObjectQuery = ecs::Query<const Transform, const GroundSunlight, Object>;
void objects_system(RenderContext context, ObjectQuery entities, ObjectWork work);

// System: chooses the point lights that light the frame, at most 32, and fades others out.
// O(lights).
using LightQuery = ecs::Query<const Transform, PointLight>;
void lights_system(FrameContext frame, const Camera& camera, const WorldFacts& facts,
                   const View& view, LightQuery entities, LightDraws& draws);

// System: chooses the emitters that are drawn, nearest first. O(emitters).
using ParticleQuery = ecs::Query<const Transform, const ParticleEmitter, const GroundSunlight>;
void particles_system(FrameContext frame, const Camera& camera, const WorldFacts& facts,
                      VisibleNodes nodes, ParticleQuery entities, ParticleDraws& draws);

// True for a position within 10⁹ m of its block. NaN is not.
bool is_place(const core::WorldPosition& position);
// True if the position is valid, the rotation is not zero, and the scale is 10⁻⁴ … 10⁴ along each
// axis.
bool is_valid(const Transform& transform);

// A position relative to the camera, in metres.
inline glm::vec3 offset_of(const core::WorldPosition& position, const core::WorldPosition& camera,
                           double block_size_m) {
  return glm::vec3(core::offset_m(position.block, camera, block_size_m) + position.local);
}

}  // namespace psygen::scene
