#include "engine/app/hud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/models/terrain/terrain.hpp"
#include "engine/render/preset.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/settings.hpp"
#include "engine/scene/view/debug_colours.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/world.hpp"

namespace psygen::app {
namespace {

constexpr double kMiB = 1 << 20;

double height_above_ground_m(const scene::Scene& scene) {
  const core::WorldPosition& at = scene.camera().pose.position;
  return at.local.y -
         models::ground_height_m(scene.world().terrain, at.block, at.local.x, at.local.z);
}

std::vector<render::TextLine> help() {
  std::vector<render::TextLine> lines;
  for (const KeyHelp& key : kKeyHelp)
    lines.push_back({fmt::format("{:<8} {}", key.keys, key.meaning)});
  return lines;
}

}  // namespace

void Hud::add_frame(double frame_ms) {
  frame_ms_[count_++ % kFrames] = frame_ms;
}

void Hud::next_page() {
  page_ = page_ == Page::kFigures ? Page::kHelp
          : page_ == Page::kHelp  ? Page::kNothing
                                  : Page::kFigures;
}

void Hud::notify(Subject subject, std::string text, double now_s) {
  notices_[static_cast<std::size_t>(subject)] = {std::move(text), now_s + kNoticeSeconds};
}

void Hud::notify_until_key(Subject subject, std::string text) {
  notices_[static_cast<std::size_t>(subject)] = {std::move(text),
                                                 std::numeric_limits<double>::infinity()};
}

void Hud::key_pressed() {
  for (Notice& notice : notices_) {
    if (std::isinf(notice.end_s)) notice = {};
  }
}

std::vector<render::TextLine> Hud::figures(const scene::Scene& scene, const HudFacts& facts) const {
  std::array<double, kFrames> sorted = frame_ms_;
  const std::size_t count = std::min(count_, kFrames);
  if (count == 0) return {};
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count));
  const double median_ms = sorted[count / 2], worst_ms = sorted[count - 1];
  const telemetry::FrameRecord& record = facts.record;
  const std::optional<render::GpuTime>& gpu = scene.drawn().gpu;
  const core::WorldPosition& at = scene.camera().pose.position;
  const double speed_m_s = glm::length(scene.camera().predictor.velocity_m_s());
  return {
      {fmt::format("{:5.1f} fps   {:5.1f} ms median   {:5.1f} ms worst", 1000.0 / median_ms,
                   median_ms, worst_ms)},
      {fmt::format("waits {:.1f} ms{}", record.wait_ms(),
                   gpu ? fmt::format("   device {:.1f} ms", gpu->ms) : "")},
      {fmt::format("preset {}   error {:.1f} pixels   resolution {:.0f} %", to_string(facts.preset),
                   record.error_pixels, 100 * record.resolution)},
      {fmt::format("speed {:.1f} m/s   keys fly at {:.3g} m/s", speed_m_s, facts.key_speed_m_s)},
      {fmt::format("block {}, {}   {:.0f} m high, {:.1f} m over ground", at.block.x, at.block.z,
                   at.local.y, height_above_ground_m(scene))},
      {fmt::format("{} triangles   {} draws   {} nodes in view", record.triangles, record.draws,
                   record.nodes_in_view)},
      {fmt::format("cache {:.0f} of {:.0f} MiB   {} missing   {} coarse",
                   static_cast<double>(record.cache_bytes) / kMiB,
                   static_cast<double>(scene.meshes().stats().budget_bytes) / kMiB, record.holes,
                   record.coarse_nodes)},
      {fmt::format("{} requests   {} models made   modelers: {}", record.requests_queued,
                   record.models_synthesised, scene.settings().modelers)},
      {facts.device.name},
      {"F1 help"},
  };
}

std::vector<render::TextPanel> Hud::lasting_panels(const scene::Scene& scene,
                                                   const HudFacts& facts) const {
  std::vector<render::TextPanel> panels;
  if (page_ == Page::kFigures) panels.push_back({render::Anchor::kTopLeft, figures(scene, facts)});
  if (page_ == Page::kHelp) panels.push_back({render::Anchor::kTopLeft, help()});
  panels.push_back(
      {render::Anchor::kTopRight,
       scene::legend_of(scene.input().view, scene.facts().levels.size(), facts.device.wireframe)});
  return panels;
}

std::vector<render::TextPanel> Hud::panels(const scene::Scene& scene, const HudFacts& facts,
                                           double now_s) const {
  std::vector<render::TextPanel> panels = lasting_panels(scene, facts);
  render::TextPanel notices{render::Anchor::kBottom, {}};
  for (const Notice& notice : notices_) {
    if (!notice.text.empty() && now_s < notice.end_s) notices.lines.push_back({notice.text});
  }
  panels.push_back(std::move(notices));
  return panels;
}

}  // namespace psygen::app
