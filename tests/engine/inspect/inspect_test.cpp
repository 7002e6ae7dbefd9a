#include "engine/inspect/inspect.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/cancellation.hpp"
#include "engine/inspect/client.hpp"
#include "engine/query/world.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::inspect {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::filesystem::path kWorld = source_file("game/worlds/paper.toml");

// A headless session on the virtual clock with inspection, and a client in the same thread.
class InspectTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0); }
  core::Result<std::unique_ptr<app::Session>> create() {
    app::SessionOptions options;
    options.world_file = kWorld;
    options.headless = true;
    options.size = {160, 90};
    options.scene.virtual_time = virtual_time_;
    options.scene.view_distance_m = 100;
    options.scene.budget_bytes = 64ull << 20;
    options.plugins = plugins_;
    options.plugins.push_back(plugin({folder_.path()}));
    return app::Session::create(std::move(options));
  }
  void open() {
    auto session = create();
    ASSERT_TRUE(session) << session.error().message;
    session_ = std::move(*session);
    pose_ = session_->home();
    tick();
  }
  void attach() {
    const auto found = endpoints(folder_.path());
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_EQ(found->size(), 1U);
    tick();  // cancels requests that the list has processed
    tick();
    auto client = Client::attach(found->front().socket);
    ASSERT_TRUE(client) << client.error().message;
    client_ = std::move(*client);
  }
  void greet() {
    attach();
    ASSERT_EQ(ask({{"do", "hello"}, {"protocol", kProtocol}})["ok"], true);
  }
  void tick() { ASSERT_TRUE(session_->tick(pose_, 1.0 / 60)); }
  // Returns the reply; null if there is none after some frames.
  json ask_line(const std::string& line) {
    client_->ask(line);
    for (int frame = 0; frame < 50; ++frame) {
      tick();
      if (const auto answer = client_->take_answer()) return json::parse(*answer);
    }
    return {};
  }
  json ask(const json& request) { return ask_line(request.dump()); }
  std::string written() const {
    const scene::WorldFacts& facts = session_->scene().facts();
    return world::write_world(facts.world, facts.registry);
  }
  std::string changed_text() { return changed_text_of(ask({{"do", "parameters"}})["text"]); }

  static std::string changed_text_of(std::string text) {
    const std::size_t at = text.find("seed = ");
    EXPECT_NE(at, std::string::npos);
    return text.insert(at + 7, "1");
  }

  bool virtual_time_ = true;
  std::vector<app::Plugin> plugins_;
  TemporaryFolder folder_;
  std::unique_ptr<app::Session> session_;
  std::unique_ptr<Client> client_;
  core::CameraPose pose_;
};

TEST_F(InspectTest, ReportsTheSessionAndItsStatistics) {
  open();
  greet();
  json answer = ask({{"id", 7}, {"do", "figures"}});
  EXPECT_EQ(answer["id"], 7);
  EXPECT_GT(answer["cache"]["bytes"], 0);
  EXPECT_EQ(answer["cache"]["budget_bytes"], 64 << 20);
  EXPECT_EQ(answer["camera"]["yaw"], pose_.yaw);
  answer = ask({{"do", "systems"}});
  std::vector<std::string> names;
  for (const json& system : answer["systems"])
    names.push_back(system["name"]);
  EXPECT_THAT(names, ::testing::IsSupersetOf({"inspect", "cache", "render"}));
  answer = ask({{"do", "entities"}});
  EXPECT_GT(answer["nodes"].size(), 3U);
  EXPECT_EQ(answer["nodes"][0].size(), 9U);
  EXPECT_GT(answer["kinds"]["terrain"]["entities"], 0);
  EXPECT_EQ(ask({{"do", "parameters"}})["text"], *world::read_text_file(kWorld));
}

TEST_F(InspectTest, RequiresHelloFirstAndTheRightProtocol) {
  open();
  attach();
  EXPECT_THAT(ask({{"do", "figures"}})["error"].dump(), HasSubstr("hello"));
  EXPECT_EQ(ask({{"do", "hello"}})["ok"], false);
  EXPECT_EQ(ask({{"do", "hello"}, {"protocol", "psygen.inspect/99"}})["ok"], false);
  EXPECT_EQ(ask({{"do", "hello"}, {"protocol", kProtocol}})["world"], "paper");
}

TEST_F(InspectTest, LeavesNoTrace) {
  open();
  greet();
  const std::string before = written();
  ASSERT_EQ(ask({{"do", "set_world"}, {"text", changed_text()}})["ok"], true);
  EXPECT_NE(written(), before);
  ASSERT_EQ(ask({{"do", "pause"}, {"on", true}})["ok"], true);
  EXPECT_TRUE(session_->paused());
  json pose = ask({{"do", "figures"}})["camera"];
  pose["yaw"] = 1.25;
  ASSERT_EQ(ask({{"do", "pose"}, {"pose", pose}})["ok"], true);
  tick();
  EXPECT_EQ(session_->scene().camera().pose.yaw, 1.25);
  client_.reset();  // a crash of the client
  tick();
  tick();
  EXPECT_EQ(written(), before);
  EXPECT_FALSE(session_->paused());
  EXPECT_EQ(session_->scene().camera().pose.yaw, pose_.yaw);
}

TEST_F(InspectTest, QueriesOfTheGameFollowEveryReplacedWorld) {
  open();
  greet();
  const scene::Scene& scene = session_->scene();
  query::World query(scene.world(), scene.registry());
  const auto expect_like_new = [&] {
    query::World fresh(scene.world(), scene.registry());
    for (int i = 0; i < 20; ++i) {
      core::WorldPosition at = pose_.position;
      at.local += glm::dvec3(13.7 * i, 0, 7.1 * i);
      EXPECT_EQ(query.ground(at)->height_m, fresh.ground(at)->height_m);
    }
    return fresh.ground(pose_.position)->height_m;
  };
  const double before_m = expect_like_new();
  ASSERT_EQ(ask({{"do", "set_world"}, {"text", changed_text()}})["ok"], true);
  EXPECT_GT(std::abs(expect_like_new() - before_m), 0.5);
  ASSERT_EQ(ask({{"do", "detach"}})["ok"], true);
  tick();
  tick();
  EXPECT_EQ(expect_like_new(), before_m);
}

TEST_F(InspectTest, KeepsChangesOnRequest) {
  open();
  greet();
  ASSERT_EQ(ask({{"do", "set_world"}, {"text", changed_text()}})["ok"], true);
  const std::string changed = written();
  ASSERT_EQ(ask({{"do", "detach"}, {"keep", true}})["ok"], true);
  tick();
  EXPECT_EQ(client_->take_answer(), std::nullopt);
  EXPECT_FALSE(client_->is_open());
  EXPECT_EQ(written(), changed);
}

// A model type whose registration, a part of preparing a world, blocks in other threads.
struct SlowTypes {
  std::thread::id main = std::this_thread::get_id();
  std::mutex gate;
  std::atomic<int> entered = 0;

  app::Plugin plugin() {
    app::Plugin slow;
    slow.name = "slow";
    slow.register_models = [this](models::Registry&) -> core::Result<void> {
      if (std::this_thread::get_id() == main) return {};
      ++entered;
      const std::lock_guard wait(gate);
      return {};
    };
    return slow;
  }
};

TEST_F(InspectTest, FramesContinueWhileAnotherThreadPreparesAWorld) {
  SlowTypes slow;
  virtual_time_ = false;
  plugins_.push_back(slow.plugin());
  open();
  greet();
  const std::string before = written(), text = changed_text();
  std::unique_lock closed(slow.gate);
  client_->ask(json({{"id", 1}, {"do", "set_world"}, {"text", text}}).dump());
  client_->ask(json({{"id", 2}, {"do", "figures"}}).dump());
  while (slow.entered == 0)
    tick();
  for (int frame = 0; frame < 5; ++frame)
    tick();
  EXPECT_EQ(client_->take_answer(), std::nullopt);
  EXPECT_EQ(written(), before);
  closed.unlock();
  std::vector<json> answers;
  while (answers.size() < 2) {
    tick();
    if (const auto answer = client_->take_answer()) answers.push_back(json::parse(*answer));
  }
  EXPECT_EQ(answers[0]["id"], 1) << "in order";
  EXPECT_EQ(answers[0]["ok"], true);
  EXPECT_EQ(answers[1]["id"], 2);
  EXPECT_NE(written(), before);
  // The client leaves during the next change: that world is never shown, and the first one returns.
  closed.lock();
  slow.entered = 0;
  client_->ask(json({{"do", "set_world"}, {"text", changed_text_of(text)}}).dump());
  while (slow.entered == 0)
    tick();
  client_.reset();
  tick();
  closed.unlock();
  while (written() != before)
    tick();
  attach();
  EXPECT_EQ(ask({{"do", "hello"}, {"protocol", kProtocol}})["ok"], true);
  // The session ends during a change.
  closed.lock();
  slow.entered = 0;
  client_->ask(json({{"do", "set_world"}, {"text", text}}).dump());
  while (slow.entered == 0)
    tick();
  closed.unlock();
  session_.reset();
}

// Model types whose preparation for a second world lasts until it is cancelled.
struct EndlessTypes {
  std::atomic<int> calls{0}, cancelled{0};
  std::function<void()> meanwhile = [] {};
  app::Plugin plugin() {
    app::Plugin plugin;
    plugin.name = "endless";
    plugin.register_models = [this](models::Registry&) -> core::Result<void> {
      if (calls++ == 0) return {};
      meanwhile();
      while (!core::is_cancelled())
        std::this_thread::yield();
      ++cancelled;
      return core::check_cancelled();
    };
    return plugin;
  }
};

TEST_F(InspectTest, AChangeEndsWithItsClientAndWithTheSession) {
  EndlessTypes endless;
  virtual_time_ = false;
  plugins_.push_back(endless.plugin());
  open();
  greet();
  const std::string before = written();
  const json change = {{"do", "set_world"}, {"text", changed_text()}};
  client_->ask(change.dump());
  while (endless.calls < 2)
    tick();
  client_.reset();
  while (endless.cancelled == 0)
    tick();
  greet();
  EXPECT_EQ(written(), before);
  client_->ask(change.dump());
  while (endless.calls < 3)
    tick();
  session_.reset();
  EXPECT_EQ(endless.cancelled, 2);
}

TEST_F(InspectTest, AChangeEndsWithItsClientOnAVirtualClockToo) {
  EndlessTypes endless;
  endless.meanwhile = [&] { client_.reset(); };
  plugins_.push_back(endless.plugin());
  open();
  greet();
  const std::string before = written();
  client_->ask(json({{"do", "set_world"}, {"text", changed_text()}}).dump());
  client_->ask(json({{"do", "world"}}).dump());  // waits unread while the client leaves
  while (endless.cancelled == 0)
    tick();
  EXPECT_EQ(written(), before);
  greet();
}

TEST_F(InspectTest, DoesNotUndoLaterChangesOfTheGame) {
  open();
  greet();
  const std::string text = changed_text();
  ASSERT_EQ(ask({{"do", "set_world"}, {"text", text}})["ok"], true);
  std::string of_the_game = text;
  of_the_game.insert(of_the_game.find("seed = ") + 7, "2");
  ASSERT_TRUE(session_->set_world(of_the_game));
  const std::string wanted = written();
  client_.reset();
  tick();
  tick();
  EXPECT_EQ(written(), wanted);
}

TEST_F(InspectTest, RejectsInvalidWorldsWithoutAnyChange) {
  open();
  greet();
  const std::string before = written();
  const json answer = ask({{"do", "set_world"}, {"text", "format = 1\nnonsense"}});
  EXPECT_EQ(answer["ok"], false);
  EXPECT_FALSE(std::string(answer["error"]).empty());
  EXPECT_EQ(written(), before);
}

TEST_F(InspectTest, AnswersInvalidRequestsWithAnErrorMessage) {
  open();
  greet();
  const std::string lines[] = {
      "",
      "garbage",
      "{",
      "[]",
      "null",
      std::string(100'000, '['),
      "{\"do\": 3}",
      "{\"do\": \"nothing\"}",
      "{\"do\": \"set_world\"}",
      "{\"do\": \"set_world\", \"text\": {}}",
      "{\"do\": \"pause\", \"on\": \"yes\"}",
      "{\"do\": \"pose\", \"pose\": 1}",
      R"({"do":"pose","pose":{"block":[1e300,0],"local_m":[0,0,0],"yaw":0,"pitch":0}})",
      R"({"do":"pose","pose":{"block":[0,0],"local_m":[1e300,0,0],"yaw":0,"pitch":0}})",
      "{\"do\": \"\xff\xfe\"}",
      std::string("\0\x01{}", 4),
      "{\"id\": [1], \"do\": \"figures\", \"do\": 1}"};
  for (const std::string& line : lines) {
    const json answer = ask_line(line);
    EXPECT_EQ(answer.value("ok", true), false) << line.substr(0, 80) << " → " << answer;
    EXPECT_GT(answer.value("error", "").size(), 10U);
  }
  EXPECT_EQ(ask({{"do", "figures"}})["ok"], true);
}

TEST_F(InspectTest, SurvivesADisconnectAtAnyPoint) {
  open();
  greet();
  const std::string before = written();
  const auto found = endpoints(folder_.path());
  client_.reset();
  const std::string talk = json({{"do", "hello"}, {"protocol", kProtocol}}).dump() + "\n" +
                           json({{"do", "set_world"}, {"text", "x"}}).dump() + "\n" +
                           json({{"do", "entities"}}).dump() + "\n";
  for (std::size_t bytes = 0; bytes < talk.size(); bytes += 3) {
    tick();
    tick();
    auto client = Client::attach(found->front().socket);
    ASSERT_TRUE(client);
    client_ = std::move(*client);
    client_->ask(talk.substr(0, bytes));
    if (bytes % 2 == 0) tick();
    client_.reset();
  }
  tick();
  tick();
  EXPECT_EQ(written(), before);
  attach();
  EXPECT_EQ(ask({{"do", "hello"}, {"protocol", kProtocol}})["ok"], true);
}

TEST_F(InspectTest, AnswersAFloodWithAFewRepliesAFrame) {
  open();
  greet();
  std::string flood;
  for (int i = 0; i < 2000; ++i)
    flood += "{\"do\":\"entities\"}\n";
  flood.pop_back();
  client_->ask(flood);
  for (int frame = 0; frame < 20; ++frame)
    tick();  // the client does not read
  std::size_t answers = 0;
  for (int frame = 0; frame < 400 && answers < 2000; ++frame) {
    tick();
    while (client_->take_answer())
      ++answers;
  }
  EXPECT_EQ(answers, 2000U);
}

TEST_F(InspectTest, SurvivesRandomBytes) {
  open();
  attach();
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    std::string bytes(random() % 500, ' ');
    for (char& c : bytes)
      c = static_cast<char>(random() % 4 == 0 ? "{}[]\",:\n"[random() % 8] : random() % 256);
    client_->ask(bytes);
    tick();
    while (client_->take_answer()) {
    }
  }
  EXPECT_EQ(ask({{"do", "hello"}, {"protocol", kProtocol}}).is_null(), false);
}

TEST_F(InspectTest, EndsWithTheSession) {
  open();
  const auto socket = endpoints(folder_.path())->front().socket;
  session_.reset();
  EXPECT_FALSE(std::filesystem::exists(socket));
}

TEST_F(InspectTest, FailsIfOthersMayEnterTheFolder) {
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
  const auto session = create();
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().message, HasSubstr("plugin inspect"));
}

TEST_F(InspectTest, ChangesNoImageAndNoStatisticsWithoutAClient) {
  const auto hash_of_flight = [&](bool inspect) {
    auto session = create();
    EXPECT_TRUE(session);
    std::vector<std::uint64_t> figures;
    if (inspect) client_ = std::move(*Client::attach(endpoints(folder_.path())->front().socket));
    core::CameraPose pose = (*session)->home();
    for (int frame = 0; frame < 20; ++frame) {
      pose.yaw += 0.05;
      if (inspect) client_->ask(R"({"do":"hello","protocol":"psygen.inspect/1"})");
      if (inspect) client_->ask(R"({"do":"entities"})");
      EXPECT_TRUE((*session)->tick(pose, 1.0 / 60));
      const telemetry::FrameRecord& record = (*session)->scene().record();
      figures.insert(figures.end(),
                     {record.triangles, record.cache_bytes, record.draws, record.requests_queued});
    }
    client_.reset();
    return figures;
  };
  EXPECT_EQ(hash_of_flight(false), hash_of_flight(true));  // also with a client that only reads
}

}  // namespace
}  // namespace psygen::inspect
