// The input with which vertex layouts and passes create what they own, and the descriptor set of a
// pass: a set for each frame in flight, and the layout of the pass's pipelines. Its images and
// buffers belong to others. Main thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/render/device/pipeline_build.hpp"
#include "engine/render/frame/frame_sets.hpp"
#include "engine/render/memory/memory.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/text/overlay_layout.hpp"

namespace psygen::render {

// A set of features.
class Features {
 public:
  bool has(Feature feature) const { return (bits_ & bit(feature)) != 0; }
  void add(Feature feature) { bits_ |= bit(feature); }
  void add(const Features& others) { bits_ |= others.bits_; }

 private:
  static std::uint8_t bit(Feature feature) {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(feature));
  }
  std::uint8_t bits_ = 0;
};

// Valid during create().
struct PassSetup {
  const Device& device;
  const PresetTraits& traits;
  const FrameSets& sets;
  PipelineMaker& pipelines;
  const OverlayLayout& overlay;
  bool reflections = false;  // water reflects the land (Targets::reflection)
  Features features;         // that must be drawable from now on
};

// Empty until create(). The device must outlive it.
class PassSet {
 public:
  // Creates a set for each frame in flight. `before`: the layouts of the sets with lower numbers
  // (FrameSets::shared(), or none).
  core::Result<void> create(const PassSetup& setup, std::span<const SetBinding> bindings,
                            std::span<const VkDescriptorSetLayout> before);
  bool exists() const { return sets_.exists(); }
  // The layout of pipelines with this set.
  VkPipelineLayout layout() const { return layout_.get(); }

  // Names an image, or a buffer, in a slot's set that no unfinished commands use.
  void write(const Device& device, std::size_t slot, std::uint32_t binding,
             const VkDescriptorImageInfo& image) const {
    sets_.write(device, slot, binding, image);
  }
  void write(const Device& device, std::size_t slot, std::uint32_t binding,
             const Buffer& buffer) const {
    sets_.write(device, slot, binding, buffer.buffer.get());
  }
  // Names the buffers of all slots; `bytes`: of each that shaders see at once.
  void write(const Device& device, std::uint32_t binding, const SlotBuffer& buffers,
             VkDeviceSize bytes = VK_WHOLE_SIZE) const;
  // Copies `bytes` into a slot's buffer, and names that again if it was replaced.
  core::Result<void> fill(const Device& device, std::size_t slot, std::uint32_t binding,
                          SlotBuffer& buffers, std::span<const std::byte> bytes) const;
  // Binds the set of a slot. `offset`: of the dynamic buffer, if the set has one.
  void bind(const Device& device, VkCommandBuffer commands, std::size_t slot,
            std::optional<std::uint32_t> offset = {}) const;

 private:
  DescriptorSets sets_;
  UniquePipelineLayout layout_;
  std::uint32_t number_ = 0;
};

}  // namespace psygen::render
