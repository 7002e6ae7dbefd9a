#include "editor/attach/remote_session.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <QCoreApplication>
#include <functional>

#include "engine/app/session.hpp"
#include "engine/inspect/inspect.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::editor {
namespace {

// An inspected session in the same thread.
class RemoteSessionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0);
    app::SessionOptions options;
    options.world_file = source_file("game/worlds/paper.toml");
    options.headless = true;
    options.size = {160, 90};
    options.scene.virtual_time = true;
    options.scene.view_distance_m = 100;
    options.scene.budget_bytes = 64ull << 20;
    options.plugins.push_back(inspect::plugin({folder_.path()}));
    auto session = app::Session::create(std::move(options));
    ASSERT_TRUE(session) << session.error().message;
    session_ = std::move(*session);
    QObject::connect(&remote_, &RemoteSession::attached,
                     [this](const QJsonObject&, const std::string& text) { text_ = text; });
    QObject::connect(&remote_, &RemoteSession::ended, [this](const QString& s) { end_ = s; });
    QObject::connect(&remote_, &RemoteSession::message_posted,
                     [this](const QString& s) { told_ = s; });
    QObject::connect(&remote_, &RemoteSession::world_applied, [this] { ++taken_; });
    QObject::connect(&remote_, &RemoteSession::entities, [this](const QJsonObject&) { ++maps_; });
    QObject::connect(&remote_, &RemoteSession::systems, [this](const QJsonObject&) { ++systems_; });
    const auto found = inspect::endpoints(folder_.path());
    ASSERT_EQ(found->size(), 1U);
    for (int i = 0; i < 3; ++i)
      tick();
    const auto ok = remote_.attach(found->front());
    ASSERT_TRUE(ok) << ok.error().message;
    ASSERT_TRUE(until([this] { return text_.has_value(); }));
  }
  void tick() {
    if (!session_) return;
    ASSERT_TRUE(session_->tick(session_->home(), 1.0 / 60));
  }
  // Runs both sessions until a condition is true.
  bool until(const std::function<bool()>& so) {
    for (int i = 0; i < 100'000 && !so(); ++i) {
      tick();
      QCoreApplication::processEvents();
    }
    return so();
  }
  std::string written() const {
    const scene::WorldFacts& facts = session_->scene().facts();
    return world::write_world(facts.world, facts.registry);
  }
  std::string with_seed(const std::string& digits) const {
    std::string text = *text_;
    return text.insert(text.find("seed = ") + 7, digits);
  }

  TemporaryFolder folder_;
  std::unique_ptr<app::Session> session_;
  RemoteSession remote_;
  std::optional<std::string> text_;
  std::optional<QString> end_;
  QString told_;
  int taken_ = 0, maps_ = 0, systems_ = 0;
};

TEST_F(RemoteSessionTest, ReceivesTheStatisticsOfTheSession) {
  EXPECT_TRUE(until([this] { return maps_ > 1 && systems_ > 1; }));
  ASSERT_TRUE(remote_.pose());
  EXPECT_EQ(remote_.pose()->yaw, session_->home().yaw);
}

TEST_F(RemoteSessionTest, SendsTheNewestWorldAndRestoresTheOldOne) {
  const std::string before = written();
  for (const char* digits : {"1", "2", "3", "4"})
    remote_.set_world(with_seed(digits));
  ASSERT_TRUE(until([this] { return taken_ > 0; }));
  const std::string changed = written();
  EXPECT_NE(changed, before);
  EXPECT_NE(changed.find("seed = 4"), std::string::npos);
  remote_.set_world("nonsense");
  EXPECT_TRUE(until([this] { return !told_.isEmpty(); }));
  EXPECT_EQ(written(), changed);
  remote_.detach(false);
  EXPECT_EQ(end_, QString());
  EXPECT_TRUE(until([&] { return written() == before; }));
}

TEST_F(RemoteSessionTest, KeepsChangesEvenIfTheyWereJustSent) {
  remote_.set_world(with_seed("1"));
  remote_.set_world(with_seed("5"));
  remote_.detach(true);
  EXPECT_TRUE(until([this] { return end_.has_value(); }));
  EXPECT_EQ(end_, QString());
  EXPECT_NE(written().find("seed = 5"), std::string::npos);
}

TEST_F(RemoteSessionTest, NoticesTheEndOfTheSession) {
  session_.reset();
  EXPECT_TRUE(until([this] { return end_.has_value(); }));
  EXPECT_FALSE(end_->isEmpty());
  EXPECT_FALSE(remote_.is_attached());
}

}  // namespace
}  // namespace psygen::editor
