// Holds docs/architecture.md to the systems of the tick: what each reads and writes, the members of
// the bundles, and the systems that may run at the same time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "engine/scene/state.hpp"
#include "tests/source_file.hpp"

namespace psygen::scene {
namespace {

using TickSystems = std::span<const ecs::SystemInfo>;
using Names = std::vector<std::string>;

class Tick : public testing::Test {
 protected:
  Tick() { build_tick(state_); }

  static void expect_in_page(const std::string& table) {
    std::ifstream file(source_file("docs/architecture.md"));
    ASSERT_TRUE(file);
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_NE(text.str().find(table), std::string::npos)
        << "docs/architecture.md should hold this table:\n"
        << table;
  }
  TickSystems systems() const { return state_.tick.systems(); }

 private:
  State state_;
};

void add_once(const std::string& name, Names& names) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

bool has_bundle(const ecs::SystemInfo& system, std::string_view bundle) {
  return std::ranges::find(system.accesses, bundle, &ecs::Access::bundle) != system.accesses.end();
}

// The bundle that holds the world.
std::string world_bundle() {
  return ecs::detail::without_namespace(ecs::detail::type_name<NodeWork>());
}

// The world itself is no access. A system gets it from that bundle or as a parameter.
bool takes_world(const ecs::SystemInfo& system) {
  return system.world != ecs::WorldAccess::kNone && !has_bundle(system, world_bundle());
}

// Bundles and values that the system names, those that it reads or those that it writes.
Names named(const ecs::SystemInfo& system, bool writes) {
  Names names;
  for (const ecs::Access& access : system.accesses) {
    if (access.writes == writes)
      add_once(access.bundle.empty() ? access.name : access.bundle, names);
  }
  if (writes && takes_world(system)) names.push_back("World");
  return names;
}

// A query is one parameter, whatever its components.
std::size_t parameter_count(const ecs::SystemInfo& system) {
  Names names;
  for (const ecs::Access& access : system.accesses)
    add_once(access.is_component     ? "a query"
             : access.bundle.empty() ? access.name
                                     : access.bundle,
             names);
  return names.size() + (takes_world(system) ? 1 : 0);
}

// For each system, those of the later ones that must wait for it, directly or through others.
std::vector<std::vector<bool>> waits(TickSystems systems) {
  const std::size_t count = systems.size();
  std::vector<std::vector<bool>> after(count, std::vector<bool>(count, false));
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t k = i + 1; k < count; ++k) {
      if (!ecs::conflict(systems[i], systems[k])) continue;
      after[i][k] = true;
      for (std::size_t m = k + 1; m < count; ++m)
        if (after[k][m]) after[i][m] = true;
    }
  }
  return after;
}

TEST_F(Tick, TheSystemsTableIsTheOneOfTheArchitecturePage) {
  std::string table = "| system | reads | writes |\n| --- | --- | --- |\n";
  for (const ecs::SystemInfo& system : systems())
    table += fmt::format("| `{}` | {} | {} |\n", system.name, fmt::join(named(system, false), ", "),
                         fmt::join(named(system, true), ", "));
  expect_in_page(table);
}

TEST_F(Tick, TheBundlesTableIsTheOneOfTheArchitecturePage) {
  std::vector<std::pair<std::string, Names>> bundles;
  for (const ecs::SystemInfo& system : systems()) {
    for (const ecs::Access& access : system.accesses) {
      if (access.bundle.empty()) continue;
      auto known = std::ranges::find(bundles, access.bundle, &std::pair<std::string, Names>::first);
      if (known == bundles.end()) known = bundles.insert(bundles.end(), {access.bundle, {}});
      if (access.bundle == world_bundle()) add_once("World", known->second);
      add_once(access.name, known->second);
    }
  }
  std::string table = "| bundle | members |\n| --- | --- |\n";
  for (const auto& [bundle, members] : bundles)
    table += fmt::format("| {} | {} |\n", bundle, fmt::join(members, ", "));
  expect_in_page(table);
}

TEST_F(Tick, TheTableOfOverlapsIsTheOneOfTheArchitecturePage) {
  const auto after = waits(systems());
  std::string table = "| system | may run at the same time as |\n| --- | --- |\n";
  for (std::size_t i = 0; i < systems().size(); ++i) {
    for (std::size_t k = i + 1; k < systems().size(); ++k) {
      if (!after[i][k])
        table += fmt::format("| `{}` | `{}` |\n", systems()[i].name, systems()[k].name);
    }
  }
  expect_in_page(table);
}

TEST_F(Tick, NoSystemWritesSettingsRulesOrClock) {
  for (const std::string_view name : {"SceneSettings", "Rules", "Clock"}) {
    std::size_t readers = 0;
    for (const ecs::SystemInfo& system : systems()) {
      for (const ecs::Access& access : system.accesses) {
        if (access.name != name) continue;
        ++readers;
        EXPECT_FALSE(access.writes) << system.name << " writes " << name;
      }
    }
    EXPECT_GT(readers, 0U) << name << " is the name of no value";
  }
}

TEST_F(Tick, SystemsHaveFewParametersAndFewConflicts) {
  std::size_t sum = 0, most = 0, free_pairs = 0;
  for (std::size_t i = 0; i < systems().size(); ++i) {
    const std::size_t count = parameter_count(systems()[i]);
    sum += count;
    most = std::max(most, count);
    for (std::size_t k = 0; k < i; ++k)
      free_pairs += ecs::conflict(systems()[i], systems()[k]) ? 0 : 1;
  }
  fmt::print("{} systems: {} parameters, at most {}; {} pairs without a conflict\n",
             systems().size(), sum, most, free_pairs);
  EXPECT_LE(sum, 80U);
  EXPECT_LE(most, 7U);
  EXPECT_GE(free_pairs, 42U);
}

}  // namespace
}  // namespace psygen::scene
