// Compute culling: all candidates of a frame go to the device. A shader tests which are in view
// and writes the commands of indirect draws, one call per group with the same pipeline and buffers.
// With occlusion there are two phases. The first draws the candidates that were visible in the last
// frame, and a pyramid is made of their depth. The second tests everything in view against the
// pyramid, stores what is visible now, and draws the newly visible candidates. So no visible
// candidate is left out, and hidden ones are left out from the third frame on. Main thread. Private
// to engine/render.
#pragma once

#include <array>

#include "engine/render/meshes/candidate_list.hpp"
#include "engine/render/meshes/view_volume.hpp"
#include "engine/render/passes/depth_pyramid.hpp"

namespace psygen::render {

// The buffers and pipelines of culling. Empty until create() and resize().
class GpuCulling {
 public:
  // Creates everything that does not depend on the size. `samples` per pixel of the picture;
  // `slots` frames in flight.
  core::Result<void> create(const Device& device, bool occlusion, VkSampleCountFlagBits samples,
                            std::size_t slots);
  // Prepares for pictures of this size with this depth. The device must be idle.
  core::Result<void> resize(const Device& device, core::Extent size, const Image& depth);

  // Sets the candidates of the following frames, until the next call. Linear in the draws.
  // `size`: of the landscape in pixels.
  void set_frame(const FrameInput& input, const shaders::FrameData& frame, core::Extent size,
                 const ListFacts& facts);
  // Copies them into the buffers of a slot whose last frame has finished. Fails with kOutOfMemory
  // if the buffers cannot grow.
  core::Result<void> write(const Device& device, std::size_t slot);

  // The data of draws, which the slot's vertex shaders read.
  const Buffer& draw_data(std::size_t slot) const { return slots_[slot].draws; }

  // Recording a frame of a slot: record_first() before the first pass. If two_passes(),
  // record_second() between the passes; it reads the depth of the first. record_counts() after the
  // last pass. In each pass, draw_group() for every group records its draws of phase 0 or 1.
  bool two_passes() const { return occlusion_; }
  void record_first(const Device& device, VkCommandBuffer commands, std::size_t slot);
  void record_second(const Device& device, VkCommandBuffer commands, std::size_t slot,
                     const Image& depth) const;
  void record_counts(const Device& device, VkCommandBuffer commands, std::size_t slot) const;
  std::span<const DrawGroup> groups() const { return list_.groups(); }
  struct GroupDraw {
    std::size_t slot = 0, group = 0;
    std::uint32_t phase = 0;
  };
  void draw_group(const Device& device, VkCommandBuffer commands, const GroupDraw& draw) const;

  // Numbers of one frame.
  struct Counts {
    std::uint32_t draws = 0;
    std::uint64_t triangles = 0;
  };
  // The numbers of the slot's last frame, which must have finished.
  Counts read_counts(std::size_t slot) const;
  // The meshes that this frame drew, in any order. Waits for the device. Only allowed until the
  // next set_frame().
  core::Result<std::vector<DrawnMesh>> read_drawn(const Device& device, std::size_t slot) const;

 private:
  struct Slot {
    Buffer frame, candidates, groups;                  // from the CPU
    Buffer commands, draws, counts;                    // of both phases, on the device
    Buffer counts_back;                                // copy for the CPU
    std::uint32_t group_count = 0, command_count = 0;  // of the last frame written
  };
  core::Result<void> grow(const Device& device, std::size_t slot);
  core::Result<void> grow_seen(const Device& device);
  void write_sets(const Device& device, std::size_t slot) const;
  void dispatch(const Device& device, VkCommandBuffer commands, std::size_t slot,
                std::uint32_t phase) const;

  bool occlusion_ = true;
  ComputePipeline pipeline_;
  DepthPyramid pyramid_;
  CandidateList list_;
  shaders::CullFrame frame_{};
  std::vector<Slot> slots_;
  // A bit per mesh: visible in the last frame, and in this one. They are swapped every frame.
  std::array<Buffer, 2> seen_;
  std::size_t now_ = 0;  // index of the one that the last recorded frame writes
};

}  // namespace psygen::render
