// Main-thread cost of a mouse move in an editor tool: a brush stroke over masks of several sizes,
// the world update that follows, and overlays on the ground of a new world.
#include <benchmark/benchmark.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "editor/document/parsed_world.hpp"
#include "editor/tools/mask_stroke.hpp"
#include "editor/tools/new_mask.hpp"
#include "editor/view/tool_overlay.hpp"
#include "tests/source_file.hpp"

namespace psygen::editor {
namespace {

PicturePtr white(std::uint32_t side) {
  auto picture = std::make_shared<world::GreyPicture>();
  picture->width = picture->height = side;
  picture->pixels.assign(std::size_t{side} * side, 65535);
  picture->hash = world::content_hash(*picture);
  return picture;
}

// Other owners still hold the two previous images, as in a view.
void stroke(benchmark::State& state) {
  const auto side = static_cast<std::uint32_t>(state.range(0));
  MaskStroke stroke(white(side), {0, 0, 2.0 * side, 2.0 * side}, {20, 1, true});
  const double middle_m = side, radius_m = 0.8 * side;
  PicturePtr shown, prepared;
  int moves = 0;
  for (auto _ : state) {
    const double angle = ++moves * 10.0 / radius_m;  // 10 m further along a circle
    benchmark::DoNotOptimize(
        stroke.go_to(middle_m + radius_m * glm::dvec2(std::sin(angle), std::cos(angle))));
    shown = std::exchange(prepared, stroke.now());
  }
}
BENCHMARK(stroke)->Arg(256)->Arg(1024)->Arg(4096)->Unit(benchmark::kMicrosecond);

std::string valley() {
  std::ifstream file(source_file("game/worlds/silver_combe.toml"));
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Returns a new world from the same text.
void read_world(benchmark::State& state) {
  const std::string text = valley();
  const std::string name = source_file("game/worlds/silver_combe.toml");
  for (auto _ : state)
    benchmark::DoNotOptimize(parse_world_text(text, name, {}));
}
BENCHMARK(read_world)->Unit(benchmark::kMicrosecond);

// Draws the border of a mask and a road on the ground of a new world. Argument 1: another sky.
void marks_of_new_world(benchmark::State& state) {
  const std::string text = valley();
  const std::string name = source_file("game/worlds/silver_combe.toml");
  const ParsedWorldPtr worlds[] = {parse_world_text(text, name, {}).value(),
                                   parse_world_text(text, name, {}).value()};
  ToolMarks marks;
  for (int line = 0; line < 8; ++line) {
    marks.lines.emplace_back();
    for (int i = 0; i <= 32; ++i)
      marks.lines.back().points_m.emplace_back(32.0 * i, 128.0 * line);
  }
  ToolOverlay overlay;
  int round = 0;
  for (auto _ : state) {
    overlay.note_world();
    overlay.set(marks, worlds[++round % 2]->world);
  }
}
BENCHMARK(marks_of_new_world)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace psygen::editor

BENCHMARK_MAIN();
