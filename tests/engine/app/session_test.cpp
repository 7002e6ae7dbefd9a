// A session without a flight: what a program with a loop of its own relies on.
#include "engine/app/session.hpp"

#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

TEST(Session, IsDrivenByALoopOfItsOwnUntilItIsClosed) {
  auto session = Session::create(short_session());
  ASSERT_TRUE(session) << session.error().message;
  const core::CameraPose pose = (*session)->home();
  ASSERT_TRUE((*session)->prepare(pose));
  int ticks = 0;
  while ((*session)->poll()) {
    EXPECT_DOUBLE_EQ((*session)->now_s(), 0.25 * ticks);
    ASSERT_TRUE((*session)->tick(pose, 0.25));
    EXPECT_EQ((*session)->scene().state().counters.holes, 0u);
    if (++ticks == 3) (*session)->close();
  }
  EXPECT_EQ(ticks, 3);
  EXPECT_TRUE((*session)->over());
  EXPECT_FALSE((*session)->stopped());
  EXPECT_EQ((*session)->trace(), nullptr);
  EXPECT_TRUE((*session)->renderer().validation_messages().empty());
}

TEST(Session, EndsWhenItIsStoppedFromOutside) {
  std::atomic<bool> stop = false;
  SessionOptions options = short_session();
  options.stop = &stop;
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_TRUE((*session)->poll());
  stop = true;
  EXPECT_FALSE((*session)->poll());
  EXPECT_TRUE((*session)->stopped());
}

TEST(Session, CallsPluginsHoweverItIsDriven) {
  std::vector<std::string> calls;
  SessionOptions options = short_session();
  options.plugins.push_back({.name = "counter",
                             .on_start = [&](Session&) { calls.push_back("start"); },
                             .on_frame =
                                 [&](Session&, double dt_s) {
                                   EXPECT_EQ(dt_s, 0.5);
                                   calls.push_back("frame");
                                 }});
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_TRUE(calls.empty()) << "before the first tick";
  for (int i = 0; i < 2; ++i)
    ASSERT_TRUE((*session)->tick((*session)->home(), 0.5));
  EXPECT_EQ(calls, (std::vector<std::string>{"start", "frame", "frame"}));
}

TEST(Session, SavesThePictureOfTheLastTickAndChangesItsPreset) {
  SessionOptions options = short_session();
  options.preset = render::Preset::kLow;
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  const auto file = fresh_folder() / "picture.png";
  std::filesystem::create_directories(file.parent_path());
  EXPECT_FALSE((*session)->save_picture(file)) << "there is none";
  EXPECT_TRUE((*session)->take_saved().empty());
  ASSERT_TRUE((*session)->tick((*session)->home(), 0));
  ASSERT_TRUE((*session)->save_picture(file));
  EXPECT_EQ((*session)->take_saved(), std::vector{file});
  EXPECT_TRUE((*session)->take_saved().empty()) << "told once";
  ASSERT_TRUE((*session)->set_preset(render::Preset::kMedium));
  EXPECT_EQ((*session)->scene().state().facts.shadows, (*session)->renderer().casts_shadows());
  ASSERT_TRUE((*session)->tick((*session)->home(), 0));
  EXPECT_EQ((*session)->renderer().preset(), render::Preset::kMedium);
}

}  // namespace
}  // namespace psygen::app
