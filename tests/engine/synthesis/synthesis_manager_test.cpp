#include "engine/synthesis/synthesis_manager.hpp"

#include <gtest/gtest.h>
#ifdef __linux__
#include <sys/resource.h>
#endif

#include <algorithm>
#include <atomic>
#include <map>
#include <thread>

#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/engine/synthesis/fake_models.hpp"
#include "tests/faults.hpp"

namespace psygen::synthesis {
namespace {
using testing::FakeModel;
using testing::Gate;
using testing::key_of;
using testing::parameters_of;
using testing::registry_of;
using testing::ScriptedModel;

// Makes requests, each with a destination in its memory, without a cache.
class Jobs {
 public:
  explicit Jobs(const models::Registry& registry) : registry_(registry) {}
  Request make(std::uint32_t index, models::ModelIndex model = 0, std::int64_t vertices = 20) {
    const auto p = parameters_of(index, vertices);
    const auto level = static_cast<std::uint16_t>(index % 2);
    places_.push_back(*HeapDestination::make(registry_[model], p, level));
    Request r;
    r.handle = {index, 1};
    r.key = key_of(index, p, model, level);
    r.parameters = p;
    r.destination = places_.back().view();
    r.size = places_.back().size();
    r.owner = index;
    return r;
  }
  std::vector<Request> make_many(std::uint32_t first, std::uint32_t count) {
    std::vector<Request> requests;
    for (std::uint32_t i = 0; i < count; ++i)
      requests.push_back(make(first + i));
    return requests;
  }

 private:
  const models::Registry& registry_;
  std::vector<HeapDestination> places_;
};

SynthesisOptions with(unsigned modelers) {
  SynthesisOptions options;
  options.modelers = modelers;
  options.hash_content = true;
  options.watchdog_seconds = 0;
  return options;
}

std::vector<Completion> run(const models::Registry& registry, unsigned modelers,
                            std::vector<Request> plan) {
  SynthesisManager manager(registry, with(modelers));
  manager.publish(std::move(plan));
  EXPECT_TRUE(manager.wait_all());
  std::vector<Completion> done;
  manager.collect(done);
  return done;
}

std::uint64_t world_hash(const std::vector<Completion>& done) {
  WorldHash hash;
  for (const Completion& c : done)
    hash.add(c.content_hash);
  return hash.value();
}

TEST(SynthesisManager, OneToEightModelersAndAnyOrderMakeTheSameWorld) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  const std::vector<Request> plan = jobs.make_many(0, 200);
  WorldHash serial;
  for (const Request& r : plan) {
    ASSERT_TRUE(synthesise_guarded(registry[0], r.parameters, r.key.level, r.destination).ok);
    serial.add(content_hash(r.key, r.destination));
  }
  core::RandomStream random(3, 0, 0, 0, core::Purpose::kParameters);
  for (const unsigned modelers : {1u, 2u, 3u, 8u}) {
    std::vector<Request> shuffled = plan;
    for (std::size_t i = shuffled.size(); i > 1; --i)
      std::swap(shuffled[i - 1], shuffled[random.next_u64() % i]);
    const auto done = run(registry, modelers, shuffled);
    EXPECT_EQ(done.size(), 200u);
    EXPECT_EQ(world_hash(done), serial.value()) << modelers;
  }
}

TEST(SynthesisManager, AThreadThatWaitsCanMakeMeshes) {
  Gate gate;
  std::atomic<int> here{0}, elsewhere{0};
  const auto count = [&, self = std::this_thread::get_id()](const models::Parameters&, int) {
    ++(std::this_thread::get_id() == self ? here : elsewhere);
  };
  models::Registry registry = registry_of(std::make_unique<ScriptedModel>(
      "wild", [&gate](const models::Parameters&, int) { gate.wait(); }));
  ASSERT_TRUE(registry.add(std::make_unique<ScriptedModel>("tame", count)));
  Jobs jobs(registry);
  std::vector<Request> plan{jobs.make(0, 0)};
  for (std::uint32_t i = 1; i <= 50; ++i)
    plan.push_back(jobs.make(i, 1));
  SynthesisManager manager(registry, with(1));
  manager.publish(std::move(plan));
  gate.await(1);  // the only modeler is busy
  const auto go_on = [&] {
    gate.open();
    return true;
  };
  EXPECT_TRUE(manager.wait_all(go_on, true));
  EXPECT_EQ(here, 50);
  EXPECT_EQ(elsewhere, 0);
  EXPECT_EQ(manager.outstanding(), 0u);
  std::vector<Completion> done;
  EXPECT_EQ(manager.collect(done), 51u);
  EXPECT_TRUE(std::ranges::all_of(done, &Completion::ok));
}

TEST(SynthesisManager, AThreadThatWaitsMakesNoMeshThatMayHang) {
  std::atomic<int> here{0}, elsewhere{0};
  const auto count = [&, self = std::this_thread::get_id()](const models::Parameters&, int) {
    ++(std::this_thread::get_id() == self ? here : elsewhere);
  };
  const models::Registry registry = registry_of(std::make_unique<ScriptedModel>("wild", count));
  Jobs jobs(registry);
  SynthesisManager manager(registry, with(2));
  for (std::uint32_t round = 0; round < 20; ++round) {
    manager.publish(jobs.make_many(100 * round, 100));
    EXPECT_TRUE(manager.wait_all({}, true));
    EXPECT_EQ(manager.outstanding(), 0u);
    std::vector<Completion> done;
    EXPECT_EQ(manager.collect(done), 100u);
  }
  EXPECT_EQ(here, 0);
  EXPECT_EQ(elsewhere, 2000);
}

TEST(SynthesisManager, ContinuesWithTheModelersThatThreadsAllow) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  const FewThreads few(2);
  SynthesisManager manager(registry, with(8));
  EXPECT_EQ(manager.modeler_count(), 2u);
  EXPECT_NE(manager.shortage().find("no more threads"), std::string::npos) << manager.shortage();
  manager.publish(jobs.make_many(0, 50));
  EXPECT_TRUE(manager.wait_all());
  std::vector<Completion> done;
  EXPECT_EQ(manager.collect(done), 50u);
}

TEST(SynthesisManager, WithoutAnyThreadItSaysSoAndWaitsForNothing) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  const FewThreads few(0);
  SynthesisManager manager(registry, with(8));
  EXPECT_EQ(manager.modeler_count(), 0u);
  EXPECT_FALSE(manager.shortage().empty());
  manager.publish(jobs.make_many(0, 5));
  EXPECT_FALSE(manager.wait_all());
}

// Counts instead of timing: events that could make modelers wait for each other happen rarely, not
// once per request. Otherwise a modeler uses one fetch_add and queues that only it writes.
TEST(SynthesisManager, ModelersDoNotDelayEachOther) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  constexpr std::uint32_t kRequests = 4000, kPlans = 8;
  for (const unsigned modelers : {1u, 2u, 4u, 16u}) {
    SynthesisManager manager(registry, with(modelers));
    std::vector<Completion> done;
    for (std::uint32_t plan = 0; plan < kPlans; ++plan) {
      manager.publish(jobs.make_many(plan * kRequests / kPlans, kRequests / kPlans));
      EXPECT_TRUE(manager.wait_all());
    }
    manager.collect(done);
    ASSERT_EQ(done.size(), kRequests);
    std::uint64_t held_up = 0;
    for (const ModelerStats& m : manager.stats().modelers)
      held_up += m.locks + m.retries;
    // A modeler runs out of work once per plan, and may see each plan begin and end.
    EXPECT_LE(held_up, (3 * kPlans + 1) * modelers) << modelers;
    if (modelers == 2) {
      EXPECT_LE(static_cast<double>(held_up), 0.02 * kRequests);
    }
  }
}

TEST(SynthesisManager, ACompletionHoldsItsRequestAndItsDuration) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  Request request = jobs.make(42);
  request.work = {7, 8, 9};
  request.cost.seconds = {0.25, 0.375, 0.5};
  const auto done = run(registry, 1, {request});
  ASSERT_EQ(done.size(), 1u);
  const Completion& c = done[0];
  EXPECT_TRUE(c.ok);
  EXPECT_EQ(c.handle, request.handle);
  EXPECT_EQ(c.key, request.key);
  EXPECT_EQ(c.owner, 42u);
  EXPECT_EQ(c.work, (Work{7, 8, 9}));
  EXPECT_EQ(c.predicted_seconds, 0.5);
  EXPECT_GE(c.seconds, 0);
  EXPECT_LE(c.started_s, c.finished_s);
  EXPECT_EQ(c.tight.max, glm::vec3(0.5F));
  EXPECT_EQ(c.content_hash, content_hash(request.key, request.destination));
}

TEST(SynthesisManager, ACompletionHoldsTheWarmthOfTheCaches) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  double now_s = 1;
  SynthesisOptions options = with(1);
  options.clock = [&now_s] { return now_s; };
  SynthesisManager manager(registry, options);
  std::vector<Completion> done;
  for (const std::vector<std::size_t>& codes : {std::vector<std::size_t>{0, 0, 1, 0}, {1}, {0}}) {
    std::vector<Request> plan;
    for (const std::size_t code : codes) {
      plan.push_back(jobs.make(static_cast<std::uint32_t>(done.size() + plan.size())));
      plan.back().cost.code = code;
    }
    manager.publish(std::move(plan));
    ASSERT_TRUE(manager.wait_all());
    manager.collect(done);
    if (done.size() == 5) now_s += 1e-3;  // the modeler is idle for a millisecond
  }
  std::vector<Warmth> warmths;
  for (const Completion& c : done)
    warmths.push_back(c.warmth);
  using enum Warmth;
  EXPECT_EQ(warmths, (std::vector{kAfterSleep, kWarm, kCold, kWarm, kWarm, kAfterSleep}));
}

TEST(SynthesisManager, OnAVirtualClockPredictionsAloneDetermineTheSchedule) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  double now_s = 100;
  SynthesisOptions options = with(2);
  options.virtual_clock = [&now_s] { return now_s; };
  SynthesisManager manager(registry, options);
  EXPECT_EQ(manager.modeler_count(), 1u) << "for any number of threads";
  Jobs jobs(registry);
  std::vector<Request> plan = jobs.make_many(0, 6);
  const std::array<double, 6> seconds{3, 1, 1, 5, 1, 1};
  for (std::size_t i = 0; i < plan.size(); ++i)
    plan[i].cost.seconds.fill(seconds[i]);
  const auto owners_at = [&](double at_s) {
    now_s = at_s;
    std::vector<Completion> done;
    manager.collect(done);
    std::vector<std::uint64_t> owners;
    for (const Completion& c : done) {
      EXPECT_TRUE(c.ok);
      EXPECT_NE(c.content_hash, 0u);
      EXPECT_EQ(c.seconds, c.predicted_seconds);
      owners.push_back(c.owner);
    }
    return owners;
  };
  using Owners = std::vector<std::uint64_t>;
  manager.publish(std::move(plan));
  EXPECT_EQ(owners_at(100.5), Owners{});
  EXPECT_EQ(owners_at(104), (Owners{0, 1}));
  EXPECT_EQ(manager.outstanding(), 4u);
  now_s = 105.5;
  const std::vector<Request> unclaimed = manager.reclaim();
  ASSERT_EQ(unclaimed.size(), 2u);
  EXPECT_EQ(unclaimed[0].owner, 4u);
  Request here = jobs.make(9);
  here.cost.seconds.fill(0.25);
  manager.execute_here(here);
  EXPECT_EQ(owners_at(105.5), (Owners{2, 9})) << "at once";
  EXPECT_EQ(owners_at(109), Owners{});
  EXPECT_TRUE(manager.wait_all());
  EXPECT_EQ(owners_at(109), (Owners{3})) << "a waiting caller gets everything";
}

TEST(SynthesisManager, OnAVirtualClockWithoutThreadsClaimedRequestsFail) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  const FewThreads few(0);
  SynthesisOptions options = with(2);
  options.virtual_clock = [] { return 1.0; };
  SynthesisManager manager(registry, options);
  manager.publish(jobs.make_many(0, 3));
  EXPECT_FALSE(manager.wait_all());
  std::vector<Completion> done;
  ASSERT_EQ(manager.collect(done), 3u);
  for (const Completion& c : done) {
    EXPECT_FALSE(c.ok);
    EXPECT_EQ(c.error, "no modeler is left");
  }
  EXPECT_EQ(manager.outstanding(), 0u);
}

TEST(SynthesisManager, RequestsAreClaimedInTheOrderOfThePlan) {
  std::vector<std::int64_t> order;  // one modeler: no race
  const models::Registry registry = registry_of(std::make_unique<ScriptedModel>(
      "order", [&](const models::Parameters& p, int) { order.push_back(p.integer(0)); }));
  Jobs jobs(registry);
  run(registry, 1, {jobs.make(5), jobs.make(3), jobs.make(9)});
  EXPECT_EQ(order, (std::vector<std::int64_t>{5, 3, 9}));
}

TEST(SynthesisManager, WaitingAsksTheCallerWhetherToContinue) {
  Gate gate;
  const models::Registry registry = registry_of(std::make_unique<ScriptedModel>(
      "gated", [&](const models::Parameters&, int) { gate.wait(); }));
  Jobs jobs(registry);
  SynthesisManager manager(registry, with(1));
  manager.publish(jobs.make_many(0, 2));
  int asked = 0;
  EXPECT_FALSE(manager.wait_all([&] { return ++asked < 3; }));
  EXPECT_EQ(asked, 3);
  EXPECT_TRUE(manager.wait_all([&] {
    if (++asked == 6) gate.open();
    return true;
  }));
  EXPECT_GE(asked, 6);
}

#ifdef __linux__
TEST(SynthesisManager, ModelersLowerTheirPriorityOnRequest) {
  std::vector<int> nice;  // of the modeler, in each request
  const models::Registry registry =
      registry_of(std::make_unique<ScriptedModel>("nice", [&](const models::Parameters&, int) {
        nice.push_back(getpriority(PRIO_PROCESS, 0));
      }));
  Jobs jobs(registry);
  SynthesisManager manager(registry, with(1));
  manager.publish(jobs.make_many(0, 1));
  EXPECT_TRUE(manager.wait_all());
  manager.lower_priority();
  manager.publish(jobs.make_many(1, 2));
  EXPECT_TRUE(manager.wait_all());
  const int mine = getpriority(PRIO_PROCESS, 0);
  EXPECT_EQ(nice, (std::vector<int>{mine, 19, 19}));
}
#endif

TEST(SynthesisManager, UnderConstantReplanningEveryRequestIsDoneOnceOrReclaimedOnce) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  constexpr std::uint32_t kCount = 1000;
  std::vector<Request> pending = jobs.make_many(0, kCount);
  std::map<std::uint64_t, int> seen;
  std::vector<Completion> done;
  SynthesisManager manager(registry, with(3));
  core::RandomStream random(5, 0, 0, 0, core::Purpose::kParameters);
  while (done.size() < kCount) {
    // Plans all or some requests, sometimes twice without reclaiming in between.
    const auto some =
        static_cast<std::size_t>(random.next_integer(0, static_cast<std::int64_t>(pending.size())));
    std::vector<Request> plan(pending.end() - static_cast<std::ptrdiff_t>(some), pending.end());
    pending.resize(pending.size() - some);
    manager.publish(std::move(plan));
    if (random.next_integer(0, 2) > 0) {
      const std::vector<Request> back = manager.reclaim();
      pending.insert(pending.end(), back.begin(), back.end());
    }
    manager.collect(done);
    std::this_thread::yield();
  }
  const std::vector<Request> rest = manager.reclaim();
  EXPECT_TRUE(rest.empty());
  manager.collect(done);
  for (const Completion& c : done) {
    EXPECT_TRUE(c.ok);
    ++seen[c.owner];
  }
  EXPECT_EQ(done.size(), kCount);
  EXPECT_EQ(seen.size(), kCount);
  const SynthesisStats stats = manager.stats();
  EXPECT_EQ(stats.models, kCount);
  EXPECT_EQ(stats.published, stats.reclaimed + kCount);
}

TEST(SynthesisManager, ReclaimReturnsUnclaimedRequestsInOrderAndKeepsRunningOnes) {
  Gate gate;
  const models::Registry registry = registry_of(std::make_unique<ScriptedModel>(
      "gated", [&](const models::Parameters&, int) { gate.wait(); }));
  Jobs jobs(registry);
  SynthesisManager manager(registry, with(1));
  manager.publish(jobs.make_many(0, 4));
  gate.await(1);
  const std::vector<Request> back = manager.reclaim();
  ASSERT_EQ(back.size(), 3u);
  for (std::uint32_t i = 0; i < 3; ++i)
    EXPECT_EQ(back[i].owner, i + 1);
  EXPECT_TRUE(manager.reclaim().empty());
  EXPECT_EQ(manager.outstanding(), 1u);
  gate.open();
  EXPECT_TRUE(manager.wait_all());
  std::vector<Completion> done;
  EXPECT_EQ(manager.collect(done), 1u);
  EXPECT_EQ(done[0].owner, 0u);
}

TEST(SynthesisManager, APlanPublishedOverAnotherLosesNothing) {
  Gate gate;
  const models::Registry registry = registry_of(std::make_unique<ScriptedModel>(
      "gated", [&](const models::Parameters&, int) { gate.wait(); }));
  Jobs jobs(registry);
  SynthesisManager manager(registry, with(1));
  manager.publish(jobs.make_many(0, 3));
  gate.await(1);
  manager.publish(jobs.make_many(10, 2));
  const std::vector<Request> back = manager.reclaim();
  EXPECT_EQ(back.size(), 4u);  // two of the first plan, two of the second
  gate.open();
}

TEST(SynthesisManager, AModelThatThrowsFailsAloneAndItsModelerContinues) {
  models::Registry registry;
  ASSERT_TRUE(registry.add(std::make_unique<ScriptedModel>("moody", [](const auto& p, int) {
    if (p.integer(0) % 3 == 0) throw std::runtime_error("not today");
    if (p.integer(0) % 3 == 1) throw 42;
  })));
  ASSERT_TRUE(registry.add(std::make_unique<testing::LyingModel>()));
  Jobs jobs(registry);
  std::vector<Request> plan = jobs.make_many(0, 9);
  plan.push_back(jobs.make(9, 1));
  const auto done = run(registry, 2, plan);
  ASSERT_EQ(done.size(), 10u);
  for (const Completion& c : done) {
    EXPECT_EQ(c.ok, c.owner < 9 && c.owner % 3 == 2) << c.owner;
    if (c.owner == 0) {
      EXPECT_EQ(c.error, "moody level 0 threw: not today");
    }
    if (c.owner == 1) {
      EXPECT_EQ(c.error, "moody level 1 threw an object that is not a std::exception");
    }
    if (c.owner == 9) {
      EXPECT_EQ(c.error, "lying level 1 returned invalid bounds");
    }
  }
}

// Hangs on requests with an even seed until the gate opens; the test advances the time.
class HangingTest : public ::testing::Test {
 protected:
  SynthesisOptions options(unsigned modelers) {
    SynthesisOptions o;
    o.modelers = modelers;
    o.watchdog_seconds = 10;
    o.clock = [this] { return now.load(); };
    return o;
  }
  std::atomic<double> now{100};
  Gate gate;
  models::Registry registry =
      registry_of(std::make_unique<ScriptedModel>("hanging", [this](const auto& p, int) {
        if (p.integer(0) % 2 == 0) gate.wait();
      }));
  Jobs jobs{registry};
  std::vector<Completion> done;
};

TEST_F(HangingTest, TheWatchdogAbandonsAHungRequestAndTheOthersGetANewModeler) {
  SynthesisManager manager(registry, options(1));
  manager.publish({jobs.make(0), jobs.make(1), jobs.make(3)});
  gate.await(1);
  now = 109;
  EXPECT_EQ(manager.collect(done), 0u);
  EXPECT_TRUE(manager.hung().empty());
  now = 111;
  EXPECT_TRUE(manager.wait_all());  // 1 and 3 need the new modeler
  manager.collect(done);
  ASSERT_EQ(done.size(), 3u);
  EXPECT_FALSE(done[0].ok);
  EXPECT_TRUE(done[0].abandoned);
  EXPECT_EQ(done[0].owner, 0u);
  EXPECT_EQ(done[0].error, "hanging level 0 was abandoned after 11.0 s");
  EXPECT_TRUE(done[1].ok && done[2].ok);
  ASSERT_EQ(manager.hung().size(), 1u);
  EXPECT_EQ(manager.hung()[0].owner, 0u);
  EXPECT_EQ(manager.modeler_count(), 1u);

  gate.open();
  done.clear();
  while (manager.collect(done) == 0)
    std::this_thread::yield();
  ASSERT_EQ(done.size(), 1u);
  EXPECT_TRUE(done[0].late);
  EXPECT_FALSE(done[0].ok);
  EXPECT_EQ(done[0].owner, 0u);
  while (!manager.hung().empty())
    manager.collect(done);
  EXPECT_EQ(manager.stats().given_up, 1u);
  EXPECT_EQ(manager.stats().models, 2u);
}

TEST_F(HangingTest, WithoutAReplacementForAHungThreadTheOthersContinue) {
  SynthesisManager manager(registry, options(2));
  const FewThreads few(0);
  manager.publish({jobs.make(0), jobs.make(1), jobs.make(3)});
  gate.await(1);
  now = 111;
  EXPECT_TRUE(manager.wait_all());
  EXPECT_EQ(manager.modeler_count(), 1u);
  manager.collect(done);
  EXPECT_EQ(done.size(), 3u);
  gate.open();
  while (!manager.hung().empty())  // its thread waits at the gate, which ends with this test
    manager.collect(done);
}

TEST_F(HangingTest, WhenEveryModelerHangsAndNoneIsLeftWaitingEnds) {
  SynthesisOptions o = options(2);
  o.max_replacements = 0;
  SynthesisManager manager(registry, o);
  manager.publish({jobs.make(0), jobs.make(2), jobs.make(4)});
  gate.await(2);
  now = 200;
  manager.collect(done);
  EXPECT_EQ(done.size(), 2u);
  EXPECT_EQ(manager.modeler_count(), 0u);
  EXPECT_FALSE(manager.wait_all());
  EXPECT_EQ(manager.reclaim().size(), 1u);
  gate.open();
  while (!manager.hung().empty())
    manager.collect(done);
}

TEST(SynthesisManager, TheDestructorDoesNotWaitForAModelThatHangs) {
  // The objects of the hung model live until the process ends, as the manager requires.
  struct Forever {
    std::atomic<double> now{100};
    Gate gate;  // never opened
    models::Registry registry = registry_of(
        std::make_unique<ScriptedModel>("stuck", [this](const auto&, int) { gate.wait(); }));
    Jobs jobs{registry};
  };
  static auto* const kept = new std::vector<Forever*>;  // one per repetition of this test
  Forever* const forever = kept->emplace_back(new Forever);
  SynthesisOptions options = with(1);
  options.watchdog_seconds = 10;
  options.clock = [forever] { return forever->now.load(); };
  {
    SynthesisManager manager(forever->registry, options);
    manager.publish({forever->jobs.make(0)});
    forever->gate.await(1);
    forever->now = 200;
  }
  SUCCEED() << "the destructor returned";
}

TEST(SynthesisManager, IdleManagersAndDroppedPlansEndCleanly) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  { SynthesisManager idle(registry, with(4)); }
  {
    SynthesisManager busy(registry, with(4));
    busy.publish(jobs.make_many(0, 500));
  }
  SynthesisManager empty(registry, with(2));
  empty.publish({});
  EXPECT_TRUE(empty.wait_all());
  EXPECT_TRUE(empty.reclaim().empty());
}

TEST(SynthesisManager, StatisticsAddUpOverTheModelers) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  Jobs jobs(registry);
  SynthesisManager manager(registry, with(2));
  std::vector<Request> plan;
  for (std::uint32_t i = 0; i < 50; ++i)
    plan.push_back(jobs.make(2 * i));  // level 0: 20 vertices, 20 triangles
  manager.publish(std::move(plan));
  EXPECT_TRUE(manager.wait_all());
  const SynthesisStats stats = manager.stats();
  EXPECT_EQ(stats.models, 50u);
  EXPECT_EQ(stats.triangles, 50u * 20);
  EXPECT_EQ(stats.bytes, 50u * (20 * 16 + 60 * 2));
  ASSERT_EQ(stats.modelers.size(), 2u);
  EXPECT_EQ(stats.modelers[0].models + stats.modelers[1].models, 50u);
  EXPECT_GE(modeler_count_for(0), 1u);
  EXPECT_EQ(modeler_count_for(5), 5u);
}

TEST(CompletionQueue, DeliversEverythingInOrderAcrossSegments) {
  CompletionQueue queue;
  constexpr std::uint64_t kCount = 10'000;
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kCount; ++i) {
      Completion c;
      c.owner = i;
      c.error = "number " + std::to_string(i);
      queue.push(std::move(c));
    }
  });
  std::vector<Completion> out;
  while (out.size() < kCount)
    queue.drain(out);
  producer.join();
  for (std::uint64_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(out[i].owner, i);
    ASSERT_EQ(out[i].error, "number " + std::to_string(i));
  }
  EXPECT_EQ(queue.drain(out), 0u);
}

}  // namespace
}  // namespace psygen::synthesis
