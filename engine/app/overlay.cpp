#include "engine/app/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace psygen::app {

void Overlay::add_frame(double frame_ms) {
  frame_ms_[count_++ % kFrames] = frame_ms;
}

std::vector<std::string> Overlay::lines(const scene::State& state,
                                        const render::DeviceInfo& device) const {
  std::array<double, kFrames> sorted = frame_ms_;
  const std::size_t count = std::min(count_, kFrames);
  if (count == 0) return {};
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count));
  const double median_ms = sorted[count / 2], worst_ms = sorted[count - 1];
  const telemetry::FrameRecord& record = state.record;
  constexpr double kMiB = 1 << 20;
  const core::WorldPosition& at = state.camera.pose.position;
  const std::optional<render::GpuTime>& gpu = state.counters.frame.gpu;
  const std::string device_ms = gpu ? fmt::format("   device {:5.1f} ms", gpu->ms) : "";
  return {
      fmt::format("{:5.1f} fps   {:5.1f} ms median   {:5.1f} ms worst   waits {:5.1f} ms{}",
                  1000.0 / median_ms, median_ms, worst_ms, record.wait_ms(), device_ms),
      fmt::format("{} triangles   {} draws   {} nodes in view   {:.1f} px error", record.triangles,
                  record.draws, record.nodes_in_view, record.error_pixels),
      fmt::format("cache {:.0f} of {:.0f} MiB   {} missing   {} coarse",
                  static_cast<double>(record.cache_bytes) / kMiB,
                  static_cast<double>(state.settings.budget_bytes) / kMiB, record.holes,
                  record.coarse_nodes),
      fmt::format("{} requests   {} models this frame   modelers: {}", record.requests_queued,
                  record.models_synthesised, state.settings.modelers),
      fmt::format("block {}, {}   {:.0f} m high   {}", at.block.x, at.block.z, at.local.y,
                  device.name),
      "W A S D Q E fly   right button looks   F1 hides this   F2 views   F12 picture   Esc ends",
  };
}

}  // namespace psygen::app
