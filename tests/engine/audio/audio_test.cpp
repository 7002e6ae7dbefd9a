// Audible sound, measured in the samples that OpenAL renders.
#include "engine/audio/audio.hpp"

#include <algorithm>
#include <fstream>
#include <limits>

#include "tests/engine/audio/tones.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::audio {
namespace {

using testing::shared_tone;

constexpr double kBlock_m = 60;
constexpr double kFrame_s = 0.02;  // 960 rendered frames

// The loudness at each ear: root mean square.
struct Heard {
  double left = 0, right = 0;
  double both() const { return left + right; }
};

// Advances time for a listener and measures the last half of it.
Heard listen(Audio& audio, const core::CameraPose& listener, double seconds = 0.4) {
  Heard heard;
  const int steps = static_cast<int>(std::lround(seconds / kFrame_s));
  for (int step = 0; step < steps; ++step) {
    audio.update(listener, kFrame_s);
    const std::vector<float> samples = audio.render(960);
    for (std::size_t i = 0; i < samples.size() && step >= steps / 2; i += 2) {
      heard.left += samples[i] * samples[i];
      heard.right += samples[i + 1] * samples[i + 1];
    }
  }
  const double frames = 960.0 * (steps - steps / 2);
  return {std::sqrt(heard.left / frames), std::sqrt(heard.right / frames)};
}

AudioOptions rendered(std::uint32_t voices = 32) {
  return {Destination::kRendered, kBlock_m, voices};
}

core::CameraPose at(core::BlockCoord block) {
  return {{block, {30, 2, 30}}, 0, 0};
}

Play placed(const core::CameraPose& listener, double east_m, double south_m) {
  Play how;
  how.at = listener.position;
  how.at->local.x += east_m;
  how.at->local.z += south_m;
  how.loop = true;
  return how;
}

TEST(Audio, ASoundToTheRightIsLouderOnTheRightAlsoFarFromTheOrigin) {
  for (const core::BlockCoord block : {core::BlockCoord{0, 0}, {1 << 30, -(1 << 30)}}) {
    Audio audio(rendered());
    ASSERT_TRUE(audio.has_output());
    core::CameraPose listener = at(block);
    ASSERT_TRUE(audio.play(shared_tone(1), placed(listener, 3, 0)));
    const Heard right = listen(audio, listener);
    EXPECT_GT(right.right, 2 * right.left);
    listener.yaw = 3.14159265358979;  // turned round
    const Heard left = listen(audio, listener);
    EXPECT_GT(left.left, 2 * left.right);
    EXPECT_NEAR(left.left, right.right, 0.02 * right.right);
  }
}

TEST(Audio, AChangedSoundIsHeardWithItsNewValues) {
  const core::CameraPose listener = at({7, 7});
  Audio audio(rendered());
  Play how = placed(listener, 3, 0);
  const auto sound = audio.play(shared_tone(1), how);
  ASSERT_TRUE(sound) << sound.error().message;
  const Heard full = listen(audio, listener);
  EXPECT_GT(full.right, 2 * full.left);
  how.gain = 0.5;
  ASSERT_TRUE(audio.change(*sound, how));
  EXPECT_NEAR(listen(audio, listener).both(), 0.5 * full.both(), 0.01 * full.both());
  how = placed(listener, -3, 0);
  ASSERT_TRUE(audio.change(*sound, how));
  const Heard moved = listen(audio, listener);
  EXPECT_NEAR(moved.left, full.right, 0.02 * full.right);
  EXPECT_NEAR(moved.right, full.left, 0.02 * full.right);
  how.loop = false;
  ASSERT_TRUE(audio.change(*sound, how));
  listen(audio, listener, 1.1);
  EXPECT_FALSE(audio.plays(*sound));
  EXPECT_TRUE(audio.change(*sound, how)) << "it has ended";
}

TEST(Audio, ASoundFallsOffWithDistanceByItsRange) {
  const core::CameraPose listener = at({7, 7});
  double near = 0;
  for (const double distance_m : {1.0, 2.0, 8.0, 50.0, 99.0, 200.0}) {
    Audio audio(rendered());
    Play how = placed(listener, 0, -distance_m);
    how.range = {2, 100};
    ASSERT_TRUE(audio.play(shared_tone(1), how));
    const double loud = listen(audio, listener).both();
    if (distance_m == 1.0) near = loud;
    EXPECT_NEAR(loud / near, attenuation(distance_m, how.range), 0.01) << distance_m;
  }
  EXPECT_GT(near, 0.05);
}

TEST(Audio, WithoutAPositionASoundIsTheSameEverywhereAndVolumesScaleIt) {
  Audio audio(rendered());
  ASSERT_TRUE(audio.play(shared_tone(1), {.loop = true, .bus = Bus::kMusic}));
  const double full = listen(audio, at({0, 0})).both();
  EXPECT_GT(full, 0.1);
  EXPECT_NEAR(listen(audio, at({500, -3})).both(), full, 0.01 * full);
  audio.set_volume(Bus::kMusic, 0.5);
  EXPECT_NEAR(listen(audio, at({0, 0})).both(), 0.5 * full, 0.01 * full);
  audio.set_master_volume(0.5);
  EXPECT_NEAR(listen(audio, at({0, 0})).both(), 0.25 * full, 0.01 * full);
  audio.set_volume(Bus::kEffects, 0);
  EXPECT_NEAR(listen(audio, at({0, 0})).both(), 0.25 * full, 0.01 * full);
  audio.set_master_volume(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NEAR(listen(audio, at({0, 0})).both(), 0, 1e-4);
}

TEST(Audio, TheChannelsOfAClipStayApart) {
  Audio audio(rendered());
  ASSERT_TRUE(audio.play(shared_tone(1, 2), {.loop = true}));
  const Heard heard = listen(audio, at({0, 0}));
  EXPECT_GT(heard.left, 0.1);
  EXPECT_NEAR(heard.right, 0, 1e-3);
}

TEST(Audio, ASoundStopsOnRequestAndAtItsEnd) {
  Audio audio(rendered());
  const auto loop = audio.play(shared_tone(0.1), {.loop = true});
  EXPECT_GT(listen(audio, at({0, 0}), 2).both(), 0.1);
  audio.stop(*loop);
  EXPECT_FALSE(audio.plays(*loop));
  EXPECT_NEAR(listen(audio, at({0, 0})).both(), 0, 1e-4);
  const auto once = audio.play(shared_tone(0.5), {});
  listen(audio, at({0, 0}), 0.4);
  EXPECT_TRUE(audio.plays(*once));
  listen(audio, at({0, 0}), 0.3);
  EXPECT_FALSE(audio.plays(*once));
  const auto quick = audio.play(shared_tone(0.5), {.pitch = 2});
  listen(audio, at({0, 0}), 0.4);
  EXPECT_FALSE(audio.plays(*quick));
  audio.stop(SoundId::kNone);
  audio.stop(*once);
}

TEST(Audio, APausedBusIsSilentAndResumesAtItsPosition) {
  Audio audio(rendered());
  const auto sound = audio.play(shared_tone(1), {});
  listen(audio, at({0, 0}), 0.6);
  audio.set_paused(Bus::kEffects, true);
  EXPECT_NEAR(listen(audio, at({0, 0}), 2).both(), 0, 1e-4);
  EXPECT_TRUE(audio.plays(*sound));
  audio.set_paused(Bus::kEffects, false);
  EXPECT_GT(listen(audio, at({0, 0}), 0.2).both(), 0.1);
  EXPECT_TRUE(audio.plays(*sound));
  listen(audio, at({0, 0}), 0.4);
  EXPECT_FALSE(audio.plays(*sound));
}

TEST(Audio, TheLoudestHaveTheVoicesAndTheOthersAdvanceSilently) {
  Audio audio(rendered(4));
  const core::CameraPose listener = at({0, 0});
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(audio.play(shared_tone(0.3), placed(listener, 10 + i, 0)));
  listen(audio, listener, 0.1);
  EXPECT_EQ(audio.heard(), 4U);
  EXPECT_EQ(audio.playing(), 20U);
  const double before = listen(audio, listener).both();
  ASSERT_TRUE(audio.play(shared_tone(0.3), placed(listener, 1, 0)));
  EXPECT_GT(listen(audio, listener).both(), 2 * before);
  EXPECT_EQ(audio.heard(), 4U);
  Play once = placed(listener, 50, 0);
  once.loop = false;
  const auto quiet = audio.play(shared_tone(0.3), once);
  listen(audio, listener, 0.4);
  EXPECT_FALSE(audio.plays(*quiet)) << "it ended without a voice";
}

TEST(Audio, AStreamSoundsLikeItsFileAndLoops) {
  const TemporaryFolder folder;
  testing::write_sound(folder / "tone.ogg", testing::tone(1.5), SF_FORMAT_OGG | SF_FORMAT_VORBIS);
  Audio audio(rendered());
  ASSERT_TRUE(audio.play(shared_tone(1), {.loop = true}));
  const double clip = listen(audio, at({0, 0})).both();
  Audio other(rendered());
  const auto stream = other.stream(folder / "tone.ogg", {.bus = Bus::kMusic});
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_NEAR(listen(other, at({0, 0}), 1).both(), clip, 0.05 * clip);
  EXPECT_TRUE(other.plays(*stream));
  listen(other, at({0, 0}), 0.7);
  EXPECT_FALSE(other.plays(*stream));
  ASSERT_TRUE(other.stream(folder / "tone.ogg", {.loop = true}));
  EXPECT_NEAR(listen(other, at({0, 0}), 6).both(), clip, 0.05 * clip);
}

TEST(Audio, WithoutADeviceTimePassesAndSoundsEnd) {
  const TemporaryFolder folder;
  testing::write_sound(folder / "tone.wav", testing::tone(1), SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  Audio audio({Destination::kNowhere, kBlock_m, 32});
  EXPECT_FALSE(audio.has_output());
  const auto once = audio.play(shared_tone(1), {});
  const auto loop = audio.play(shared_tone(1), {.loop = true});
  const auto stream = audio.stream(folder / "tone.wav", {});
  for (int i = 0; i < 40; ++i)
    audio.update(at({0, 0}), kFrame_s);
  EXPECT_TRUE(audio.plays(*once) && audio.plays(*stream));
  EXPECT_EQ(audio.heard(), 0U);
  for (int i = 0; i < 20; ++i)
    audio.update(at({0, 0}), kFrame_s);
  EXPECT_FALSE(audio.plays(*once) || audio.plays(*stream));
  EXPECT_TRUE(audio.plays(*loop));
  EXPECT_EQ(audio.render(10), std::vector<float>(20));
}

TEST(Audio, SoundsContinueWhenTheOutputIsLostAndFound) {
  const TemporaryFolder folder;
  testing::write_sound(folder / "tone.wav", testing::tone(3), SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  Audio audio(rendered());
  const auto clip = audio.play(shared_tone(3), {});
  const auto stream = audio.stream(folder / "tone.wav", {});
  listen(audio, at({0, 0}), 1);
  audio.set_destination(Destination::kNowhere);
  EXPECT_NEAR(listen(audio, at({0, 0}), 1).both(), 0, 1e-9);
  audio.set_destination(Destination::kRendered);
  EXPECT_GT(listen(audio, at({0, 0}), 0.8).both(), 0.1);
  EXPECT_TRUE(audio.plays(*clip) && audio.plays(*stream));
  listen(audio, at({0, 0}), 0.4);
  EXPECT_FALSE(audio.plays(*clip) || audio.plays(*stream));
}

TEST(Audio, WrongValuesAreErrors) {
  Audio audio({Destination::kNowhere, kBlock_m, 0});
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [&](const Play& how, std::uint32_t channels = 1) {
    const auto played = audio.play(shared_tone(0.1, channels), how);
    return played ? std::string("it was played") : played.error().message;
  };
  EXPECT_EQ(refusal({.gain = kNan}), "a sound has gain nan; it must be 0 to 4");
  EXPECT_EQ(refusal({.pitch = 0}), "a sound has pitch 0; it must be 0.25 to 4");
  EXPECT_EQ(refusal({.range = {5, 5}}),
            "a sound has a range of 5 to 5 m; it must be within 0.001 to 10^9 m");
  EXPECT_EQ(refusal({.at = core::WorldPosition{}}, 2),
            "a sound with a position must have one channel (mono())");
  EXPECT_EQ(refusal({.at = core::WorldPosition{{}, {kNan, 0, 0}}}),
            "a sound has a position that is not finite or is out of range");
  EXPECT_FALSE(audio.play(nullptr, {}));
  EXPECT_FALSE(audio.stream("/none.ogg", {}));
  EXPECT_EQ(audio.playing(), 0U);
  const auto sound = audio.play(shared_tone(0.1), {});
  EXPECT_FALSE(audio.change(*sound, {.gain = -1}));
  EXPECT_TRUE(audio.change(*sound, {.gain = 0.5}));
  audio.update(at({0, 0}), kNan);
  audio.update(at({0, 0}), -1);
  EXPECT_TRUE(audio.plays(*sound)) << "such a time is none";
  audio.update({{{}, {kNan, 0, 0}}, 0, 0}, 1);
  EXPECT_FALSE(audio.plays(*sound)) << "time passes also where the listener is ignored";
}

TEST(Audio, AListenerThatIsNotFiniteKeepsItsPositionAndStreamsContinue) {
  const TemporaryFolder folder;
  testing::write_sound(folder / "tone.wav", testing::tone(4), SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  Audio audio(rendered());
  const core::CameraPose listener = at({5, 5});
  ASSERT_TRUE(audio.stream(folder / "tone.wav", placed(listener, 3, 0)));
  const Heard before = listen(audio, listener);
  EXPECT_GT(before.right, 2 * before.left);
  core::CameraPose nowhere = listener;
  nowhere.position.local.x = std::numeric_limits<double>::quiet_NaN();
  const Heard after = listen(audio, nowhere, 3);
  EXPECT_NEAR(after.left, before.left, 0.02 * before.left);
  EXPECT_NEAR(after.right, before.right, 0.02 * before.right);
}

TEST(Audio, EndlessTimeCountsAsAMinute) {
  Audio audio({Destination::kNowhere, kBlock_m, 32});
  const auto once = audio.play(shared_tone(61), {});
  ASSERT_TRUE(audio.play(shared_tone(1), {.loop = true}));
  audio.update(at({0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(audio.plays(*once));
  audio.update(at({0, 0}), 2);
  EXPECT_FALSE(audio.plays(*once));
  audio.set_destination(Destination::kRendered);
  EXPECT_GT(listen(audio, at({0, 0})).both(), 0.1) << "the loop has kept a place";
}

TEST(Audio, AStreamIsDecodedPieceByPiece) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "tone.wav";
  testing::write_sound(file, testing::tone(3), SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  Audio audio(rendered());
  ASSERT_TRUE(audio.stream(file, {}));
  audio.update(at({0, 0}), kFrame_s);
  // The file is silent from here on, so later sound was decoded in the first update.
  std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
  out.seekp(44);
  out << std::string(std::size_t{3} * 48'000 * 2, '\0') << std::flush;
  EXPECT_GT(listen(audio, at({0, 0}), 0.4).both(), 0.1);
  listen(audio, at({0, 0}), 0.2);
  EXPECT_NEAR(listen(audio, at({0, 0}), 0.3).both(), 0, 1e-4) << "0.6 to 0.9 s";
}

TEST(Audio, AStreamContinuesAtLowFrameRates) {
  const TemporaryFolder folder;
  testing::write_sound(folder / "tone.wav", testing::tone(5), SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  Audio audio(rendered());
  ASSERT_TRUE(audio.stream(folder / "tone.wav", {}));
  for (int frame = 0; frame < 12; ++frame) {  // of 0.35 s
    audio.update(at({0, 0}), 0.35);
    const std::vector<float> samples = audio.render(16'800);
    for (std::size_t i = 2000; i < samples.size(); i += 1000) {
      float loudest = 0;
      for (std::size_t k = i - 1000; k < i; ++k)
        loudest = std::max(loudest, std::abs(samples[k]));
      ASSERT_GT(loudest, 0.1F) << "frame " << frame << ", sample " << i;
    }
  }
}

}  // namespace
}  // namespace psygen::audio
