// Text and rectangles over the picture: a game's HUD, panels, and ImGui. Private to engine/render.
#pragma once

#include <vector>

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Empty until create(). The device and the sets of the frame must outlive it.
class Overlay {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kPicture;
  static constexpr int warm_up_steps(Feature feature) {
    return feature == Feature::kLandscape ? 1 : 0;
  }
  core::Result<void> create(const PassSetup& setup);
  void list(const FrameInput& input, const FrameFacts& facts);
  // Inserts a background of the whole picture before all that is listed.
  void put_background(const FrameFacts& facts) {
    facts.overlay.put_ground_under(facts.size, glyphs_);
    text_count_ = static_cast<std::uint32_t>(glyphs_.size());
  }
  core::Result<void> write(const Device& device, std::size_t slot);
  void record(const Recording& to) const;
  void warm_up(const Recording& to, const WarmUpStep& step) const;

 private:
  void bind(const Recording& to) const;

  PassSet set_;
  Image font_;
  SlotBuffer vertices_;
  std::vector<shaders::OverlayVertex> glyphs_;  // text, then ImGui's
  std::vector<GuiRun> gui_runs_;
  std::uint32_t text_count_ = 0;          // vertices of text
  UniquePipeline landscape_, full_size_;  // in the rendering of the landscape, and after scaling up
};
static_assert(Pass<Overlay>);

}  // namespace psygen::render
