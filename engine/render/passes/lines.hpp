// Lines of debugging views and tools, in the landscape. Private to engine/render.
#pragma once

#include <vector>

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Empty until create(). The device and the sets of the frame must outlive it.
class Lines {
 public:
  // The functions of Pass (pass.hpp). Without a warm-up: games in play have no lines.
  static constexpr Stage kStage = Stage::kSurface;
  core::Result<void> create(const PassSetup& setup);
  void list(const FrameInput& input, const FrameFacts&);
  core::Result<void> write(const Device& device, std::size_t slot);
  void record(const Recording& to) const;

 private:
  PassSet set_;
  SlotBuffer ends_;
  std::vector<shaders::OverlayVertex> listed_;  // two for each line
  UniquePipeline pipeline_;
};
static_assert(Pass<Lines>);

}  // namespace psygen::render
