// Decodes a sound file piece by piece with libsndfile, which only this file's source includes.
// Files are not trusted. Private to engine/audio. One thread per object.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "engine/core/error.hpp"

namespace psygen::audio {

class SoundFile {
 public:
  // Fails like read_clip().
  static core::Result<SoundFile> open(const std::filesystem::path& file);

  // Decodes the next frames into whole frames of `samples` and returns their number. Returns 0 at
  // the end and if the file is damaged.
  std::size_t read(std::span<std::int16_t> samples);
  // Seeks to a frame, or to the end if there are fewer frames.
  void seek(std::uint64_t frame);

  std::uint32_t rate_hz() const { return rate_hz_; }
  std::uint32_t channels() const { return channels_; }
  // The number of frames that the header states.
  std::uint64_t frames() const { return frames_; }

 private:
  SoundFile() = default;
  std::unique_ptr<void, int (*)(void*)> file_{nullptr, nullptr};
  std::uint32_t rate_hz_ = 0, channels_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace psygen::audio
