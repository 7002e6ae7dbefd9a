// A sound in memory: 16-bit samples in one or two channels. Long sounds such as music are streamed
// from their file instead (Audio::stream). Values; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::audio {

// The samples of one sound.
struct Clip {
  std::uint32_t rate_hz = 44100;      // frames per second, kMinRate to kMaxRate
  std::uint32_t channels = 1;         // 1 or 2; samples of two are interleaved
  std::vector<std::int16_t> samples;  // frames() · channels
  // Samples of each channel.
  std::size_t frames() const { return channels == 0 ? 0 : samples.size() / channels; }
  // Its length at its own rate. Infinite or NaN if rate_hz is 0.
  double seconds() const { return static_cast<double>(frames()) / rate_hz; }
};

inline constexpr std::uint32_t kMinRate = 4000, kMaxRate = 192'000;

// The maximum decoded size of a clip for read_clip().
inline constexpr std::size_t kMaxClipBytes = std::size_t{64} << 20;

// Reads WAV, Ogg Vorbis or FLAC. Memory grows with the samples read, not with the size that the
// header states. Fails with kIo (missing, not a regular file), kParse (another format, damaged) or
// kOverBudget (above kMaxClipBytes, rate, channels); the message starts with the path. O(samples).
core::Result<Clip> read_clip(const std::filesystem::path& file);

// The same clip with one channel, the mean of both; only such clips can have a position.
Clip mono(const Clip& clip);

// Fails with kInvalidArgument for a clip that is empty or outside the ranges above. O(1).
core::Result<void> check_clip(const Clip& clip);

}  // namespace psygen::audio
