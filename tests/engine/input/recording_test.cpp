#include "engine/input/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "engine/core/hash.hpp"
#include "tests/engine/input/person.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::input {
namespace {

using platform::Key;
using ::testing::HasSubstr;

constexpr double kStepS = 1.0 / 60;

Actions recording_actions() {
  Actions actions;
  EXPECT_TRUE(actions.add("jump", {{Key::kSpace}}));
  EXPECT_TRUE(actions.add("move_x", {{Key::kD}, {PadAxisDirection::kLeftStickLeft, -1}}));
  EXPECT_TRUE(
      actions.add("look_x", {{MouseDirection::kRight, 0.3F}, {MouseDirection::kLeft, -0.3F}}));
  return actions;
}

struct Played {
  Recording recording;
  std::vector<std::vector<ActionState>> states;  // for every step
};

// A person who does something every now and then.
Played play(int steps) {
  Actions actions = recording_actions();
  Person person;
  std::mt19937 random(3);
  Played played{Recording(actions, kStepS), {}};
  while (static_cast<int>(played.states.size()) < steps) {
    if (random() % 7 == 0) person.tap(Key::kSpace);
    if (random() % 31 == 0) person.press(Key::kD);
    if (random() % 31 == 0) person.release(Key::kD);
    if (random() % 3 == 0) person.move(static_cast<double>(random() % 100) - 50, 0);
    person.set_axis(platform::PadAxis::kLeftX,
                    random() % 5 == 0 ? -static_cast<float>(random() % 1000) / 999.0F : 0.0F);
    actions.feed(person.frame());
    for (auto count = random() % 4; count > 0; --count) {
      actions.step();
      EXPECT_TRUE(played.recording.add(actions.states()));
      played.states.emplace_back(actions.states().begin(), actions.states().end());
    }
  }
  return played;
}

bool same_bits(std::span<const ActionState> a, std::span<const ActionState> b) {
  return std::ranges::equal(a, b, [](const ActionState& x, const ActionState& y) {
    return x == y && std::bit_cast<std::uint32_t>(x.value) == std::bit_cast<std::uint32_t>(y.value);
  });
}

TEST(Recording, ReplaysTheSameStatesFromItsFile) {
  const TemporaryFolder folder;
  const Played played = play(3000);
  const auto file = folder.path() / "a.input";
  ASSERT_TRUE(played.recording.save(file));
  auto loaded = Recording::load(file);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->steps(), played.states.size());
  Actions actions = recording_actions();
  auto replay = Replay::create(std::move(*loaded), actions, kStepS);
  ASSERT_TRUE(replay) << replay.error().message;
  for (const auto& states : played.states) {
    ASSERT_TRUE(replay->step(actions));
    ASSERT_TRUE(same_bits(actions.states(), states));
  }
  EXPECT_EQ(replay->steps_left(), 0u);
  EXPECT_FALSE(replay->step(actions));
  EXPECT_EQ(actions.state(0), ActionState{}) << "at rest after the end";
}

TEST(Recording, AppliesToActionsInAnotherOrderAndWithMoreOfThem) {
  const Played played = play(200);
  Actions other;
  for (const char* name : {"new", "look_x", "move_x", "jump"})
    ASSERT_TRUE(other.add(name));
  auto replay = Replay::create(played.recording, other, kStepS);
  ASSERT_TRUE(replay) << replay.error().message;
  for (const auto& states : played.states) {
    ASSERT_TRUE(replay->step(other));
    EXPECT_EQ(other.state(3), states[0]);
    EXPECT_EQ(other.state(1), states[2]);
    EXPECT_EQ(other.state(0), ActionState{});
  }
}

TEST(Recording, NeedsNoSpaceWithoutChanges) {
  Actions actions = recording_actions();
  Recording recording(actions, kStepS);
  const std::size_t empty = recording.bytes().size();
  for (int i = 0; i < 100'000; ++i)
    ASSERT_TRUE(recording.add(actions.states()));
  EXPECT_EQ(recording.bytes().size(), empty);
  EXPECT_EQ(recording.steps(), 100'000u);
  auto replay = Replay::create(recording, actions, kStepS);
  ASSERT_TRUE(replay);
  EXPECT_TRUE(replay->step(actions));
}

TEST(Recording, RejectsActionsAndStepsThatTheGameLacks) {
  const Played played = play(10);
  Actions other;
  ASSERT_TRUE(other.add("jump"));
  EXPECT_THAT(Replay::create(played.recording, other, kStepS).error().message,
              HasSubstr("\"move_x\""));
  EXPECT_THAT(Replay::create(played.recording, recording_actions(), 1.0 / 30).error().message,
              HasSubstr("60 steps per second"));
}

TEST(Recording, RejectsEveryFileThatIsTruncatedOrDamagedInAByte) {
  const std::string whole = play(60).recording.bytes();
  ASSERT_TRUE(Recording::parse(whole, "a.input"));
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    const auto refused = Recording::parse(whole.substr(0, bytes), "a.input");
    ASSERT_FALSE(refused) << bytes;
    EXPECT_EQ(refused.error().code, core::ErrorCode::kParse);
    EXPECT_THAT(refused.error().message, HasSubstr("a.input: "));
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    EXPECT_FALSE(Recording::parse(damaged, "a.input")) << at;
  }
  EXPECT_FALSE(Recording::parse(whole + "x", "a.input"));
}

TEST(Recording, RejectsForeignFilesAndNewerFormatsByName) {
  EXPECT_THAT(Recording::parse("PK\x03\x04 something", "a.zip").error().message,
              HasSubstr("a.zip: this is not a recording of input"));
  std::string newer = play(5).recording.bytes();
  newer[8] = 9;
  EXPECT_THAT(Recording::parse(newer, "a.input").error().message, HasSubstr("its format is 9"));
  EXPECT_EQ(Recording::load("/nowhere/a.input").error().code, core::ErrorCode::kIo);
}

// Inconsistent contents under a right hash, as a forger could make them.
TEST(Recording, RejectsInconsistentContentsWithARightHash) {
  const std::string whole = play(60).recording.bytes();
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string made = whole.substr(0, whole.size() - 8);
    made[8 + random() % (made.size() - 8)] = static_cast<char>(random());
    const std::uint64_t hash = core::hash_bytes(std::as_bytes(std::span(made.data(), made.size())));
    made.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
    const auto parsed = Recording::parse(made, "a.input");
    if (!parsed) {
      ++refused;
      continue;
    }
    Actions actions = recording_actions();
    auto replay = Replay::create(*parsed, actions, parsed->step_s());
    for (int step = 0; replay && step < 100 && replay->step(actions); ++step)
      EXPECT_TRUE(std::isfinite(actions.state(0).value));
  }
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace psygen::input
