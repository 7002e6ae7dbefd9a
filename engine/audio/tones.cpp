#include "engine/audio/tones.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"

namespace psygen::audio {
namespace {

constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;
constexpr float kAttack = 90;      // a tone fades in over 1/90 s …
constexpr double kDecaysLong = 6;  // … and ends after this many decay times

// The coefficient of a first-order low-pass filter.
float share_of(float hz) {
  return 1 - std::exp(-kTwoPi * hz / static_cast<float>(kToneRateHz));
}

std::int16_t packed(float sample) {
  return static_cast<std::int16_t>(32767 * std::clamp(sample, -1.0F, 1.0F));
}

}  // namespace

Samples noise(double seconds, float low_hz, float high_hz, std::uint64_t seed) {
  core::RandomStream random(seed, 0, 0, 0, core::Purpose::kStructure);
  Samples out(samples_of(seconds));
  const float low = share_of(high_hz), high = share_of(low_hz);
  float smooth = 0, slow = 0;
  for (float& v : out) {
    smooth += low * (static_cast<float>(random.next_real(-1, 1)) - smooth);
    slow += high * (smooth - slow);
    v = smooth - slow;
  }
  return out;
}

void add_tone(Samples& out, double at_s, double hz, float gain, double decay_s,
              std::initializer_list<float> overtones) {
  const std::size_t from = samples_of(at_s);
  const std::size_t to = std::min(out.size(), from + samples_of(kDecaysLong * decay_s));
  for (std::size_t i = from; i < to; ++i) {
    const float t = static_cast<float>(i - from) / kToneRateHz;
    const float envelope = std::min(t * kAttack, 1.0F) * std::exp(-t / static_cast<float>(decay_s));
    const float turn = kTwoPi * static_cast<float>(hz) * t;
    float v = std::sin(turn);
    float n = 2;
    for (const float share : overtones)
      v += share * std::sin(turn * n++);
    out[i] += gain * envelope * v;
  }
}

void add(Samples& out, double at_s, std::span<const float> samples, float first_gain,
         float last_gain) {
  const std::size_t from = samples_of(at_s);
  for (std::size_t i = 0; i < samples.size() && from + i < out.size(); ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(samples.size());
    out[from + i] += std::lerp(first_gain, last_gain, t) * samples[i];
  }
}

void shape(Samples& samples, const std::function<float(float)>& gain) {
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] *= gain(static_cast<float>(i) / kToneRateHz);
}

Samples looped(const Samples& samples, double overlap_s) {
  const std::size_t overlap = std::min(samples_of(overlap_s), samples.size() / 2);
  const std::size_t length = samples.size() - overlap;
  Samples out(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(length));
  for (std::size_t i = 0; i < overlap; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(overlap);
    out[i] = out[i] * std::sqrt(t) + samples[length + i] * std::sqrt(1 - t);
  }
  return out;
}

Clip clip_of(std::span<const float> left, std::span<const float> right) {
  PSYGEN_CHECK(right.empty() || right.size() == left.size(),
               "both channels must have the same length");
  Clip clip{kToneRateHz, right.empty() ? 1U : 2U, {}};
  clip.samples.reserve(left.size() + right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    clip.samples.push_back(packed(left[i]));
    if (!right.empty()) clip.samples.push_back(packed(right[i]));
  }
  return clip;
}

}  // namespace psygen::audio
