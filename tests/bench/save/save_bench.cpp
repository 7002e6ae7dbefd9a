// Time to save and to open a million edits, spread over a number of blocks. Files are in the folder
// TMPDIR, or /tmp.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "engine/core/hash.hpp"
#include "engine/save/save_game.hpp"

namespace psygen::save {
namespace {

constexpr std::int64_t kEdits = 1'000'000;
constexpr std::size_t kEditBytes = 24;  // per edit: kind, position, rotation, scale
const WorldIdentity kWorld{"bench", 1};

// A file that the destructor removes.
class File {
 public:
  File()
      : path_(std::filesystem::temp_directory_path() /
              ("psygen_bench_" + std::to_string(getpid()) + ".save")) {}
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

core::BlockCoord block_of(std::int64_t index) {
  return {static_cast<std::int32_t>(index % 1000), static_cast<std::int32_t>(index / 1000)};
}

Bytes random_edits(std::int64_t count) {
  core::RandomStream random(5, 0, 0, 0, core::Purpose::kStructure);
  Bytes bytes(static_cast<std::size_t>(count) * kEditBytes);
  for (std::byte& byte : bytes)
    byte = static_cast<std::byte>(random.next_u64());
  return bytes;
}

void put_all(SaveGame& save, std::int64_t blocks) {
  const Bytes bytes = random_edits(kEdits / blocks);
  for (std::int64_t i = 0; i < blocks; ++i)
    (void)save.put_edits(block_of(i), 1, bytes);
}

SaveGame opened(const File& file) {
  return std::move(*SaveGame::open(file.path(), kWorld));
}

void a_million_edits_are_put(benchmark::State& state) {
  const File file;
  SaveGame save = opened(file);
  for (auto _ : state) {
    put_all(save, state.range(0));
    state.PauseTiming();
    save.discard();
    state.ResumeTiming();
  }
}

void a_million_edits_are_saved(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    const File file;
    SaveGame save = opened(file);
    put_all(save, state.range(0));
    state.ResumeTiming();
    if (!save.save()) state.SkipWithError("cannot be saved");
    state.PauseTiming();
    state.counters["MB"] = static_cast<double>(std::filesystem::file_size(file.path())) * 1e-6;
    state.ResumeTiming();
  }
}

void one_block_of_a_million_edits_is_saved(benchmark::State& state) {
  const File file;
  SaveGame save = opened(file);
  put_all(save, state.range(0));
  if (!save.save()) state.SkipWithError("cannot be saved");
  const Bytes bytes = random_edits(kEdits / state.range(0));
  std::int64_t i = 0;
  for (auto _ : state) {
    (void)save.put_edits(block_of(i++ * 7919 % state.range(0)), 1, bytes);
    if (!save.save()) state.SkipWithError("cannot be saved");
  }
}

void a_save_with_a_million_edits_is_opened(benchmark::State& state) {
  const File file;
  {
    SaveGame save = opened(file);
    put_all(save, state.range(0));
    if (!save.save()) state.SkipWithError("cannot be saved");
  }
  for (auto _ : state)
    benchmark::DoNotOptimize(opened(file));
}

void a_million_edits_are_visited(benchmark::State& state) {
  const File file;
  SaveGame save = opened(file);
  put_all(save, state.range(0));
  if (!save.save()) state.SkipWithError("cannot be saved");
  for (auto _ : state) {
    std::size_t bytes = 0;
    (void)save.for_each_edits([&](auto, auto, auto edits) { bytes += edits.size(); });
    benchmark::DoNotOptimize(bytes);
  }
}

void the_edits_of_a_block_are_read(benchmark::State& state) {
  const File file;
  SaveGame save = opened(file);
  put_all(save, state.range(0));
  if (!save.save()) state.SkipWithError("cannot be saved");
  std::int64_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(save.edits(block_of(i++ * 7919 % state.range(0))));
}

void each(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("blocks")->Arg(1'000)->Arg(10'000)->Arg(1'000'000)->UseRealTime();
}
BENCHMARK(a_million_edits_are_put)->Apply(each)->Unit(benchmark::kMillisecond);
BENCHMARK(a_million_edits_are_saved)->Apply(each)->Unit(benchmark::kMillisecond);
BENCHMARK(one_block_of_a_million_edits_is_saved)->Apply(each)->Unit(benchmark::kMillisecond);
BENCHMARK(a_save_with_a_million_edits_is_opened)->Apply(each)->Unit(benchmark::kMillisecond);
BENCHMARK(a_million_edits_are_visited)->Apply(each)->Unit(benchmark::kMillisecond);
BENCHMARK(the_edits_of_a_block_are_read)->Apply(each)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace psygen::save

BENCHMARK_MAIN();
