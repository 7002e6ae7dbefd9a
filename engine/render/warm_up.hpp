// Draws with pipelines before they are needed, so that the driver compiles them then and not in the
// middle of a flight. Records only. Main thread. Private to engine/render.
#pragma once

#include "engine/render/scene_recorder.hpp"

namespace psygen::render {

// Records a draw with each pipeline of the landscape, of triangles that cover nothing, to make the
// driver compile them. `step` is 0 … kWarmUpSteps − 1; each is one submission, because compiling
// may take long. `blank` is the start of SharedIndexLists::buffer().
inline constexpr int kWarmUpSteps = 5;
void record_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                    Targets& targets, VkBuffer blank, int step, bool lamps = false);

// The first kLampWarmUpSteps of these draw with point lights too, if the pipelines exist.
inline constexpr int kLampWarmUpSteps = 4;

// The same for the pipelines of objects, which must exist. kObjectWarmUpSteps submissions.
inline constexpr int kObjectWarmUpSteps = 2;
void record_object_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                           Targets& targets, VkBuffer blank, VkDescriptorSet textures, int step,
                           bool lamps);

// The same for those of particles: without and with a texture.
inline constexpr int kParticleWarmUpSteps = 2;
void record_particle_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                             Targets& targets, VkDescriptorSet textures, int step);

}  // namespace psygen::render
