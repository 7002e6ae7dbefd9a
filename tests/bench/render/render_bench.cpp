// Cost of a frame on this machine's device: triangles, draws, sky pixels. Frames are replays by the
// renderer (the same lists, two frames in flight). frame_ms is wall time. Values per item
// (ns_per_*) are CPU time of the whole process, which on a software device is the work of the
// device and stays valid on a busy machine.
//   psygen_bench_render --benchmark_counters_tabular=true
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "engine/program/program.hpp"
#include "engine/render/types.hpp"
#include "tests/engine/render/synthetic_scene.hpp"

namespace {

using namespace psygen;
using namespace psygen::render;

constexpr core::Extent kSize{1280, 720};

std::unique_ptr<Renderer> make_renderer(Submission submission) {
  RendererOptions options;
  options.size = kSize;
  options.submission = submission;
  auto made = Renderer::create(options);
  if (made) return std::move(*made);
  std::fprintf(stderr, "%s\n", made.error().message.c_str());
  std::exit(4);
}

Submission submission_of(const benchmark::State& state) {
  return static_cast<Submission>(state.range(0));
}

// Returns wall and CPU milliseconds of one frame with these lists.
std::pair<double, double> frame_cost(Renderer& renderer, const FrameInput& input) {
  constexpr int kRepeats = 12;
  if (!renderer.render(input)) return {};
  renderer.wait_idle();
  const std::clock_t start = std::clock();
  const double wall_ms = renderer.replay_floor_ms(kRepeats).value_or(0.0);
  const double cpu_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return {wall_ms,
          cpu_s * 1e3 / (kRepeats + 2)};  // the replay draws two extra frames to fill the pipeline
}

// Reports the cost of `input` minus the cost of a frame without meshes, per `count` items.
void measure(benchmark::State& state, Renderer& renderer, const FrameInput& input,
             const char* counter, double count, double base_cpu_ms) {
  std::pair<double, double> best{1e9, 1e9};
  for (auto _ : state) {
    const auto cost = frame_cost(renderer, input);
    state.SetIterationTime(cost.first * 1e-3);
    best = {std::min(best.first, cost.first), std::min(best.second, cost.second)};
  }
  state.counters["frame_ms"] = best.first;
  state.counters["cpu_ms"] = best.second;
  state.counters[counter] = (best.second - base_cpu_ms) * 1e6 / count;
  constexpr std::array kNames{"auto", "multi-draw", "pushed"};
  state.SetLabel(kNames[static_cast<std::size_t>(state.range(0))]);
}

// Returns the CPU milliseconds that `more` adds to `base`, and the ratio `times` of both, as
// medians over alternating pairs of frames.
double compare(benchmark::State& state, Renderer& renderer, const FrameInput& base,
               const FrameInput& more) {
  std::vector<double> ratios, added_ms;
  frame_cost(renderer, more);
  for (auto _ : state) {
    const double base_ms = frame_cost(renderer, base).second;
    const auto [wall_ms, cpu_ms] = frame_cost(renderer, more);
    state.SetIterationTime(wall_ms * 1e-3);
    ratios.push_back(cpu_ms / base_ms);
    added_ms.push_back(cpu_ms - base_ms);
  }
  std::ranges::sort(ratios);
  std::ranges::sort(added_ms);
  state.counters["times"] = ratios[ratios.size() / 2];
  state.counters["added_ms"] = added_ms[added_ms.size() / 2];
  return added_ms[added_ms.size() / 2];
}

// CPU ms of a frame without meshes: sky on all pixels.
double sky_ms(Renderer& renderer) {
  const FrameInput input = synthetic::look(10, 0, kSize);
  return std::min(frame_cost(renderer, input).second, frame_cost(renderer, input).second);
}

void BM_sky(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  measure(state, *renderer, synthetic::look(10, 0.3, kSize), "ns_per_pixel",
          static_cast<double>(kSize.width) * kSize.height, 0);
}

// Cost of upscaling: the sky at 60 % of width and height, upscaled to the full image, minus the
// same sky without upscaling.
void BM_scaling_up(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  FrameInput input = synthetic::look(10, 0.3, kSize);
  input.resolution = 0.6F;
  const core::Extent few{kSize.width * 6 / 10, kSize.height * 6 / 10};
  if (!renderer->resize(few)) return state.SkipWithError("no memory for the picture");
  const double few_ms = sky_ms(*renderer);
  if (!renderer->resize(kSize)) return state.SkipWithError("no memory for the picture");
  measure(state, *renderer, input, "ns_per_pixel", double{kSize.width} * kSize.height, few_ms);
}

// Adjacent draws of `side`² vertices that fill the image. range(1): side; range(2): draws per row.
void BM_sheets(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  const double base_ms = sky_ms(*renderer);
  const int side = static_cast<int>(state.range(1)), row = static_cast<int>(state.range(2));
  const auto mesh = synthetic::make_sheet(renderer->geometry(), side);
  if (!mesh) return state.SkipWithError("no memory for the mesh");
  std::vector<MeshDraw> models;
  const float width = 96.0F / static_cast<float>(row), height = 54.0F / static_cast<float>(row);
  for (int y = 0; y < row; ++y) {
    for (int x = 0; x < row; ++x) {
      MeshDraw draw;
      draw.range = *mesh;
      draw.origin = {(static_cast<float>(x) + 0.5F) * width - 48.0F,
                     (static_cast<float>(y) + 0.5F) * height - 27.0F, -60.0F};
      draw.box_half_extent = {width / 2, height / 2, 1.0F};
      models.push_back(draw);
    }
  }
  FrameInput input = synthetic::look(10, 0, kSize);
  input.models = models;
  const double triangles = 2.0 * (side - 1) * (side - 1) * row * row;
  measure(state, *renderer, input, "ns_per_triangle", triangles, base_ms);
  state.counters["triangles"] = triangles;
  state.counters["px_per_triangle"] = static_cast<double>(kSize.width) * kSize.height / triangles;
}

// A crown of leaves: two thirds of a disc over a trunk.
core::ImpostorTexture leafy_picture() {
  core::ImpostorTexture picture(core::impostor_bytes());
  std::uint32_t random = 1;
  std::size_t at = 0;
  for (std::uint32_t level = 0; level < core::kImpostorLevels; ++level) {
    const std::size_t side = core::kImpostorSide >> level;
    for (std::size_t i = 0; i < core::kImpostorViews * side * side; ++i, at += 4) {
      random = random * 1664525 + 1013904223;
      const double x = (static_cast<double>(i % side) + 0.5) / static_cast<double>(side) - 0.5;
      const double y =
          (static_cast<double>(i / side % side) + 0.5) / static_cast<double>(side) - 0.4;
      const bool leaf = x * x + y * y < 0.16 && random >> 30 != 0;
      picture[at] = picture[at + 1] = 120;
      picture[at + 3] = leaf || (std::abs(x) < 0.03 && y > 0) ? 255 : 0;
    }
  }
  return picture;
}

// A row of trees across the bounds as one mesh of billboards, textured or plain.
core::Result<core::GeometryRange> make_row(core::GeometryMemory& memory, std::uint32_t trees,
                                           float half_width_m, bool pictured) {
  const auto reserved = memory.reserve(core::VertexLayout::kModel, 4 * trees, 6 * trees);
  if (!reserved) return tl::unexpected(reserved.error());
  std::vector<core::ModelVertex> vertices(std::size_t{4} * trees);
  constexpr std::array<std::uint16_t, 6> kQuad{0, 1, 2, 0, 2, 3};
  for (std::uint32_t i = 0; i < 4 * trees; ++i) {
    const bool right = i % 4 == 1 || i % 4 == 2, top = i % 4 >= 2;
    const float x = (static_cast<float>(i / 4) + 0.5F) / static_cast<float>(trees) * 2 - 1;
    core::ModelVertex& v = vertices[i];
    v.position[0] = static_cast<std::int16_t>(x * 32767);
    v.position[1] = top ? 32767 : -32767;
    const float aside = (right ? half_width_m : -half_width_m) / core::kBillboardReachM;
    v.normal[0] = static_cast<std::int16_t>(aside * 32767);
    v.ambient = 255;
    v.colour[1] = right ? 255 : 0;
    v.colour[2] = top ? 0 : 255;
    v.material =
        static_cast<std::uint8_t>(core::kBillboardBit | 1 | (pictured ? core::kImpostorBit : 0));
  }
  for (std::size_t i = 0; i < std::size_t{6} * trees; ++i)
    reserved->indices[i] = static_cast<std::uint16_t>(4 * (i / 6) + kQuad[i % 6]);
  std::ranges::copy(std::as_bytes(std::span(vertices)), reserved->vertices.begin());
  memory.commit(reserved->range);
  return reserved->range;
}

// 60 rows of 64 trees behind each other, nearest first. range(1): height of a tree in pixels.
// range(2): 0 plain quads, 1 impostors, 2 plain quads in the pipeline of impostors. `ns_per_tree`
// is CPU time beyond a frame without trees, a median over pairs of frames.
void BM_trees(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  const core::ImpostorTexture picture = leafy_picture();
  if (!renderer->set_model_pictures({&picture, 1})) return state.SkipWithError("no pictures");
  constexpr std::uint32_t kRow = 64, kRows = 60;
  constexpr float kNear_m = 60, kPixelsPerRadian = 623;
  const float half_m = static_cast<float>(state.range(1)) * kNear_m / kPixelsPerRadian / 2;
  const auto mesh = make_row(renderer->geometry(), kRow, half_m, state.range(2) == 1);
  if (!mesh) return state.SkipWithError("no memory for the mesh");
  std::vector<MeshDraw> models;
  for (std::uint32_t row = 0; row < kRows; ++row) {
    MeshDraw draw;
    draw.range = *mesh;
    draw.origin = {0, 0.2F * half_m * static_cast<float>(row), -kNear_m - static_cast<float>(row)};
    draw.box_half_extent = {55, half_m, 1};
    draw.pictured = state.range(2) != 0;
    models.push_back(draw);
  }
  const FrameInput sky = synthetic::look(10, 0, kSize);
  FrameInput input = sky;
  input.models = models;
  state.counters["ns_per_tree"] = compare(state, *renderer, sky, input) * 1e6 / (kRow * kRows);
}

// range(1) draws of one small mesh behind the camera: the cost of a draw without pixels.
void BM_draws(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  const double base_ms = sky_ms(*renderer);
  const auto mesh = synthetic::make_sheet(renderer->geometry(), 2);
  if (!mesh) return state.SkipWithError("no memory for the mesh");
  std::vector<MeshDraw> models(static_cast<std::size_t>(state.range(1)));
  for (MeshDraw& draw : models) {
    draw.range = *mesh;
    draw.origin = {0, 0, 50};
  }
  FrameInput input = synthetic::look(10, 0, kSize);
  input.models = models;
  measure(state, *renderer, input, "ns_per_draw", static_cast<double>(models.size()), base_ms);
}

// A landscape of range(1)² terrain blocks with 64² vertices each, seen from 30 m.
void BM_terrain(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  const double base_ms = sky_ms(*renderer);
  const auto grid = renderer->upload_shared_indices(synthetic::grid_indices(64));
  const auto mesh = synthetic::make_terrain(renderer->geometry(), 64, [](int x, int z) {
    return 0.5F +
           0.25F * std::sin(static_cast<float>(x) * 0.1F) * std::cos(static_cast<float>(z) * 0.1F);
  });
  if (!grid || !mesh) return state.SkipWithError("no memory for the mesh");
  const int blocks = static_cast<int>(state.range(1));
  std::vector<TerrainDraw> terrain;
  for (int z = 0; z < blocks; ++z) {
    for (int x = 0; x < blocks; ++x) {
      TerrainDraw draw;
      draw.range = *mesh;
      draw.shared_indices = *grid;
      draw.origin = {static_cast<float>(x - blocks / 2) * 60.0F, -40.0F,
                     -static_cast<float>(z) * 60.0F};
      draw.cell_m = 60.0F / 63.0F;
      draw.height_range_m = 20.0F;
      terrain.push_back(draw);
    }
  }
  FrameInput input = synthetic::look(30, -0.1, kSize);
  input.terrain = terrain;
  input.block_size_m = 60;
  const double triangles = 63.0 * 63 * 2 * blocks * blocks;
  measure(state, *renderer, input, "ns_per_triangle", triangles, base_ms);
  state.counters["triangles"] = triangles;
}

// Ground within about 40 m that fills the image: cost of the near pipeline in preset low or medium
// (range(1)). `times` as in BM_lights.
void BM_near_ground(benchmark::State& state) {
  RendererOptions options;
  options.size = kSize;
  options.submission = submission_of(state);
  options.preset = static_cast<Preset>(state.range(1));
  const auto renderer = Renderer::create(options);
  if (!renderer) return state.SkipWithError(renderer.error().message.c_str());
  const auto grid = (*renderer)->upload_shared_indices(synthetic::grid_indices(64));
  const auto mesh =
      synthetic::make_terrain((*renderer)->geometry(), 64, [](int, int) { return 0.5F; });
  if (!grid || !mesh) return state.SkipWithError("no memory for the mesh");
  TerrainDraw far;
  far.range = *mesh;
  far.shared_indices = *grid;
  far.origin = {-60.0F, -20.0F, -60.0F};
  far.cell_m = 120.0F / 63.0F;
  TerrainDraw near = far;
  near.near = true;
  FrameInput without = synthetic::look(20, -1.2, kSize);
  without.block_size_m = 120;
  without.terrain = {&far, 1};
  FrameInput with = without;
  with.terrain = {&near, 1};
  const double added_ms = compare(state, **renderer, without, with);
  state.counters["ns_per_pixel"] = added_ms * 1e6 / (double{kSize.width} * kSize.height);
}

// A landscape of 4² blocks with range(1) point lights with a range of 15 m. `times` is the ratio of
// CPU time to the same frame without lights, a median over pairs of frames.
void BM_lights(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  const auto grid = renderer->upload_shared_indices(synthetic::grid_indices(64));
  const auto mesh =
      synthetic::make_terrain(renderer->geometry(), 64, [](int, int) { return 0.5F; });
  if (!grid || !mesh) return state.SkipWithError("no memory for the mesh");
  std::vector<TerrainDraw> terrain(16);
  for (std::size_t i = 0; i < terrain.size(); ++i) {
    terrain[i].range = *mesh;
    terrain[i].shared_indices = *grid;
    terrain[i].origin = {static_cast<float>(i % 4) * 60.0F - 120.0F, -20.0F,
                         -60.0F - static_cast<float>(i / 4) * 60.0F};
    terrain[i].cell_m = 60.0F / 63.0F;
    terrain[i].height_range_m = 20.0F;
    terrain[i].side_m = 60.0F;
  }
  std::vector<PointLight> lights(static_cast<std::size_t>(state.range(1)));
  for (std::size_t i = 0; i < lights.size(); ++i)
    lights[i] = {{static_cast<float>(i % 8) * 10.0F - 35.0F, -8.0F,
                  -20.0F - static_cast<float>(i / 8) * 10.0F},
                 15.0F,
                 glm::vec3(2.0F)};
  FrameInput dark = synthetic::look(30, -0.2, kSize);
  dark.terrain = terrain;
  FrameInput lit = dark;
  lit.point_lights = lights;
  compare(state, *renderer, dark, lit);
}

// range(1) particles of 20 cm in a box in front of the camera, a thousand per emitter. `times` as
// in BM_lights; `ns_per_particle` is CPU time.
void BM_particles(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  std::vector<ParticleDraw> emitters(static_cast<std::size_t>(state.range(1)) / 1000);
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    ParticleDraw& emitter = emitters[i];
    emitter.kind.half_extent_m = {12, 7, 5};
    emitter.kind.first_size_m = emitter.kind.last_size_m = 0.2F;
    emitter.kind.velocity = {0, -1, 0};
    emitter.origin = {0, 0, -20};
    emitter.count = 1000;
    emitter.cycle_s = 3;
    emitter.seed = static_cast<std::uint32_t>(2 * i);
    emitter.next_seed = emitter.seed + 1;
  }
  const FrameInput without = synthetic::look(10, 0, kSize);
  FrameInput with = without;
  with.particles = emitters;
  const double added_ms = compare(state, *renderer, without, with);
  state.counters["ns_per_particle"] = added_ms * 1e6 / static_cast<double>(state.range(1));
}

// Ten thousand meshes of 12 or 128 triangles that move in every frame: as models and as objects,
// alternating, with new lists. `objects_per_models` is the ratio of the CPU times of the whole
// process, a median over pairs of frames.
void BM_moving(benchmark::State& state) {
  const auto renderer = make_renderer(submission_of(state));
  const bool boxes = state.range(1) == 0;
  const auto model = boxes ? synthetic::make_box(renderer->geometry(), {0.3F, 0.2F, 0.1F})
                           : synthetic::make_sheet(renderer->geometry(), 9);
  const auto object = boxes ? synthetic::make_object_box(renderer->geometry(), {0.3F, 0.2F, 0.1F})
                            : synthetic::make_object_sheet(renderer->geometry(), 9);
  if (!model || !object) return state.SkipWithError("no memory for the mesh");
  const int side = 100;
  std::vector<MeshDraw> models(side * side);
  std::vector<ObjectDraw> objects(side * side);
  FrameInput input = synthetic::look(30, -0.2, kSize);
  float time = 0;
  const auto move = [&](auto& draws, const core::GeometryRange& range) {
    time += 0.02F;
    for (int i = 0; i < side * side; ++i) {
      auto& draw = draws[static_cast<std::size_t>(i)];
      draw.range = range;
      draw.origin = {static_cast<float>(i % side - side / 2) * 1.5F + std::sin(time), -20.0F,
                     -20.0F - static_cast<float>(i / side) * 1.5F};
      draw.box_half_extent = glm::vec3(0.5F);
      if constexpr (requires { draw.rotation; }) {
        draw.rotation = {0, std::sin(time), 0, std::cos(time)};
        draw.name = static_cast<std::uint32_t>(i);
      }
    }
  };
  const auto cpu_ms_of = [&](bool as_objects) {
    const std::clock_t start = std::clock();
    constexpr int kFrames = 4;
    for (int i = 0; i < kFrames; ++i) {
      if (as_objects) {
        move(objects, *object);
      } else {
        move(models, *model);
      }
      input.models = as_objects ? std::span<const MeshDraw>() : models;
      input.objects =
          as_objects ? std::span<const ObjectDraw>(objects) : std::span<const ObjectDraw>();
      if (!renderer->render(input)) return 0.0;
    }
    renderer->wait_idle();
    return static_cast<double>(std::clock() - start) * 1e3 / CLOCKS_PER_SEC / kFrames;
  };
  cpu_ms_of(false);
  cpu_ms_of(true);
  std::vector<double> ratios, models_ms, objects_ms;
  for (auto _ : state) {
    models_ms.push_back(cpu_ms_of(false));
    objects_ms.push_back(cpu_ms_of(true));
    ratios.push_back(objects_ms.back() / models_ms.back());
    state.SetIterationTime(objects_ms.back() * 1e-3);
  }
  const auto median = [](std::vector<double>& values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
  };
  state.counters["models_ms"] = median(models_ms);
  state.counters["objects_ms"] = median(objects_ms);
  state.counters["objects_per_models"] = median(ratios);
}

}  // namespace

BENCHMARK(BM_moving)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(25)
    ->ArgsProduct({{0}, {0, 1}});
BENCHMARK(BM_lights)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(9)
    ->ArgsProduct({{0}, {0, 1, 32}});
BENCHMARK(BM_particles)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(9)
    ->ArgsProduct({{0}, {1000, 10000}});
BENCHMARK(BM_near_ground)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(9)
    ->ArgsProduct({{0}, {0, 1}});
BENCHMARK(BM_scaling_up)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3)->Arg(0);
BENCHMARK(BM_sky)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3)->Arg(0);
BENCHMARK(BM_sheets)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3)
    ->ArgsProduct({{0, 1, 2}, {65}, {5}})
    ->ArgsProduct({{0, 1, 2}, {17}, {20}})
    ->ArgsProduct({{0, 1, 2}, {5}, {60}})
    ->ArgsProduct({{0, 1, 2}, {3}, {120}});
BENCHMARK(BM_trees)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(5)
    ->ArgsProduct({{0}, {8, 16, 40, 100}, {0, 1, 2}});
BENCHMARK(BM_draws)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3)
    ->ArgsProduct({{0, 1, 2}, {1000, 10000}});
BENCHMARK(BM_terrain)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3)
    ->ArgsProduct({{0, 1, 2}, {4, 8}});

int main(int argc, char** argv) {
  return psygen::program::run("psygen_bench_render", [&]() -> int {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return psygen::program::kUsage;
    benchmark::RunSpecifiedBenchmarks();
    return psygen::program::kOk;
  });
}
