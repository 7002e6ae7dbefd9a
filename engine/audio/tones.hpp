// Synthesises sounds: noise, decaying tones, and operations on them. Samples are numbers of one
// channel at kToneRateHz, audible within -1 … 1; clip_of() converts them to a clip. Pure functions;
// any thread; O(samples).
#pragma once

#include <functional>
#include <initializer_list>
#include <span>
#include <vector>

#include "engine/audio/clip.hpp"

namespace psygen::audio {

// Samples of one channel; audible within -1 … 1.
using Samples = std::vector<float>;

inline constexpr std::uint32_t kToneRateHz = 22050;

// The number of samples in some seconds (>= 0).
constexpr std::size_t samples_of(double seconds) {
  return static_cast<std::size_t>(seconds * kToneRateHz);
}

// White noise between two frequencies in hertz, by first-order filters. Equal seeds give equal
// noise.
Samples noise(double seconds, float low_hz, float high_hz, std::uint64_t seed);

// Adds a tone that starts at `at_s` seconds and falls to 1/e in `decay_s`. `overtones` are the
// gains of 2, 3, 4 … times its frequency. Samples after the end of `out` are dropped.
void add_tone(Samples& out, double at_s, double hz, float gain, double decay_s,
              std::initializer_list<float> overtones = {});
// Adds samples whose gain changes from `first_gain` to `last_gain`.
void add(Samples& out, double at_s, std::span<const float> samples, float first_gain,
         float last_gain);

// Multiplies each sample by a gain that depends on its time in seconds.
void shape(Samples& samples, const std::function<float(float)>& gain);
// A seamless loop: the last `overlap_s` seconds (at most half of all) fade into the start.
Samples looped(const Samples& samples, double overlap_s);

// A clip of one channel, or of two; `right` must then have the same length (checked). Samples
// beyond -1 … 1 are clipped.
Clip clip_of(std::span<const float> left, std::span<const float> right = {});

}  // namespace psygen::audio
