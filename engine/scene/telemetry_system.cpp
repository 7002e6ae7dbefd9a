#include <algorithm>
#include <limits>

#include "engine/scene/systems.hpp"

namespace psygen::scene {

void telemetry_system(const Clock& clock, const Quality& quality, const Counters& counters,
                      const DrawLists& draws, Synthesis& synthesis, Totals& totals,
                      telemetry::FrameRecord& record) {
  synthesis.cache->note_drawn(draws.meshes);
  const synthesis::CacheStats cache = synthesis.cache->stats();
  const auto since = [](std::uint64_t now, std::uint64_t before) {
    return static_cast<std::uint32_t>(now - before);
  };
  record.time_s = clock.now_s;
  record.wait_ms = counters.frame.wait_ms;
  record.gpu_ms = counters.frame.gpu_ms.value_or(0.0);
  record.error_pixels = quality.error_pixels;
  record.triangles = counters.frame.triangles;
  record.draws = counters.frame.draws;
  record.nodes_in_view = counters.nodes_in_view;
  record.holes = counters.holes;
  record.coarse_nodes = counters.coarse;
  record.missing_pixels_percent = counters.missing_pixels_percent;
  record.cache_bytes = cache.bytes;
  record.cache_hits = since(cache.hits, totals.cache.hits);
  record.cache_misses = since(cache.misses, totals.cache.misses);
  record.cache_evictions = since(cache.evictions, totals.cache.evictions);
  record.cache_regenerations = since(cache.regenerations, totals.cache.regenerations);
  record.requests_queued = counters.requests;
  record.requests_completed = counters.completed;
  record.models_synthesised = counters.models_synthesised;
  record.triangles_synthesised = counters.triangles_synthesised;
  record.bytes_synthesised = counters.bytes_synthesised;
  record.synthesis_seconds = counters.synthesis_seconds;
  totals.cache = cache;
  totals.awaiting_since_s = counters.awaited > 0 ? std::min(totals.awaiting_since_s, clock.real_s)
                                                 : std::numeric_limits<double>::infinity();
}

}  // namespace psygen::scene
