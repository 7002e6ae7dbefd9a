#include "engine/scene/tick.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace psygen::scene {
namespace {

TEST(Tick, TheListIsTheOneOfTheArchitecturePage) {
  std::ifstream file(PSYGEN_SOURCE_DIR "/docs/architecture.md");
  ASSERT_TRUE(file);
  std::stringstream text;
  text << file.rdbuf();
  std::string expected = "| system | reads | writes |\n| --- | --- | --- |\n";
  for (const System& system : tick_systems()) {
    expected += fmt::format("| `{}` | {} | {} |\n", system.name, system.reads, system.writes);
  }
  EXPECT_NE(text.str().find(expected), std::string::npos)
      << "docs/architecture.md should hold this table:\n"
      << expected;
}

TEST(Tick, TheFrameLogHasRoomForEverySystem) {
  EXPECT_LE(tick_systems().size(), telemetry::kMaxSystems);
}

}  // namespace
}  // namespace psygen::scene
