// Predefined kinds of particles, which a game uses as they are or changes. Pure; any thread.
#pragma once

#include "engine/render/types.hpp"

namespace psygen::scene {

// Smoke of a chimney: rises, grows, thins, and drifts with the wind (m/s).
render::ParticleKind smoke(glm::vec3 wind = {0.6F, 0, 0.2F});
// A camp fire half a metre wide. It glows, but lights nothing: add a PointLight.
render::ParticleKind fire();
// Sparks that fly up and fall. For a burst set a high rate, and ParticleEmitter::stop_s soon after
// start_s.
render::ParticleKind sparks();
// Leaves that fall from a tree, in a box of 6 × 2 × 6 m around the emitter.
render::ParticleKind leaves(glm::vec3 wind = {0.8F, 0, 0.3F});
// Weather around the camera, wherever the emitter is. Roofs do not stop it.
render::ParticleKind rain(glm::vec3 wind = {1.0F, 0, 0.4F});
render::ParticleKind snow(glm::vec3 wind = {0.5F, 0, 0.2F});

}  // namespace psygen::scene
