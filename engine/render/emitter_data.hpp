// An emitter of particles as the shaders read it. Pure; any thread. Private to engine/render.
#pragma once

#include "engine/render/particles.hpp"
#include "shaders/shared.h"

namespace psygen::render {

shaders::EmitterData data_of(const ParticleDraw& draw);

}  // namespace psygen::render
