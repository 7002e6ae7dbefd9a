#include "engine/app/loading.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"

namespace psygen::app {
namespace {

constexpr float kHeightOfScaleOne = 1080;  // image height for text scale 1

constexpr int kBands = 120;    // of the sky
constexpr int kColumns = 400;  // of a ridge
constexpr float kHorizon = 0.72F;
constexpr glm::vec3 kZenith{0.05F, 0.085F, 0.14F};
constexpr glm::vec3 kGlow{0.78F, 0.56F, 0.38F};
constexpr glm::vec4 kText{0.97F, 0.96F, 0.93F, 1.0F};
constexpr glm::vec4 kSoftText{0.97F, 0.96F, 0.93F, 0.72F};
constexpr glm::vec4 kBar{0.45F, 0.66F, 0.85F, 1.0F};
constexpr glm::vec4 kBarGround{1.0F, 1.0F, 1.0F, 0.16F};
constexpr float kLeft = 0.08F, kRight = 0.92F;  // margins of the text

// Smooth one-dimensional noise in [0, 1].
float noise(std::uint64_t seed, float x) {
  const auto at = [seed](float cell) {
    const auto key = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell));
    return static_cast<float>(core::combine(seed, key) >> 40) / static_cast<float>(1 << 24);
  };
  const float cell = std::floor(x), in = x - cell;
  return glm::mix(at(cell), at(cell + 1), in * in * (3 - 2 * in));
}

// A row of hills: its height above the horizon, and its colour.
struct Ridge {
  float base, height, waves;
  glm::vec3 colour;
};
constexpr std::array kRidges{Ridge{0.66F, 0.20F, 3.0F, {0.33F, 0.27F, 0.27F}},
                             Ridge{0.73F, 0.15F, 5.0F, {0.17F, 0.16F, 0.18F}},
                             Ridge{0.82F, 0.12F, 7.0F, {0.06F, 0.07F, 0.085F}}};

void add_sky(render::HudDrawing& drawing) {
  for (int i = 0; i < kBands; ++i) {
    const float top = static_cast<float>(i) / kBands;
    const float share = std::min(top / kHorizon, 1.0F);
    drawing.areas.push_back({{{0, top}, {}},
                             {{1, 1.0F / kBands}, {0, 1}},
                             {glm::mix(kZenith, kGlow, share * share), 1.0F}});
  }
}

void add_ridge(const Ridge& ridge, std::uint64_t seed, render::HudDrawing& drawing) {
  for (int i = 0; i < kColumns; ++i) {
    const float x = static_cast<float>(i) / kColumns;
    float high = 0, weight = 0.6F;
    for (float waves = ridge.waves; waves < 200; waves *= 2.3F, weight *= 0.42F)
      high += weight * noise(seed + static_cast<std::uint64_t>(waves), x * waves);
    const float top = ridge.base - (high - 0.5F) * ridge.height;
    drawing.areas.push_back(
        {{{x, top}, {}}, {{1.0F / kColumns, 1 - top}, {1, 0}}, {ridge.colour, 1.0F}});
  }
}

// Shrinks a text that is wider than `room_px`, and shortens it if it would become too small.
void fit(render::HudText& text, float min_px, float room_px) {
  const float share = room_px / std::max(render::measure(text).x, 1.0F);
  text.size_px = std::max(std::min(text.size_px, text.size_px * share), min_px);
  std::string rest = text.text;
  while (render::measure(text).x > room_px && !rest.empty()) {
    while (rest.size() > 1 && (static_cast<unsigned char>(rest.back()) & 0xC0U) == 0x80)
      rest.pop_back();  // removes continuation bytes of a character first
    rest.pop_back();
    text.text = rest + "\u2026";
  }
}

}  // namespace

float text_scale(float content_scale, core::Extent picture) {
  return std::max(content_scale, static_cast<float>(picture.height) / kHeightOfScaleOne);
}

Loading::Loading(std::string title, platform::Window* window, const std::atomic<bool>* stop)
    : title_(std::move(title)), window_(window), stop_(stop) {}

bool Loading::update(std::string_view label, double fraction, render::Renderer* renderer) {
  if (!bar_ || label != label_) {
    label_ = label;
    fraction_ = 0;
    bar_ = std::make_unique<telemetry::ProgressBar>(telemetry::stderr_terminal(), label_, 1.0);
  }
  fraction_ = std::max(fraction_, fraction);
  bar_->update(fraction_);
  if (window_ != nullptr) watch_window(renderer);
  return !closed_ && (stop_ == nullptr || !stop_->load());
}

void Loading::watch_window(render::Renderer* renderer) {
  const platform::InputState input = window_->poll();
  if (window_->should_close() || input.was_pressed(platform::Key::kEscape)) closed_ = true;
  if (input.was_pressed(platform::Key::kF11)) (void)window_->set_fullscreen(!window_->fullscreen());
  const double now_s = core::monotonic_seconds();
  if (closed_ || renderer == nullptr || !pace_.is_due(now_s)) return;
  // Errors of this image are reported by the first frame.
  (void)renderer->show({}, 1,
                       loading_picture(title_, label_, fraction_, window_->framebuffer_size()));
  pace_.drawn(now_s, core::monotonic_seconds());
}

render::HudDrawing loading_picture(std::string_view world, std::string_view label, double fraction,
                                   core::Extent picture) {
  render::HudDrawing drawing;
  const float done =
      std::isfinite(fraction) ? std::clamp(static_cast<float>(fraction), 0.0F, 1.0F) : 0.0F;
  add_sky(drawing);
  std::uint64_t seed = core::hash_bytes(std::as_bytes(std::span(world.data(), world.size())));
  for (const Ridge& ridge : kRidges)
    add_ridge(ridge, ++seed, drawing);
  const float unit = static_cast<float>(picture.height) / 100;  // a hundredth of the height
  const float bar_px = std::max(std::round(0.6F * unit), 2.0F);
  drawing.areas.push_back({{{kLeft, 0.9F}, {}}, {{kRight - kLeft, 0}, {0, bar_px}}, kBarGround});
  drawing.areas.push_back({{{kLeft, 0.9F}, {}}, {{(kRight - kLeft) * done, 0}, {0, bar_px}}, kBar});

  render::HudText text;
  text.shadow_px = {0, std::max(1.0F, 0.25F * unit)};
  text.colour = kText;
  text.text = world;
  text.at = {{kLeft, 0.9F}, {0, -7.0F * unit}};
  text.vertical = render::HudVertical::kBottom;
  text.size_px = 9 * unit;
  const float small_px = std::max(3.2F * unit, 11.0F);
  fit(text, small_px, (kRight - kLeft) * static_cast<float>(picture.width));
  drawing.texts.push_back(text);
  text.colour = kSoftText;
  text.size_px = small_px;
  text.at.px = {0, -1.8F * unit};
  text.text = label;
  drawing.texts.push_back(text);
  text.text = fmt::format("{:.0f} %", done * 100);
  text.at.share.x = kRight;
  text.align = render::HudAlign::kRight;
  drawing.texts.push_back(text);
  return drawing;
}

}  // namespace psygen::app
