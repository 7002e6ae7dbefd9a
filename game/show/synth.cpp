#include "game/show/synth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "engine/core/hash.hpp"

namespace cairns {
namespace {

constexpr std::uint32_t kRateHz = 22050;
constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

using Samples = std::vector<float>;

std::size_t frames(double seconds) {
  return static_cast<std::size_t>(seconds * kRateHz);
}

ClipPtr clip(const Samples& samples, std::uint32_t channels = 1) {
  auto made = std::make_shared<audio::Clip>();
  made->rate_hz = kRateHz;
  made->channels = channels;
  for (const float v : samples)
    made->samples.push_back(static_cast<std::int16_t>(32767 * std::clamp(v, -1.0F, 1.0F)));
  return made;
}

// White noise through a low-pass and a high-pass filter of first order; limits in hertz.
Samples noise(double seconds, float low_hz, float high_hz, std::uint64_t seed) {
  core::RandomStream random(seed, 0, 0, 0, core::Purpose::kStructure);
  Samples out(frames(seconds));
  const float low = 1 - std::exp(-kTwoPi * high_hz / kRateHz);
  const float high = 1 - std::exp(-kTwoPi * low_hz / kRateHz);
  float smooth = 0, slow = 0;
  for (float& v : out) {
    smooth += low * (static_cast<float>(random.next_real(-1, 1)) - smooth);
    slow += high * (smooth - slow);
    v = smooth - slow;
  }
  return out;
}

void shape(Samples& samples, const std::function<float(float)>& gain) {
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] *= gain(static_cast<float>(i) / kRateHz);
}

// The end fades into the beginning, so that a loop has no seam.
Samples looped(const Samples& samples, double overlap_s) {
  const std::size_t overlap = frames(overlap_s), length = samples.size() - overlap;
  Samples out(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(length));
  for (std::size_t i = 0; i < overlap; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(overlap);
    out[i] = out[i] * std::sqrt(t) + samples[length + i] * std::sqrt(1 - t);
  }
  return out;
}

// A tone that dies away, added at a time. `overtones`: how much of 2, 3, 4 … times its frequency.
void add_tone(Samples& out, double at_s, double hz, float gain, double decay_s,
              std::initializer_list<float> overtones = {}) {
  const std::size_t from = frames(at_s);
  for (std::size_t i = from; i < out.size(); ++i) {
    const float t = static_cast<float>(i - from) / kRateHz;
    const float envelope =
        gain * std::min(t * 90, 1.0F) * std::exp(-t / static_cast<float>(decay_s));
    if (t > 6 * decay_s) break;
    float v = std::sin(kTwoPi * static_cast<float>(hz) * t);
    float n = 2;
    for (const float share : overtones)
      v += share * std::sin(kTwoPi * static_cast<float>(hz) * (n++) * t);
    out[i] += envelope * v;
  }
}

}  // namespace

ClipPtr wind_sound() {
  Samples out = noise(11, 60, 480, 1);
  shape(out, [](float t) { return 2.2F + 0.9F * std::sin(0.9F * t) * std::sin(0.57F * t + 1); });
  return clip(looped(out, 1.5));
}

ClipPtr rain_sound() {
  Samples out = noise(5, 900, 7000, 2);
  shape(out, [](float) { return 0.8F; });
  return clip(looped(out, 0.6));
}

ClipPtr water_sound() {
  Samples out = noise(7, 150, 900, 3);
  shape(out, [](float t) { return 1.0F + 0.8F * std::sin(1.8F * t) * std::sin(1.1F * t); });
  return clip(looped(out, 1));
}

ClipPtr fire_sound() {
  Samples out = noise(4, 80, 700, 4);
  shape(out, [](float) { return 0.5F; });
  core::RandomStream random(5, 0, 0, 0, core::Purpose::kStructure);
  for (int i = 0; i < 60; ++i) {
    const Samples crack = noise(0.02, 800, 6000, 100 + static_cast<std::uint64_t>(i));
    const std::size_t at = frames(random.next_real(0, 3.9));
    const auto gain = static_cast<float>(random.next_real(0.3, 1.4));
    for (std::size_t k = 0; k < crack.size() && at + k < out.size(); ++k)
      out[at + k] +=
          gain * crack[k] * (1 - static_cast<float>(k) / static_cast<float>(crack.size()));
  }
  return clip(looped(out, 0.4));
}

// Four chords of a pentatonic scale, each with a few notes over it; two channels.
ClipPtr music_sound(std::uint64_t seed) {
  constexpr std::array<double, 5> kScale{1, 9.0 / 8, 5.0 / 4, 3.0 / 2, 5.0 / 3};
  constexpr double kSeconds = 64, kChordS = 8;
  core::RandomStream random(seed, 0, 0, 0, core::Purpose::kColour);
  const double root = 98 * std::pow(2.0, static_cast<double>(random.next_integer(0, 4)) / 12);
  std::array<Samples, 2> sides{Samples(frames(kSeconds)), Samples(frames(kSeconds))};
  for (int chord = 0; chord < static_cast<int>(kSeconds / kChordS); ++chord) {
    const double at = chord * kChordS;
    const auto base = static_cast<std::size_t>(random.next_integer(0, 4));
    for (std::size_t voice = 0; voice < 3; ++voice) {
      const std::size_t note = base + 2 * voice;
      const double hz = root * kScale[note % 5] * (1 + static_cast<double>(note / 5));
      for (std::size_t side = 0; side < 2; ++side)
        add_tone(sides[side], at + 0.35 * static_cast<double>(voice), hz * (side == 0 ? 1 : 1.003),
                 0.05F, 2.6, {0.25F, 0.1F});
    }
    for (int note = 0; note < 3; ++note) {
      if (random.next_unit() < 0.35) continue;
      const auto step = static_cast<std::size_t>(random.next_integer(0, 9));
      const double hz = 4 * root * kScale[step % 5] * (step > 4 ? 2 : 1);
      const auto side = static_cast<std::size_t>(random.next_integer(0, 1));
      add_tone(sides[side], at + random.next_real(0.5, 5), hz, 0.035F, 1.3, {0.3F});
    }
  }
  Samples both;
  for (std::size_t i = 0; i < sides[0].size(); ++i) {
    both.push_back(sides[0][i]);
    both.push_back(sides[1][i]);
  }
  return clip(both, 2);
}

ClipPtr step_sound(float hardness) {
  Samples out = noise(0.16, 120 + 500 * hardness, 900 + 3500 * hardness, 7);
  shape(out, [&](float t) { return 2.2F * std::exp(-t * (22 + 30 * hardness)); });
  return clip(out);
}

ClipPtr splash_sound() {
  Samples out = noise(0.9, 250, 3500, 8);
  shape(out, [](float t) { return 1.4F * std::min(t * 40, 1.0F) * std::exp(-4 * t); });
  return clip(out);
}

ClipPtr chop_sound() {
  Samples out = noise(0.22, 200, 2500, 9);
  shape(out, [](float t) { return 1.1F * std::exp(-38 * t); });
  add_tone(out, 0, 190, 0.7F, 0.035, {0.5F, 0.3F});
  return clip(out);
}

ClipPtr fall_sound() {
  Samples out = noise(2.2, 70, 1600, 10);
  shape(out, [](float t) {
    const float creak = t < 1.5F ? 0.3F * t * (0.6F + 0.4F * std::sin(70 * t)) : 0;
    return creak + (t > 1.5F ? 2.6F * std::exp(-5 * (t - 1.5F)) : 0);
  });
  return clip(out);
}

ClipPtr stone_sound() {
  Samples out(frames(0.3));
  add_tone(out, 0, 1250, 0.5F, 0.02, {0.6F, 0.4F});
  add_tone(out, 0.07, 980, 0.3F, 0.02, {0.6F, 0.3F});
  return clip(out);
}

ClipPtr bird_sound(int which) {
  Samples out(frames(0.9));
  core::RandomStream random(40 + static_cast<std::uint64_t>(which), 0, 0, 0,
                            core::Purpose::kColour);
  float phase = 0;
  for (int call = 0; call < 3 + which; ++call) {
    const std::size_t from = frames(0.13 * call + 0.02), length = frames(0.08);
    const auto hz = static_cast<float>(random.next_real(2600, 4600));
    const auto bend = static_cast<float>(random.next_real(-900, 1200));
    for (std::size_t i = 0; i < length && from + i < out.size(); ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(length);
      phase += kTwoPi * (hz + bend * t) / kRateHz;
      out[from + i] += 0.35F * std::sin(std::numbers::pi_v<float> * t) * std::sin(phase);
    }
  }
  return clip(out);
}

ClipPtr chime_sound() {
  Samples out(frames(4));
  int i = 0;
  for (const double ratio : {1.0, 1.25, 1.5, 2.0, 2.5})
    add_tone(out, 0.16 * i++, 392 * ratio, 0.16F, 0.9, {0.3F, 0.12F});
  return clip(out);
}

}  // namespace cairns
