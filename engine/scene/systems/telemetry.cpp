#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

telemetry::Apart apart_of(render::Apart apart) {
  switch (apart) {
    case render::Apart::kNo:
      return telemetry::Apart::kNo;
    case render::Apart::kAfterIdle:
      return telemetry::Apart::kAfterIdle;
    case render::Apart::kResized:
      return telemetry::Apart::kResized;
    case render::Apart::kNotDrawn:
      return telemetry::Apart::kNotDrawn;
  }
  return telemetry::Apart::kNo;
}

// What the renderer says of the frame.
void note_drawing(const render::FrameResult& frame, telemetry::FrameRecord& record) {
  record.device_wait_ms = frame.device.ms;
  record.acquire_ms = frame.acquire.ms;
  record.present_ms = frame.present.ms;
  record.record_ms = frame.cpu_ms;
  record.device_frame = frame.frame;
  record.apart = apart_of(frame.apart);
  record.triangles = frame.triangles;
  record.draws = frame.draws;
  record.resolution = frame.resolution;
}

}  // namespace

void telemetry_system(const Clock& clock, const Quality& quality, const Counters& counters,
                      const synthesis::MeshSupply& meshes, Totals& totals,
                      telemetry::FrameRecord& record) {
  const synthesis::CacheStats cache = meshes.stats();
  const auto since = [](std::uint64_t now, std::uint64_t before) {
    return static_cast<std::uint32_t>(now - before);
  };
  record.time_s = clock.now_s;
  note_drawing(counters.frame, record);
  record.error_pixels = quality.error_pixels;
  record.memory_factor = double{quality.coarsening};
  record.nodes_in_view = counters.nodes_in_view;
  record.holes = counters.holes;
  record.coarse_nodes = counters.coarse;
  record.missing_pixels_percent = counters.missing_pixels_percent;
  record.too_coarse_percent =
      counters.seen_area > 0 ? 100 * counters.too_coarse_area / counters.seen_area : 0.0;
  record.cache_bytes = cache.bytes;
  record.cache_hits = since(cache.hits, totals.cache.hits);
  record.cache_misses = since(cache.misses, totals.cache.misses);
  record.cache_evictions = since(cache.evictions, totals.cache.evictions);
  record.cache_regenerations = since(cache.regenerations, totals.cache.regenerations);
  record.requests_queued = counters.requests;
  record.requests_refused = counters.refused_visible;
  record.requests_completed = counters.completed;
  record.models_failed = counters.failed;
  record.models_synthesised = counters.models_synthesised;
  record.triangles_synthesised = counters.triangles_synthesised;
  record.bytes_synthesised = counters.bytes_synthesised;
  record.synthesis_seconds = counters.synthesis_seconds;
  totals.cache = cache;
}

}  // namespace psygen::scene
