// A realistic flight, generated frame by frame and identical in every run, and files for the tests
// of telemetry.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "engine/core/hash.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/summary.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::telemetry {

// Content of a file; empty if it cannot be read.
inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Names of the systems of a tick.
inline std::vector<std::string> tick_systems() {
  return {"input",     "streaming", "visibility", "cache",
          "synthesis", "upload",    "render",     "telemetry"};
}

// Their times in every frame, in ms.
inline constexpr std::array kTickSystemMs{0.02F, 0.35F, 0.9F, 0.4F, 0.25F, 0.2F, 0.6F, 0.01F};

// Frame `i` of a flight of about 1500 frames. `noise` is in [0, 1).
inline FrameRecord synthetic_frame(std::uint64_t i, double time_s, double noise) {
  FrameRecord r;
  const double progress = static_cast<double>(i) / 1500.0;
  r.index = i;
  r.time_s = time_s;
  r.frame_ms = 16.5 + 2.5 * std::sin(progress * 20.0) + 3.0 * noise * noise +
               (i < 12 ? 60.0 : 0.0) + (i == 700 ? 95.0 : 0.0);
  r.main_cpu_ms = r.frame_ms * 0.6;
  r.device_wait_ms = r.frame_ms * 0.7;
  r.record_ms = 0.4;
  r.gpu_ms = r.frame_ms * 0.9;
  r.gpu_shadows_ms = 0.5;
  r.device_frame = i + 1;
  r.error_pixels = 4;
  r.triangles = 95'000 + static_cast<std::uint64_t>(20'000.0 * std::sin(progress * 9.0));
  r.draws = 900;
  r.nodes_in_view = 1900;
  r.holes = i < 40 ? static_cast<std::uint32_t>(40 - i) : 0;
  if (i < 60) {
    r.coarse_nodes = static_cast<std::uint32_t>(120 - 2 * i);
  } else if (noise > 0.93) {
    r.coarse_nodes = static_cast<std::uint32_t>(14.0 * noise);
  }
  r.missing_pixels_percent = 0.05 * r.holes + 0.02 * r.coarse_nodes;
  r.too_coarse_percent = 0.01 * r.coarse_nodes;
  r.cache_bytes = static_cast<std::uint64_t>(std::min(505.0, 60.0 + progress * 900.0 + noise * 4.0))
                  << 20;
  r.cache_hits = 1850;
  r.cache_misses = 30;
  r.cache_evictions = progress > 0.5 ? 25 : 0;
  r.requests_completed = r.models_synthesised = 60 + static_cast<std::uint32_t>(noise * 80.0);
  r.requests_queued = 400;
  r.triangles_synthesised = r.models_synthesised * 1900ULL;
  r.bytes_synthesised = r.triangles_synthesised * 22ULL;
  r.synthesis_seconds = 0.004;
  return r;
}

// `frame_count` frames with a slow start, holes in the first second and one hitch at frame 700.
inline FrameLog synthetic_flight(std::uint64_t frame_count = 1500) {
  FrameLog log(tick_systems());
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  double time_s = 0;
  for (std::uint64_t i = 0; i < frame_count; ++i) {
    const FrameRecord record = synthetic_frame(i, time_s, random.next_unit());
    log.add(record, kTickSystemMs);
    log.add_time_to_visible(time_s, 20.0 + 100.0 * random.next_unit());
    log.add_cost_error(time_s, 1e-3 * random.next_real(0.8, 1.2), 1e-3);
    time_s += record.frame_ms * 1e-3;
  }
  return log;
}

// Facts of a run in the paper's world.
inline RunFacts synthetic_facts() {
  RunFacts facts;
  facts.world = {"paper",           42, {512, 512}, 32'832'000'000ULL, 8'404'992'000'000ULL,
                 700'000'000'000ULL};
  facts.world.block_m = 63;
  facts.world.block_models = 63;
  facts.world.block_triangles = 125'000;
  facts.world.block_bytes = 2'700'000;
  facts.device = {"llvmpipe (LLVM 15.0.6, 256 bits)", "Mesa 22.3.6", "1.3.230", true};
  facts.run = {"walk",     "pla",
               "deadline", 1,
               1280,       720,
               true,       Figure::missing("the flight follows the clock"),
               4,          Figure::missing("no frame rate is held")};
  facts.cache_budget_bytes = 512ULL << 20;
  facts.prefetch_hit_percent = 81.5;
  facts.share_drawn = 0.625;
  facts.peak_rss_bytes = 740ULL << 20;
  facts.world_hash = 0x0123456789ABCDEFULL;
  facts.path_hash = 0x00FFULL;
  return facts;
}

}  // namespace psygen::telemetry
