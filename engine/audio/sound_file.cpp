#include "engine/audio/sound_file.hpp"

#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>

#include "engine/audio/clip.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::audio {
namespace {

int close_file(void* file) {
  return sf_close(static_cast<SNDFILE*>(file));
}

bool is_known(int format) {
  const int container = format & SF_FORMAT_TYPEMASK;
  return container == SF_FORMAT_WAV || container == SF_FORMAT_WAVEX || container == SF_FORMAT_OGG ||
         container == SF_FORMAT_FLAC;
}

}  // namespace

core::Result<SoundFile> SoundFile::open(const std::filesystem::path& file) {
  const auto refuse = [&](core::ErrorCode code, std::string_view reason) {
    return core::fail(code, fmt::format("{}: {}", file.string(), reason));
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    return refuse(core::ErrorCode::kIo, "there is no such file");
  if (!std::filesystem::is_regular_file(status))
    return refuse(core::ErrorCode::kIo, "is not a regular file");
  SF_INFO info{};
  SNDFILE* raw = sf_open(file.c_str(), SFM_READ, &info);
  if (raw == nullptr)
    return refuse(core::ErrorCode::kParse,
                  fmt::format("cannot be read as WAV, Ogg Vorbis or FLAC: {}",
                              core::shown(sf_strerror(nullptr), 120)));
  SoundFile opened;
  opened.file_ = {raw, &close_file};
  if (!is_known(info.format))
    return refuse(core::ErrorCode::kParse, "is not a WAV, Ogg Vorbis or FLAC file");
  if (info.channels < 1 || info.channels > 2)
    return refuse(core::ErrorCode::kOverBudget,
                  fmt::format("has {} channels; it must have 1 or 2", info.channels));
  if (info.samplerate < int{kMinRate} || info.samplerate > int{kMaxRate})
    return refuse(core::ErrorCode::kOverBudget, fmt::format("has {} Hz; it must have {} to {}",
                                                            info.samplerate, kMinRate, kMaxRate));
  opened.rate_hz_ = static_cast<std::uint32_t>(info.samplerate);
  opened.channels_ = static_cast<std::uint32_t>(info.channels);
  opened.frames_ = static_cast<std::uint64_t>(std::max<sf_count_t>(info.frames, 0));
  return opened;
}

std::size_t SoundFile::read(std::span<std::int16_t> samples) {
  const auto frames = static_cast<sf_count_t>(samples.size() / channels_);
  const sf_count_t read =
      sf_readf_short(static_cast<SNDFILE*>(file_.get()), samples.data(), frames);
  return static_cast<std::size_t>(std::max<sf_count_t>(read, 0));
}

void SoundFile::seek(std::uint64_t frame) {
  sf_seek(static_cast<SNDFILE*>(file_.get()), static_cast<sf_count_t>(std::min(frame, frames_)),
          SEEK_SET);
}

}  // namespace psygen::audio
