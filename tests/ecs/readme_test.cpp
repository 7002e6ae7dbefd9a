// Runs the example of ecs/README.md, and compares its text with the README's.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "ecs/ecs.hpp"
#include "tests/source_file.hpp"

namespace {

// [example]
struct Position {
  float x = 0, y = 0;
};
struct Velocity {
  float x = 0, y = 0;
};

float fly(psygen::ecs::World& world) {
  const auto birds = world.create<Position, Velocity>(1000);  // handles and columns to fill
  for (Velocity& velocity : birds.column<Velocity>())
    velocity = {3, 4};
  const psygen::ecs::Entity first = birds.entities.front();

  world.each<Position, const Velocity>([](auto, auto positions, auto velocities) {
    for (std::size_t i = 0; i < positions.size(); ++i)
      positions[i].x += velocities[i].x;
  });
  world.destroy(birds.entities.subspan(500));
  return world.get<Position>(first)->x;
}
// [example]

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Readme, TheExampleRuns) {
  psygen::ecs::World world;
  EXPECT_EQ(fly(world), 3.0F);
  EXPECT_EQ(world.size(), 500U);
}

TEST(Readme, TheReadmeShowsTheExampleAsItIsTested) {
  const std::string mark = "// [example]\n";
  const std::string source = text_of(psygen::source_file("tests/ecs/readme_test.cpp"));
  const std::size_t begin = source.find(mark) + mark.size();
  const std::string example = source.substr(begin, source.find(mark, begin) - begin);
  ASSERT_GT(example.size(), 100U);
  EXPECT_NE(text_of(psygen::source_file("ecs/README.md")).find(example), std::string::npos);
}

}  // namespace
