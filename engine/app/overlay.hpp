// The small table of figures in the window's corner. Pure text; the renderer draws it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/render/types.hpp"
#include "engine/scene/state.hpp"

namespace psygen::app {

class Overlay {
 public:
  void add_frame(double frame_ms);
  std::vector<std::string> lines(const scene::State& state, const render::DeviceInfo& device) const;

 private:
  static constexpr std::size_t kFrames = 60;
  std::array<double, kFrames> frame_ms_{};
  std::size_t count_ = 0;
};

}  // namespace psygen::app
