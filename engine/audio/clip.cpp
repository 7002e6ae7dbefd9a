#include "engine/audio/clip.hpp"

#include <fmt/format.h>

#include "engine/audio/sound_file.hpp"

namespace psygen::audio {

core::Result<Clip> read_clip(const std::filesystem::path& file) {
  auto opened = SoundFile::open(file);
  if (!opened) return tl::unexpected(opened.error());
  Clip clip{opened->rate_hz(), opened->channels(), {}};
  // The header of a file may state any length, so memory grows with the samples read.
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  for (std::size_t read = kPiece; read == kPiece;) {
    const std::size_t before = clip.samples.size();
    clip.samples.resize(before + kPiece * clip.channels);
    read = opened->read(std::span(clip.samples).subspan(before));
    clip.samples.resize(before + read * clip.channels);
    if (clip.samples.size() * sizeof(std::int16_t) > kMaxClipBytes)
      return core::fail(core::ErrorCode::kOverBudget,
                        fmt::format("{}: is longer than {} MiB of samples; play it as a stream",
                                    file.string(), kMaxClipBytes >> 20));
  }
  clip.samples.shrink_to_fit();
  if (clip.samples.empty())
    return core::fail(core::ErrorCode::kParse, fmt::format("{}: has no samples", file.string()));
  return clip;
}

Clip mono(const Clip& clip) {
  if (clip.channels != 2) return clip;
  Clip one{clip.rate_hz, 1, {}};
  one.samples.reserve(clip.frames());
  for (std::size_t i = 0; i + 1 < clip.samples.size(); i += 2)
    one.samples.push_back(static_cast<std::int16_t>((clip.samples[i] + clip.samples[i + 1]) / 2));
  return one;
}

core::Result<void> check_clip(const Clip& clip) {
  const bool sound = clip.rate_hz >= kMinRate && clip.rate_hz <= kMaxRate &&
                     (clip.channels == 1 || clip.channels == 2) && !clip.samples.empty() &&
                     clip.samples.size() % clip.channels == 0 &&
                     clip.samples.size() * sizeof(std::int16_t) <= kMaxClipBytes;
  if (sound) return {};
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("a clip has {} samples, {} channels and {} Hz; it must have "
                                "whole frames up to {} MiB, 1 or 2 channels, {} to {} Hz",
                                clip.samples.size(), clip.channels, clip.rate_hz,
                                kMaxClipBytes >> 20, kMinRate, kMaxRate));
}

}  // namespace psygen::audio
