// The stuff of sounds that are made by code: noise, tones that die away, and what is done with
// them. Samples of one channel at kToneRateHz as numbers, of which -1 … 1 can be heard; clip_of()
// makes a clip of them. Pure functions of their arguments; any thread; O(samples).
#pragma once

#include <functional>
#include <initializer_list>
#include <span>
#include <vector>

#include "engine/audio/clip.hpp"

namespace psygen::audio {

using Samples = std::vector<float>;

inline constexpr std::uint32_t kToneRateHz = 22050;

// Seconds (>= 0) as a number of samples.
constexpr std::size_t samples_of(double seconds) {
  return static_cast<std::size_t>(seconds * kToneRateHz);
}

// White noise between two frequencies in hertz, by filters of first order. The same for a seed.
Samples noise(double seconds, float low_hz, float high_hz, std::uint64_t seed);

// Adds a tone that begins at `at_s` seconds and falls to 1/e in `decay_s`. `overtones`: how much of
// 2, 3, 4 … times its frequency. What lies behind the end of `out` is left out.
void add_tone(Samples& out, double at_s, double hz, float gain, double decay_s,
              std::initializer_list<float> overtones = {});
// Adds samples, of which the gain falls from `first_gain` to `last_gain`.
void add(Samples& out, double at_s, std::span<const float> samples, float first_gain,
         float last_gain);

// Multiplies each sample by a gain of its time in seconds.
void shape(Samples& samples, const std::function<float(float)>& gain);
// A loop without a seam: the last `overlap_s` seconds (at most half of all) fade into the
// beginning.
Samples looped(const Samples& samples, double overlap_s);

// A clip of one channel, or of two with a right one of the same length, which is checked. Samples
// beyond -1 … 1 are cut off.
Clip clip_of(std::span<const float> left, std::span<const float> right = {});

}  // namespace psygen::audio
