#include "engine/render/passes/sky.hpp"

namespace psygen::render {

using core::Result;

Result<void> Sky::create(const PassSetup& setup) {
  if (sky_.exists()) return {};
  const bool dome = !setup.traits.pixel_light;
  const VkPipelineLayout layout = setup.sets.layout();
  PipelineShape sky{.vert = Shader::kSkyVert, .frag = Shader::kSkyFrag};
  sky.constants = {VK_FALSE, on(setup.traits.fine_grain)};
  if (!dome) return setup.pipelines.make(layout, sky, sky_);
  PipelineShape below = sky, sun = sky;
  sky.vert = Shader::kSkyDomeVert;
  sky.frag = Shader::kSkyDomeFrag;
  below.vert = Shader::kSkyBelowVert;
  sun.vert = Shader::kSunVert;
  sky.topology = below.topology = sun.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  sun.blend = Blend::kAlpha;
  sun.constants = {VK_TRUE, VK_FALSE};
  return setup.pipelines.make(layout, sky, sky_)
      .and_then([&] { return setup.pipelines.make(layout, below, below_); })
      .and_then([&] { return setup.pipelines.make(layout, sun, sun_); });
}

void Sky::record(const Recording& to) const {
  if (!sun_.exists()) {
    to.bind_pipeline(sky_.get());
    return to.draw(3);
  }
  to.bind_pipeline(below_.get());
  to.draw(2 * PSYGEN_BELOW_SIDES + 1);
  to.bind_pipeline(sky_.get());
  to.draw(PSYGEN_DOME_COLUMNS * PSYGEN_DOME_STRIP);
  to.bind_pipeline(sun_.get());
  to.draw(4);
}

}  // namespace psygen::render
