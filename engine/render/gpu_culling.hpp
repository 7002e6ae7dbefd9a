// Compute culling: the candidates of a frame go to the device as they are; a shader tests what is
// in view, chooses levels of detail and writes the commands of indirect draws, one call for each
// group of the same pipeline and buffers. With occlusion in two phases: first what was seen in the
// last frame is drawn; from its depth a pyramid is made; then all that is in view is tested against
// that, which says what was seen in this frame, and what is newly seen is drawn. So nothing visible
// is ever left out, and what is hidden is left out from the third frame on. Private to
// engine/render.
#pragma once

#include <array>

#include "engine/render/candidate_list.hpp"
#include "engine/render/depth_pyramid.hpp"
#include "engine/render/draw_choice.hpp"

namespace psygen::render {

class GpuCulling {
 public:
  // `slots` frames in flight, of pictures with so many samples per pixel.
  core::Result<void> create(const Device& device, bool occlusion, VkSampleCountFlagBits samples,
                            std::size_t slots);
  // For pictures of this size with this depth. The device must be idle.
  core::Result<void> resize(const Device& device, core::Extent size, const Image& depth);

  // The candidates of the next frames, until this is called again.
  void set_frame(const ViewTest& test, const shaders::FrameData& frame, const FrameInput& input,
                 core::Extent size, std::span<const IndexList> lists);
  // Copies them into the buffers of a slot whose last frame has finished (kOutOfMemory).
  core::Result<void> write(const Device& device, std::size_t slot);

  // What the slot's vertex shaders read.
  const Buffer& draw_data(std::size_t slot) const { return slots_[slot].draws; }

  // A frame of a slot: record_first() before the first pass; where two_passes(), record_second()
  // between the passes, which needs the depth of the first; record_counts() after the last.
  // In each pass draw_group() for every group, which issues its commands of phase 0 or 1.
  bool two_passes() const { return occlusion_; }
  void record_first(const Device& device, VkCommandBuffer commands, std::size_t slot);
  void record_second(const Device& device, VkCommandBuffer commands, std::size_t slot,
                     const Image& depth) const;
  void record_counts(const Device& device, VkCommandBuffer commands, std::size_t slot) const;
  std::span<const DrawGroup> groups() const { return list_.groups(); }
  void draw_group(const Device& device, VkCommandBuffer commands, std::size_t slot,
                  std::size_t group, std::uint32_t phase) const;

  // Of the slot's last frame, which has finished.
  struct Counts {
    std::uint32_t draws = 0;
    std::uint64_t triangles = 0;
  };
  Counts read_counts(std::size_t slot) const;
  // What it drew, in any order; only while set_frame() has not been called since. Waits.
  core::Result<std::vector<DrawnMesh>> read_drawn(const Device& device, std::size_t slot) const;

 private:
  struct Slot {
    Buffer frame, candidates, levels, groups;          // from the CPU
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
  // A bit for each name: seen in the last frame, in this one; they change places in every frame.
  std::array<Buffer, 2> seen_;
  std::size_t now_ = 0;  // which of them is written by the frame recorded last
};

}  // namespace psygen::render
