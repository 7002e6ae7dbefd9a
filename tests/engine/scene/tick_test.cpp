#include "engine/scene/tick.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/source_file.hpp"

namespace psygen::scene {
namespace {

std::string names(const ecs::SystemInfo& system, bool writes) {
  std::string list;
  for (const ecs::Access& access : system.accesses) {
    if (access.writes != writes) continue;
    list += list.empty() ? access.name : ", " + access.name;
  }
  if (writes && system.world == ecs::WorldAccess::kWrites)
    list = list.empty() ? "World" : list + ", World";
  return list;
}

TEST(Tick, TheListIsTheOneOfTheArchitecturePage) {
  std::ifstream file(source_file("docs/architecture.md"));
  ASSERT_TRUE(file);
  std::stringstream text;
  text << file.rdbuf();
  State state;
  build_tick(state);
  std::string expected = "| system | reads | writes |\n| --- | --- | --- |\n";
  for (const ecs::SystemInfo& system : state.tick.systems()) {
    expected +=
        fmt::format("| `{}` | {} | {} |\n", system.name, names(system, false), names(system, true));
  }
  EXPECT_NE(text.str().find(expected), std::string::npos)
      << "docs/architecture.md should hold this table:\n"
      << expected;
}

}  // namespace
}  // namespace psygen::scene
