// The input with which vertex layouts and passes create their pipelines, images and buffers. Valid
// during create(). Private to engine/render.
#pragma once

#include <cstdint>

#include "engine/render/device/pipeline_build.hpp"
#include "engine/render/frame/frame_sets.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/text/overlay_layout.hpp"

namespace psygen::render {

// A set of features.
class Features {
 public:
  bool has(Feature feature) const { return (bits_ & bit(feature)) != 0; }
  void add(Feature feature) { bits_ |= bit(feature); }

 private:
  static std::uint8_t bit(Feature feature) {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(feature));
  }
  std::uint8_t bits_ = 0;
};

struct PassSetup {
  const Device& device;
  const PresetTraits& traits;
  const FrameSets& sets;
  PipelineMaker& pipelines;
  const OverlayLayout& overlay;
  bool reflections = false;  // water reflects the land (Targets::reflection)
  Features features;         // that must be drawable from now on
};

}  // namespace psygen::render
