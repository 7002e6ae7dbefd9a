// Records a frame: begins and ends Vulkan's renderings between the stages of its passes. It submits
// nothing. Main thread. Private to engine/render.
#pragma once

#include "engine/render/passes/passes.hpp"

namespace psygen::render {

// Records a whole frame, between slot.begin() and slot.end(). Afterwards the colour target is in
// the layout of an attachment.
void record_frame(const Passes& passes, const Recording& to);

// Records a frame with only text and its background.
void record_text(const Passes& passes, const Recording& to);

// Number of submissions that draw all pipelines of a feature once.
int warm_up_steps(const Passes& passes, Feature feature);
// Records submission step.number, 0 … warm_up_steps(passes, step.feature) − 1.
// `textures`: a set with textures of a material, or null if no shader of the feature reads one.
void record_warm_up(const Passes& passes, const Recording& to, WarmUpStep step,
                    VkDescriptorSet textures);

}  // namespace psygen::render
