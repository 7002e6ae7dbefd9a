// The game in a session without a window: equal for any number of modelers, silent validation,
// recorded input, settings, and rejected files.
#include <sys/stat.h>

#include <fstream>

#include "engine/scene/objects/assets.hpp"
#include "game/show/scenery.hpp"
#include "tests/game/game_fixture.hpp"

namespace cairns {
namespace {

class GameSession : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  GameOptions options(std::uint64_t seed = 3) const {
    GameOptions o;
    o.seed = std::to_string(seed);
    o.autoplay = o.headless = true;
    o.sound = false;
    o.folder = folder_;
    o.size = {96, 54};
    o.preset = render::Preset::kLow;
    return o;
  }
  std::filesystem::path folder_ = test_folder("game_session");
};

TEST_F(GameSession, PlaysTheSameForAnyNumberOfModelers) {
  std::optional<core::WorldPosition> first;
  for (const unsigned modelers : {1U, 3U}) {
    std::filesystem::remove_all(folder_);
    GameOptions o = options();
    o.modelers = modelers;
    Running run(o);
    ASSERT_TRUE(run.open());
    run.frames(420);
    const core::WorldPosition at = run.game.play()->progress().feet;
    EXPECT_GT(run.game.play()->walker().walked_m(), 20);
    if (!first) first = at;
    EXPECT_EQ(at.block, first->block);
    EXPECT_EQ(at.local, first->local);
  }
}

TEST_F(GameSession, IsDrawnWithoutValidationMessages) {
  for (const render::Preset preset : {render::Preset::kLow, render::Preset::kHigh}) {
    std::filesystem::remove_all(folder_);
    GameOptions o = options(5);
    o.preset = preset;
    Running run(o);
    ASSERT_TRUE(run.open(true));
    run.frames(preset == render::Preset::kLow ? 120 : 20);
    EXPECT_EQ(run.session->renderer().validation_messages(), std::vector<std::string>{});
  }
}

TEST_F(GameSession, ResumesItsSave) {
  core::WorldPosition at;
  {
    Running run(options());
    ASSERT_TRUE(run.open());
    run.frames(240);
    at = run.game.play()->progress().feet;
    ASSERT_TRUE(run.game.end());
  }
  Running again(options());
  ASSERT_TRUE(again.open());
  EXPECT_EQ(again.game.play()->progress().feet.local, at.local);
  // A second process gets an error while the game runs.
  Running second(options());
  const auto opened = second.open();
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("3.cairns"), std::string::npos);
}

// Without this a session could fell only about 65,000 trees.
TEST_F(GameSession, FelledTreesReleaseTheirMeshes) {
  Running run(options());
  ASSERT_TRUE(run.open());
  Scenery scenery;
  ASSERT_TRUE(scenery.open(*run.session));
  run.frames(1);
  const Play& play = *run.game.play();
  world::Placement tree;
  tree.model = static_cast<models::ModelIndex>(play.registry().find("tree"));
  tree.parameters = models::default_parameters(play.registry()[tree.model]);
  const Happening felled{
      .kind = Happening::Kind::kFelled, .at = play.progress().feet, .tree = tree};
  const scene::Assets& assets = run.session->scene().assets();
  const std::size_t before = assets.mesh_count();
  scenery.tell(*run.session, felled, play);
  EXPECT_EQ(assets.mesh_count(), before + 1);
  run.frames(240);  // it falls and comes to rest
  scenery.update(*run.session, play, 1, 12);
  EXPECT_EQ(assets.mesh_count(), before + 1);
  run.frames(240);
  scenery.update(*run.session, play, 1, 12);
  EXPECT_EQ(assets.mesh_count(), before);
  scenery.tell(*run.session, felled, play);
  scenery.clear(*run.session);
  EXPECT_EQ(assets.mesh_count(), before);
}

TEST_F(GameSession, ReplaysRecordedInput) {
  core::WorldPosition at;
  double yaw = 0;
  for (const bool replay : {false, true}) {
    GameOptions o = options();
    o.autoplay = false;
    (replay ? o.replay : o.record) = folder_ / "input";
    Running run(o);
    ASSERT_TRUE(run.open());
    for (int k = 0; k < 300; ++k) {
      if (!replay) {
        platform::InputState input;
        const auto held = [&](platform::Key key, bool is) {
          input.held.set(static_cast<std::size_t>(key), is);
        };
        held(platform::Key::kW, k > 20);
        held(platform::Key::kLeftShift, k > 100);
        if (k == 150) input.went_down.set(static_cast<std::size_t>(platform::Key::kSpace));
        run.session->actions().feed(input);
      }
      ASSERT_TRUE(
          run.session->tick(run.game.frame(*run.session, Running::kFrameS), Running::kFrameS));
    }
    const Play& play = *run.game.play();
    if (replay) {
      EXPECT_EQ(play.progress().feet.local, at.local);
      EXPECT_EQ(play.progress().yaw, yaw);
    } else {
      at = play.progress().feet;
      yaw = play.progress().yaw;
      EXPECT_GT(play.walker().walked_m(), 8);
      std::filesystem::create_directories(folder_);
    }
    ASSERT_TRUE(run.game.end());
  }
}

TEST_F(GameSession, KeepsSettingsAndReportsBrokenFilesWithoutChangingThem) {
  input::Actions actions;
  ASSERT_TRUE(add_actions(actions));
  std::filesystem::create_directories(folder_);
  Settings settings;
  settings.fov_deg = 77;
  settings.colour_blind = true;
  settings.quality = 2;
  ASSERT_TRUE(
      actions.set_bindings(static_cast<input::ActionId>(Act::kJump), {{platform::Key::kJ}}));
  ASSERT_TRUE(save_settings(folder_, settings, actions));
  input::Actions fresh;
  ASSERT_TRUE(add_actions(fresh));
  ASSERT_TRUE(load_keys(folder_, fresh));
  const auto read = load_settings(folder_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->fov_deg, 77);
  EXPECT_TRUE(read->colour_blind);
  EXPECT_EQ(read->quality, 2);
  EXPECT_EQ(key_of(fresh, Act::kJump, nullptr), "J");
  for (const char* text : {"fov_deg = ", "\x01\x02", "[[", "fov_deg = \"wide\"\n= 4"}) {
    std::ofstream(folder_ / "settings.toml", std::ios::trunc) << text;
    const auto broken = load_settings(folder_);
    ASSERT_FALSE(broken) << text;
    EXPECT_NE(broken.error().message.find("settings.toml"), std::string::npos);
  }
  // Dotted keys nest tables; a pipe without a writer never ends.
  std::string nested = "a";
  for (int i = 0; i < 100'000; ++i)
    nested += ".a";
  std::ofstream(folder_ / "settings.toml", std::ios::trunc) << nested << " = 1";
  EXPECT_FALSE(load_settings(folder_));
  std::filesystem::remove(folder_ / "settings.toml");
  ASSERT_EQ(mkfifo((folder_ / "settings.toml").c_str(), 0600), 0);
  EXPECT_FALSE(load_settings(folder_));
  std::filesystem::remove(folder_ / "settings.toml");
  std::ofstream(folder_ / "settings.toml", std::ios::trunc)
      << "fov_deg = 1e9\nquality = -4\ntext = nan\n";
  const auto wild = load_settings(folder_);
  ASSERT_TRUE(wild);
  EXPECT_EQ(wild->fov_deg, 100);
  EXPECT_EQ(wild->quality, -1);
  EXPECT_TRUE(std::isfinite(wild->text));
}

TEST_F(GameSession, ReportsFoldersThatCannotBeCreated) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "file") << "x";
  GameOptions o = options();
  o.folder = folder_ / "file" / "saves";
  Running run(o);
  const auto opened = run.open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, core::ErrorCode::kIo);
}

// A gamepad controls the game as keys do.
TEST(Controls, APadMovesLooksAndJumps) {
  input::Actions actions;
  ASSERT_TRUE(add_actions(actions));
  platform::InputState input;
  input.pads[0].connected = true;
  input.pads[0].axes[static_cast<std::size_t>(platform::PadAxis::kLeftY)] = 1;
  input.pads[0].axes[static_cast<std::size_t>(platform::PadAxis::kRightX)] = -1;
  input.pads[0].held.set(static_cast<std::size_t>(platform::PadButton::kA));
  input.pads[0].went_down.set(static_cast<std::size_t>(platform::PadButton::kA));
  actions.feed(input);
  actions.step();
  const Intent intent = intent_of(actions, 1, 1.0 / 60);
  EXPECT_NEAR(intent.move.y, 1, 1e-6);
  EXPECT_LT(intent.turn, -0.01);
  EXPECT_TRUE(intent.jump);
  EXPECT_TRUE(intent.jump_held);
}

TEST(Synth, SoundsAreAudibleAndNotClipped) {
  const Clips made = make_clips();
  std::vector<ClipPtr> all{made.wind,   made.rain, made.water, made.fire,  made.music,
                           made.splash, made.chop, made.fall,  made.stone, made.chime};
  all.insert(all.end(), made.steps.begin(), made.steps.end());
  all.insert(all.end(), made.birds.begin(), made.birds.end());
  for (const ClipPtr& clip : all) {
    ASSERT_TRUE(audio::check_clip(*clip));
    int loudest = 0;
    std::size_t clipped = 0;
    for (const std::int16_t v : clip->samples) {
      loudest = std::max(loudest, std::abs(int{v}));
      clipped += std::abs(int{v}) > 32'760 ? 1 : 0;
    }
    EXPECT_GT(loudest, 2'000);
    EXPECT_LT(clipped, clip->samples.size() / 200);
  }
}

}  // namespace
}  // namespace cairns
