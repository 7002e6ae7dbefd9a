// Systems, their declared accesses, and equal results on any number of threads.
#include "ecs/schedule.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>

#include "ecs/snapshot.hpp"
#include "tests/ecs/described.hpp"
#include "tests/faults.hpp"

namespace psygen::ecs::test {
namespace {

struct Wind {
  float strength = 2;
};
struct Tally {
  std::size_t seen = 0;
};

const SystemInfo& info(const Schedule& schedule, std::string_view name) {
  for (const SystemInfo& system : schedule.systems()) {
    if (system.name == name) return system;
  }
  ADD_FAILURE() << "no system " << name;
  return schedule.systems()[0];
}

bool declares(const SystemInfo& system, std::string_view name, bool writes) {
  return std::ranges::any_of(system.accesses,
                             [&](const Access& a) { return a.name == name && a.writes == writes; });
}

TEST(Schedule, DerivesAccessesFromTheParametersOfASystem) {
  World world;
  Wind wind;
  Tally tally;
  auto reader = world.reader<Mesh>();
  Schedule schedule(world);
  schedule.provide(wind, tally, reader);
  schedule.add("blow", [](const Wind&, Query<Velocity, const Position>) {});
  schedule.add("count", [](Tally&, ChangeReader<Mesh>&) {});
  schedule.add("spawn", [](Commands&) {});
  schedule.add("look", [](const World&) {});
  schedule.add(
      "change", [](World&) {}, RunsOn::kCallingThread);
  const SystemInfo& blow = info(schedule, "blow");
  EXPECT_EQ(blow.accesses.size(), 3U);
  EXPECT_TRUE(declares(blow, "Wind", false));
  EXPECT_TRUE(declares(blow, "Velocity", true));
  EXPECT_TRUE(declares(blow, "Position", false));
  EXPECT_TRUE(declares(info(schedule, "count"), "Tally", true));
  EXPECT_TRUE(declares(info(schedule, "count"), "mesh", false));
  EXPECT_TRUE(info(schedule, "spawn").records_commands);
  EXPECT_EQ(info(schedule, "look").world, WorldAccess::kReads);
  EXPECT_EQ(info(schedule, "change").world, WorldAccess::kWrites);
  EXPECT_EQ(info(schedule, "change").runs_on, RunsOn::kCallingThread);
}

TEST(Schedule, TwoSystemsConflictWhenOneWritesWhatTheOtherTouches) {
  World world;
  Wind wind;
  Tally tally;
  Schedule s(world);
  s.provide(wind, tally);
  s.add("reads", [](Query<const Position>) {});
  s.add("reads too", [](Query<const Position, const Mesh>, const Wind&) {});
  s.add("writes", [](Query<Position>) {});
  s.add("elsewhere", [](Query<Velocity>) {});
  s.add("resource", [](Wind&) {});
  s.add("all", [](const World&) {});
  s.add("alone", [](World&) {});
  const auto conflicts = [&](std::string_view a, std::string_view b) {
    EXPECT_EQ(conflict(info(s, a), info(s, b)), conflict(info(s, b), info(s, a)));
    return conflict(info(s, a), info(s, b));
  };
  EXPECT_FALSE(conflicts("reads", "reads too"));
  EXPECT_TRUE(conflicts("reads", "writes"));
  EXPECT_FALSE(conflicts("writes", "elsewhere"));
  EXPECT_TRUE(conflicts("resource", "reads too"));
  EXPECT_FALSE(conflicts("resource", "all"));
  EXPECT_TRUE(conflicts("writes", "all"));
  EXPECT_FALSE(conflicts("reads", "all"));
  EXPECT_TRUE(conflicts("reads", "alone"));
  EXPECT_TRUE(conflicts("all", "alone"));
  EXPECT_FALSE(conflicts("resource", "alone"));
}

TEST(Schedule, SystemsRunInOrderAndHaveTimes) {
  World world;
  std::vector<int> order;
  Schedule schedule(world);
  schedule.provide(order);
  schedule.add("first", [](std::vector<int>& o) { o.push_back(1); });
  schedule.add("second", [](std::vector<int>& o) { o.push_back(2); });
  schedule.run();
  schedule.run();
  EXPECT_EQ(order, (std::vector<int>{1, 2, 1, 2}));
  for (const SystemInfo& system : schedule.systems())
    EXPECT_GT(system.last_seconds, 0.0);
}

TEST(Schedule, CommandsAreAppliedBeforeTheNextSystem) {
  for (const std::size_t threads : {1U, 4U}) {
    World world;
    Tally tally;
    Schedule schedule(world, threads);
    schedule.provide(tally);
    schedule.add("spawn", [](Commands& commands) {
      commands.create(Position{1, 2, 3});
      commands.create(Position{});
    });
    schedule.add("count", [](Tally& t, Query<const Position> positions) {
      positions.each([&](auto entities, auto) { t.seen += entities.size(); });
    });
    schedule.run();
    schedule.run();
    EXPECT_EQ(tally.seen, 2U + 4U);
  }
}

TEST(Schedule, SystemsWithoutConflictRunAtTheSameTime) {
  World world;
  world.create<Position, Velocity>(1);
  std::atomic<int> inside = 0;
  Schedule schedule(world, 2);
  // Each waits for the other, so only together they end.
  const auto meet = [&inside] {
    ++inside;
    while (inside.load() < 2)
      std::this_thread::yield();
  };
  schedule.add("a", [=](Query<Position>) { meet(); });
  schedule.add("b", [=](Query<Velocity>) { meet(); });
  schedule.run();
  EXPECT_EQ(inside.load(), 2);
}

TEST(Schedule, SystemsOfTheCallingThreadRunThere) {
  World world;
  std::set<std::thread::id> ids;
  Schedule schedule(world, 3);
  schedule.provide(ids);
  for (int i = 0; i < 20; ++i) {
    schedule.add("elsewhere " + std::to_string(i), [](Query<Velocity>) {});
    schedule.add(
        "window " + std::to_string(i),
        [](std::set<std::thread::id>& s) { s.insert(std::this_thread::get_id()); },
        RunsOn::kCallingThread);
  }
  for (int i = 0; i < 20; ++i)
    schedule.run();
  EXPECT_EQ(ids, std::set{std::this_thread::get_id()});
}

// A small simulation with every kind of access, in which every order matters.
void simulate(World& world, std::size_t threads) {
  auto meshes = world.reader<Mesh>(Removed::kReport);
  Wind wind;
  Tally tally;
  Schedule schedule(world, threads);
  schedule.provide(meshes, wind, tally);
  schedule.add("blow", [](const Wind& w, Query<Creature, const Mesh> query) {
    query.each([&](auto, std::span<Creature> creatures, std::span<const Mesh> m) {
      for (std::size_t i = 0; i < creatures.size(); ++i)
        creatures[i].age_s = creatures[i].age_s * 0.5 + static_cast<double>(m[i].id) * w.strength;
    });
  });
  schedule.add("spin", [](Query<Edited> query) {
    query.each([](auto, std::span<Edited> edited) {
      for (Edited& e : edited)
        e.version = e.version * 1664525 + 1013904223;
    });
  });
  schedule.add("age", [](Query<Mesh> query) {
    query.each([](TableRows<Mesh> rows, auto, std::span<Mesh> m) {
      for (std::size_t i = 0; i < m.size(); ++i)
        m[i].id = m[i].id * 3 + i;
      rows.mark_changed<Mesh>(0, m.size());
    });
  });
  schedule.add("gust", [](Wind& w) { w.strength = w.strength * 1.01F + 0.5F; });
  schedule.add("cull", [](Query<const Creature> query, Commands& commands) {
    query.each([&](std::span<const Entity> entities, std::span<const Creature> creatures) {
      for (std::size_t i = 0; i < entities.size(); ++i) {
        if (creatures[i].age_s > 1e6) commands.destroy(entities[i]);
      }
    });
  });
  schedule.add("spawn", [](const Tally& t, Commands& commands) {
    for (std::size_t i = 0; i < 3 + t.seen % 5; ++i) {
      Creature creature;
      creature.name = std::to_string(t.seen);
      creature.age_s = static_cast<double>(i);
      commands.create(std::move(creature), Mesh{i + 1});
    }
  });
  schedule.add("drain", [](ChangeReader<Mesh>& reader, Tally& t) {
    t.seen += reader.drain([](auto, auto) {});
    t.seen += reader.drain_removed([](auto) {});
  });
  schedule.add("edit", [](World& w) {
    std::vector<Entity> all;
    w.each<const Creature>([&](std::span<const Entity> entities, auto) {
      all.insert(all.end(), entities.begin(), entities.end());
    });
    w.remove<Edited>(std::span(all).first(all.size() / 3));
    w.add<Edited>(std::span(all).last(all.size() / 2));
  });
  for (int tick = 0; tick < 60; ++tick)
    schedule.run();
  EXPECT_GT(tally.seen, 100U);
}

TEST(Schedule, AnyNumberOfThreadsGivesTheSameState) {
  World serial;
  simulate(serial, 1);
  EXPECT_GT(serial.size(), 10U);
  for (const std::size_t threads : {2U, 3U, 8U}) {
    World parallel;
    simulate(parallel, threads);
    EXPECT_EQ(state_hash(parallel), state_hash(serial)) << threads;
  }
}

TEST(Schedule, RunsOnFewerThreadsIfSomeCannotBeStarted) {
  World serial;
  simulate(serial, 1);
  for (const std::size_t left : {0U, 1U, 2U}) {
    const FewThreads few(left);
    World parallel;
    EXPECT_EQ(Schedule(parallel, 8).threads(), left + 1);
    const FewThreads as_few(left);
    simulate(parallel, 8);
    EXPECT_EQ(state_hash(parallel), state_hash(serial)) << left;
  }
}

TEST(Schedule, AMissingResourceIsNamedWhenSystemsAreArranged) {
  const auto refused = [](auto system) {
    World world;
    Schedule schedule(world);
    schedule.add("blow", system);
    schedule.add("next", [](const World&) {});
    EXPECT_DEATH(schedule.run(), "schedule: the system 'blow' wants a");
    return schedule.arrange();
  };
  EXPECT_EQ(refused([](const Wind&) {}),
            "the system 'blow' wants a Wind, which was not provided before it");
  EXPECT_EQ(refused([](EventReader<Wind>&) {}),
            "the system 'blow' wants a Wind, which was not provided before it");
  EXPECT_EQ(refused([](ChangeReader<Mesh>&) {}).find("the system 'blow' wants a ChangeReader"), 0U);
}

TEST(Schedule, ASecondResourceOfATypeIsRejected) {
  World world;
  Wind wind;
  Schedule schedule(world);
  schedule.provide(wind);
  schedule.emplace<Wind>();
  schedule.add("calm", [](Tally&) {});
  EXPECT_EQ(schedule.arrange(), "a second Wind is provided") << "the first mistake";
}

TEST(Query, FollowsHandlesAndWritesOnlyItsOwnComponents) {
  World world;
  const std::vector<Landing<Mesh>> results{{world.create<Mesh, Position>(1).entities[0], {8}}};
  const Query<Mesh, const Position> query(world);
  EXPECT_EQ(query.land<Mesh>(results).landed, 1U);
  EXPECT_EQ(query.get<Mesh>(results[0].entity)->id, 8U);
  EXPECT_EQ(query.accessor<const Mesh>().get(results[0].entity)->id, 8U);
  static_assert(std::is_same_v<decltype(query.get<Position>({})), const Position*>);
  std::size_t rows = 0;
  query.each<const Position>([&](auto entities, auto) { rows += entities.size(); });
  EXPECT_EQ(rows, 1U);
}

void quiet(Wind&) noexcept {}

TEST(Schedule, TakesNoexceptFunctionsAndMoveOnlyLambdas) {
  World world;
  Wind wind;
  Schedule schedule(world);
  schedule.provide(wind);
  schedule.add("quiet", quiet);
  schedule.add("owner",
               [owned = std::make_unique<float>(5.0F)](Wind& w) noexcept { w.strength = *owned; });
  schedule.run();
  EXPECT_EQ(wind.strength, 5.0F);
}

TEST(Schedule, ASystemMayNameItsCommandsTwice) {
  World world;
  Schedule schedule(world);
  schedule.add("both", [](Commands& a, Commands& b) {
    a.create(Position{});
    b.create(Position{});
  });
  schedule.run();
  EXPECT_EQ(world.size(), 2U);
}

struct Uploads;
struct Sounds;

TEST(Schedule, TagsDistinguishReadersOfOneComponent) {
  World world;
  auto uploads = world.reader<Mesh, Uploads>();
  auto sounds = world.reader<Mesh, Sounds>();
  Tally tally;
  Schedule schedule(world, 2);
  schedule.provide(uploads, sounds, tally);
  schedule.add("upload", [](ChangeReader<Mesh, Uploads>& r, Tally& t) {
    t.seen += r.drain([](auto, auto) {});
  });
  schedule.add("sound", [](ChangeReader<Mesh, Sounds>& r, Tally& t) {
    t.seen += r.drain([](auto, auto) {});
  });
  schedule.add("write", [](Query<Mesh>) {});
  EXPECT_TRUE(conflict(info(schedule, "upload"), info(schedule, "write")));
  world.create<Mesh>(10);
  schedule.run();
  EXPECT_EQ(tally.seen, 20U);
}

TEST(ScheduleDeathTest, AddingAndRunningInsideASystemEndsWithAMessage) {
  World world;
  Schedule schedule(world);
  schedule.provide(schedule);
  schedule.add("grow", [](Schedule& s) { s.add("more", [](World&) {}); });
  EXPECT_DEATH(schedule.run(), "add from inside a system");
  Schedule again(world);
  again.provide(again);
  again.add("again", [](Schedule& s) { s.run(); });
  EXPECT_DEATH(again.run(), "run from inside a system");
}

TEST(Schedule, ASystemRunsBeforeOrAfterTheSystemsThatItNames) {
  for (const std::size_t threads : {1U, 4U}) {
    World world;
    std::vector<int> order;
    Schedule schedule(world, threads);
    schedule.provide(order);
    schedule.add(
        "last", [](std::vector<int>& o) { o.push_back(4); }, after("second"));
    schedule.add("first", [](std::vector<int>& o) { o.push_back(1); });
    schedule.add("second", [](std::vector<int>& o) { o.push_back(3); });
    schedule.add(
        "between", [](std::vector<int>& o) { o.push_back(2); }, before("second"));
    EXPECT_EQ(schedule.arrange(), "");
    EXPECT_EQ(schedule.systems()[1].name, "between");
    schedule.run();
    EXPECT_EQ(order, (std::vector<int>{1, 2, 3, 4}));
    schedule.add(
        "zeroth", [](std::vector<int>& o) { o.push_back(0); }, before("first"));
    order.clear();
    schedule.run();
    EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
  }
}

TEST(Schedule, AnImpossibleOrderIsReportedAndChangesNothing) {
  World world;
  Schedule schedule(world);
  schedule.add("a", [](World&) {});
  schedule.add(
      "b", [](World&) {}, Place{.before = {"a"}, .after = {"a"}});
  EXPECT_EQ(schedule.arrange(), "systems wait for each other: 'a' after 'b' after 'a'");
  EXPECT_EQ(schedule.systems()[0].name, "a");
  EXPECT_DEATH(schedule.run(), "schedule: systems wait for each other");
}

TEST(Schedule, EventsOfOneRunReachSystemsOfThisRunOrTheNext) {
  struct Fall {
    int height_m;
  };
  for (const std::size_t threads : {1U, 4U}) {
    World world;
    Schedule schedule(world, threads);
    std::vector<int>& seen = schedule.emplace<std::vector<int>>();
    schedule.emplace<EventQueue<Fall>>();
    const auto note = [](std::vector<int>& heights, EventReader<Fall>& falls) {
      falls.drain([&](std::span<const Fall> events) {
        for (const Fall& fall : events)
          heights.push_back(fall.height_m);
      });
    };
    schedule.add("before", note);
    schedule.add("fall", [](EventQueue<Fall>& falls) {
      falls.emit(Fall{1});
      falls.emit(Fall{2});
    });
    schedule.add("after", note);
    EXPECT_TRUE(declares(info(schedule, "fall"), "Fall", true));
    schedule.run();
    EXPECT_EQ(seen, (std::vector<int>{1, 2}));
    schedule.run();
    EXPECT_EQ(seen, (std::vector<int>{1, 2, 1, 2, 1, 2}));
  }
}

TEST(Schedule, OwnsEmplacedResourcesLongerThanItsSystems) {
  const auto alive = std::make_shared<int>(1);
  struct Holder {
    std::shared_ptr<int> value;
  };
  World world;
  {
    Schedule schedule(world);
    EXPECT_EQ(schedule.emplace<Holder>(alive).value.use_count(), 2);
  }
  EXPECT_EQ(alive.use_count(), 1);
}

TEST(Schedule, AnExceptionOfASystemEndsTheRunAndNamesIt) {
  for (const std::size_t threads : {1U, 4U}) {
    World world;
    Tally tally;
    bool fail = true;
    Schedule schedule(world, threads);
    schedule.provide(tally, fail);
    schedule.add("broken", [](const bool& f, Tally&, Commands& commands) {
      commands.create(Position{});
      if (f) throw std::runtime_error("no more wolves");
    });
    schedule.add("count", [](Tally& t) { ++t.seen; });
    try {
      schedule.run();
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "no more wolves");
    }
    EXPECT_EQ(schedule.threw(), "broken");
    EXPECT_EQ(tally.seen, 0U);
    EXPECT_EQ(world.size(), 0U);
    fail = false;
    schedule.run();  // as if nothing had happened
    EXPECT_EQ(schedule.threw(), "");
    EXPECT_EQ(tally.seen, 1U);
    EXPECT_EQ(world.size(), 1U);
  }
}

// Bundles: what several systems take together.
struct Weather {
  const Wind& wind;
};
struct WeatherWork {
  Weather weather;
  Tally& tally;
  EventQueue<int>& gusts;
};

TEST(ScheduleBundles, ABundleStandsForTheAccessesOfItsMembers) {
  World world;
  Wind wind;
  Tally tally;
  Schedule schedule(world);
  schedule.provide(wind, tally);
  schedule.emplace<EventQueue<int>>();
  schedule.add("work", [](WeatherWork work, Query<const Position>) {
    work.tally.seen += static_cast<std::size_t>(work.weather.wind.strength);
    work.gusts.emit(7);
  });
  schedule.add("look", [](Weather) {});
  const SystemInfo& work = info(schedule, "work");
  ASSERT_EQ(work.accesses.size(), 4U);
  EXPECT_TRUE(declares(work, "Wind", false));
  EXPECT_TRUE(declares(work, "Tally", true));
  EXPECT_TRUE(declares(work, "int", true));
  EXPECT_EQ(work.accesses[0].name, "Wind");
  EXPECT_EQ(work.accesses[0].bundle, "WeatherWork");  // not Weather, which is inside it
  EXPECT_EQ(work.accesses[3].bundle, "");
  EXPECT_EQ(info(schedule, "look").accesses[0].bundle, "Weather");
  schedule.run();
  EXPECT_EQ(tally.seen, 2U);
}

TEST(ScheduleBundles, SystemsConflictThroughTheMembersOfTheirBundles) {
  World world;
  Wind wind;
  Tally tally;
  Schedule s(world);
  s.provide(wind, tally);
  s.emplace<EventQueue<int>>();
  s.add("reads", [](Weather) {});
  s.add("reads too", [](const Wind&) {});
  s.add("writes", [](Wind&) {});
  s.add("works", [](WeatherWork) {});
  s.add("counts", [](const Tally&) {});
  EXPECT_FALSE(conflict(info(s, "reads"), info(s, "reads too")));
  EXPECT_FALSE(conflict(info(s, "reads"), info(s, "works")));
  EXPECT_TRUE(conflict(info(s, "reads"), info(s, "writes")));
  EXPECT_TRUE(conflict(info(s, "works"), info(s, "writes")));
  EXPECT_TRUE(conflict(info(s, "works"), info(s, "counts")));
}

TEST(ScheduleBundles, AMissingMemberIsNamed) {
  World world;
  Wind wind;
  Schedule schedule(world);
  schedule.provide(wind);
  schedule.add("work", [](WeatherWork) {});
  EXPECT_EQ(schedule.arrange(),
            "the system 'work' wants a Tally, which was not provided before it");
}

TEST(Schedule, ASystemMayReadAQueueAndEmitIntoIt) {
  struct Fall {
    int height_m;
  };
  World world;
  EventQueue<Fall> queue;
  Schedule schedule(world);
  schedule.provide(queue);
  schedule.add("bounce", [](EventReader<Fall>& falls, EventQueue<Fall>& bounces) {
    std::vector<Fall> seen;
    falls.drain(
        [&](std::span<const Fall> batch) { seen.insert(seen.end(), batch.begin(), batch.end()); });
    for (const Fall& fall : seen)
      bounces.emit(Fall{fall.height_m - 1});
  });
  EventReader<Fall> reader = queue.reader();
  queue.emit(Fall{7});
  schedule.run();
  std::vector<int> heights;
  reader.drain([&](std::span<const Fall> batch) {
    for (const Fall& fall : batch)
      heights.push_back(fall.height_m);
  });
  EXPECT_EQ(heights, (std::vector<int>{7, 6}));
}

struct Mixed {
  const Wind& wind;
  Tally tally;
};

TEST(ScheduleBundles, AValueBesideReferencesIsAMissingResource) {
  World world;
  Wind wind;
  Schedule schedule(world);
  schedule.provide(wind);
  schedule.add("mixed", [](Mixed) {});
  EXPECT_EQ(schedule.arrange(),
            "the system 'mixed' wants a Tally, which was not provided before it");
}

TEST(ScheduleBundles, AResourceThatComesTwiceIsNamedWithItsBundles) {
  const auto refused = [](auto system) {
    World world;
    Wind wind;
    Schedule schedule(world);
    schedule.provide(wind);
    schedule.add("twice", system);
    return schedule.arrange();
  };
  EXPECT_EQ(refused([](Weather, const Wind&) {}),
            "the system 'twice' takes Wind twice, in Weather and by itself");
  EXPECT_EQ(refused([](Wind&, const Wind&) {}),
            "the system 'twice' takes Wind twice, by itself and by itself");
}

TEST(ScheduleBundles, AQueueMayHaveOneReaderBesideItsWriter) {
  const auto refused = [](auto system) {
    World world;
    EventQueue<int> queue;
    Schedule schedule(world);
    schedule.provide(queue);
    schedule.add("twice", system);
    return schedule.arrange();
  };
  EXPECT_NE(refused([](EventReader<int>&, EventReader<int>&) {}), "");
  EXPECT_EQ(refused([](EventReader<int>&, EventQueue<int>&) {}), "");
}

// A schedule rejects the wrong uses of bundles at compile time; these are the conditions.
TEST(ScheduleBundles, OnlyStructsOfReferencesAreBundles) {
  static_assert(detail::Bundle<Weather> && detail::Bundle<WeatherWork> && detail::Bundle<Mixed>);
  static_assert(!detail::Bundle<Wind> && !detail::Bundle<Tally> && !detail::Bundle<const Wind&>);
  static_assert(!detail::Bundle<EventReader<int>> && !detail::Bundle<Commands>);
  static_assert(!detail::Bundle<Query<Position>> && !detail::Bundle<World>);
}

}  // namespace
}  // namespace psygen::ecs::test
