// Tones as clips and files, for tests.
#pragma once

#include <gtest/gtest.h>
#include <sndfile.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "engine/audio/clip.hpp"

namespace psygen::audio::testing {

// A tone of 440 Hz. Of two channels the right one is silent.
inline Clip tone(double seconds, std::uint32_t channels = 1, std::uint32_t rate_hz = 48'000) {
  Clip clip{rate_hz, channels, {}};
  for (std::size_t i = 0; i < static_cast<std::size_t>(seconds * rate_hz); ++i) {
    const double phase = 2 * 3.14159265358979 * 440 * static_cast<double>(i) / rate_hz;
    clip.samples.push_back(static_cast<std::int16_t>(8000 * std::sin(phase)));
    if (channels == 2) clip.samples.push_back(0);
  }
  return clip;
}

inline std::shared_ptr<const Clip> shared_tone(double seconds, std::uint32_t channels = 1) {
  return std::make_shared<const Clip>(tone(seconds, channels));
}

// Writes a clip with libsndfile, in one of its formats.
inline void write_sound(const std::filesystem::path& file, const Clip& clip, int format) {
  SF_INFO info{};
  info.samplerate = static_cast<int>(clip.rate_hz);
  info.channels = static_cast<int>(clip.channels);
  info.format = format;
  SNDFILE* out = sf_open(file.c_str(), SFM_WRITE, &info);
  ASSERT_NE(out, nullptr) << sf_strerror(nullptr);
  sf_writef_short(out, clip.samples.data(), static_cast<sf_count_t>(clip.frames()));
  sf_close(out);
}

}  // namespace psygen::audio::testing
