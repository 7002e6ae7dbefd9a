// Sound files that are read, and those that are rejected.
#include "engine/audio/clip.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "engine/audio/audio.hpp"
#include "engine/core/hash.hpp"
#include "tests/engine/audio/tones.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::audio {
namespace {

using testing::tone;
using testing::write_sound;

constexpr int kWav = SF_FORMAT_WAV | SF_FORMAT_PCM_16;

std::string refusal(const std::filesystem::path& file, core::ErrorCode code) {
  const auto clip = read_clip(file);
  if (clip) return "it was read";
  EXPECT_EQ(clip.error().code, code) << clip.error().message;
  EXPECT_EQ(clip.error().message.find(file.string() + ": "), 0U) << clip.error().message;
  return clip.error().message.substr(file.string().size() + 2);
}

TEST(Clip, WavAndFlacReadBackEqual) {
  const TemporaryFolder folder;
  for (const std::uint32_t channels : {1U, 2U}) {
    const Clip made = tone(1.7, channels, 22'050);
    for (const int format : {kWav, SF_FORMAT_FLAC | SF_FORMAT_PCM_16}) {
      write_sound(folder / "sound", made, format);
      const auto read = read_clip(folder / "sound");
      ASSERT_TRUE(read) << read.error().message;
      EXPECT_EQ(read->rate_hz, 22'050U);
      EXPECT_EQ(read->channels, channels);
      EXPECT_TRUE(read->samples == made.samples);
    }
  }
}

TEST(Clip, OggVorbisReadsBackApproximately) {
  const TemporaryFolder folder;
  const Clip made = tone(1, 1, 44'100);
  write_sound(folder / "tone.ogg", made, SF_FORMAT_OGG | SF_FORMAT_VORBIS);
  const auto read = read_clip(folder / "tone.ogg");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->frames(), made.frames());
  double difference = 0;
  for (std::size_t i = 0; i < made.samples.size(); ++i)
    difference += std::abs(made.samples[i] - read->samples[i]);
  EXPECT_LT(difference / static_cast<double>(made.samples.size()), 200);
}

TEST(Clip, OtherFilesAreRejectedWithAMessage) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusal(folder / "none.wav", core::ErrorCode::kIo), "there is no such file");
  EXPECT_EQ(refusal(folder.path(), core::ErrorCode::kIo), "is not a regular file");
  std::ofstream(folder / "text.wav") << "hello";
  EXPECT_EQ(refusal(folder / "text.wav", core::ErrorCode::kParse)
                .find("cannot be read as WAV, Ogg Vorbis or FLAC: "),
            0U);
  write_sound(folder / "tone.aiff", tone(0.1), SF_FORMAT_AIFF | SF_FORMAT_PCM_16);
  EXPECT_EQ(refusal(folder / "tone.aiff", core::ErrorCode::kParse),
            "is not a WAV, Ogg Vorbis or FLAC file");
  write_sound(folder / "six.wav", Clip{48'000, 6, std::vector<std::int16_t>(600)}, kWav);
  EXPECT_EQ(refusal(folder / "six.wav", core::ErrorCode::kOverBudget),
            "has 6 channels; it must have 1 or 2");
  write_sound(folder / "slow.wav", tone(1, 1, 1000), kWav);
  EXPECT_EQ(refusal(folder / "slow.wav", core::ErrorCode::kOverBudget),
            "has 1000 Hz; it must have 4000 to 192000");
  write_sound(folder / "empty.wav", Clip{48'000, 1, {}}, kWav);
  EXPECT_EQ(refusal(folder / "empty.wav", core::ErrorCode::kParse), "has no samples");
}

TEST(Clip, AClipThatIsTooLongIsRejected) {
  const TemporaryFolder folder;
  for (const std::size_t more : {std::size_t{1}, std::size_t{1} << 17}) {
    const Clip silence{48'000, 1, std::vector<std::int16_t>(kMaxClipBytes / 2 + more)};
    write_sound(folder / "long.flac", silence, SF_FORMAT_FLAC | SF_FORMAT_PCM_16);
    EXPECT_EQ(refusal(folder / "long.flac", core::ErrorCode::kOverBudget),
              "is longer than 64 MiB of samples; play it as a stream");
  }
  const Clip longest{48'000, 1, std::vector<std::int16_t>(kMaxClipBytes / 2)};
  write_sound(folder / "longest.flac", longest, SF_FORMAT_FLAC | SF_FORMAT_PCM_16);
  const auto clip = read_clip(folder / "longest.flac");
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_TRUE(check_clip(*clip));
}

// Writes correct checksums into the whole pages of an Ogg file (RFC 3533); otherwise no damaged
// page would reach the decoder.
void mend_checksums(std::string& ogg) {
  constexpr std::size_t kHead = 27, kChecksum = 22, kSegments = 26;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(ogg[at]); };
  for (std::size_t page = 0; page + kHead <= ogg.size();) {
    std::size_t bytes = kHead + byte(page + kSegments);
    if (page + bytes > ogg.size()) return;
    for (std::size_t i = page + kHead; i < page + kHead + byte(page + kSegments); ++i)
      bytes += byte(i);
    if (page + bytes > ogg.size()) return;
    for (std::size_t i = 0; i < 4; ++i)
      ogg[page + kChecksum + i] = 0;
    std::uint32_t checksum = 0;
    for (std::size_t i = page; i < page + bytes; ++i) {
      checksum ^= std::uint32_t{byte(i)} << 24;
      for (int bit = 0; bit < 8; ++bit)
        checksum = checksum << 1 ^ ((checksum >> 31) != 0 ? 0x04C11DB7U : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i)
      ogg[page + kChecksum + i] = static_cast<char>(checksum >> 8 * i);
    page += bytes;
  }
}

// Streams a file for a tenth of a second. Returns whether it was accepted.
bool streams(Audio& audio, const std::filesystem::path& file, bool loop) {
  const auto sound = audio.stream(file, {.loop = loop});
  if (!sound) return false;
  for (int i = 0; i < 5; ++i) {
    audio.update({}, 0.02);
    for (const float sample : audio.render(960))
      EXPECT_LE(std::abs(sample), 1.0F);  // false for NaN
  }
  audio.stop(*sound);
  EXPECT_EQ(audio.playing(), 0U);
  return true;
}

TEST(Clip, ChangedBytesAreAnErrorOrASound) {
  const TemporaryFolder folder;
  Audio audio({.destination = Destination::kRendered});
  core::RandomStream random(4, 0, 0, 0, core::Purpose::kStructure);
  for (const int format :
       {kWav, SF_FORMAT_OGG | SF_FORMAT_VORBIS, SF_FORMAT_FLAC | SF_FORMAT_PCM_16}) {
    write_sound(folder / "sound", tone(2), format);
    std::ifstream in(folder / "sound", std::ios::binary);
    const std::string sound(std::istreambuf_iterator<char>(in), {});
    int read = 0, streamed = 0;
    for (int round = 0; round < 300; ++round) {
      std::string text = sound;
      for (int change = 0; change < 3; ++change)
        text[random.next_u64() % (change < round % 3 ? 64 : text.size())] =
            static_cast<char>(random.next_u64());
      if (round % 7 == 0) text.resize(random.next_u64() % text.size());
      if (format == (SF_FORMAT_OGG | SF_FORMAT_VORBIS)) mend_checksums(text);
      std::ofstream(folder / "changed", std::ios::binary | std::ios::trunc) << text;
      const auto clip = read_clip(folder / "changed");
      EXPECT_TRUE(!clip || check_clip(*clip)) << round;
      const bool accepted = streams(audio, folder / "changed", round % 2 == 0);
      EXPECT_TRUE(accepted || !clip) << round;
      read += clip ? 1 : 0;
      streamed += accepted ? 1 : 0;
    }
    EXPECT_GT(read, 20);
    EXPECT_LT(read, 300);
    EXPECT_GE(streamed, read);
  }
}

TEST(Clip, MonoIsTheMeanOfBothChannels) {
  const Clip one = mono(Clip{48'000, 2, {100, 200, -10, -20}});
  EXPECT_EQ(one.channels, 1U);
  EXPECT_EQ(one.samples, (std::vector<std::int16_t>{150, -15}));
}

TEST(Clip, ClipsFromCodeAreChecked) {
  EXPECT_TRUE(check_clip(tone(0.1)));
  for (const Clip& wrong : {Clip{48'000, 1, {}}, Clip{0, 1, {1}}, Clip{48'000, 3, {1, 2, 3}},
                            Clip{48'000, 2, {1, 2, 3}}, Clip{UINT32_MAX, 1, {1}}})
    EXPECT_FALSE(check_clip(wrong));
}

}  // namespace
}  // namespace psygen::audio
