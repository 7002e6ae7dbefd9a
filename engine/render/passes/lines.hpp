// Lines of debugging views and tools, in the landscape. Private to engine/render.
#pragma once

#include <vector>

#include "engine/render/frame/pass_set.hpp"
#include "engine/render/memory/slot_buffer.hpp"
#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Empty until create(). The device and the sets of the frame must outlive it.
class Lines {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr PassInfo kInfo{.name = "lines", .stage = Stage::kSurface};
  static constexpr int warm_up_steps(Feature) { return 0; }  // only views have lines
  core::Result<void> create(const PassSetup& setup);
  void list(const FrameInput& input, const FrameFacts&);
  core::Result<void> write(const Device& device, std::size_t slot);
  void record(const Recording& to) const;
  void warm_up(const Recording&, const WarmUpStep&) const {}

 private:
  PassSet set_;
  SlotBuffer ends_;
  std::vector<shaders::OverlayVertex> listed_;  // two for each line
  UniquePipeline pipeline_;
};
static_assert(Pass<Lines>);

}  // namespace psygen::render
