#include "engine/scene/telemetry_system.hpp"

#include "engine/synthesis/mesh_supply.hpp"

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

// Records the renderer's times and counts.
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
  record.handed_over_s = frame.handed_over_s;
  if (frame.memory_bytes > 0) record.device_bytes = frame.memory_bytes;
}

}  // namespace

void telemetry_system(const Clock& clock, const Quality& quality, const SceneMeshes& meshes,
                      const DrawLists& draws, const synthesis::MeshSupply& supply,
                      Telemetry& telemetry) {
  const MeshCounts& made = meshes.counts;
  const DrawCounts& drawn = draws.counts;
  const synthesis::CacheStats cache = supply.stats();
  telemetry::FrameRecord& record = telemetry.record;
  const auto since = [](std::uint64_t now, std::uint64_t before) {
    return static_cast<std::uint32_t>(now - before);
  };
  record.time_s = clock.now_s;
  note_drawing(draws.frame, record);
  record.error_pixels = quality.error_pixels;
  record.memory_factor = double{quality.coarsening};
  record.nodes_in_view = drawn.nodes_in_view;
  record.holes = drawn.holes;
  record.coarse_nodes = drawn.coarse;
  record.missing_pixels_percent = drawn.missing_pixels_percent;
  record.too_coarse_percent =
      drawn.seen_area > 0 ? 100 * drawn.too_coarse_area / drawn.seen_area : 0.0;
  record.cache_bytes = cache.bytes;
  record.cache_hits = since(cache.hits, telemetry.cache.hits);
  record.cache_misses = since(cache.misses, telemetry.cache.misses);
  record.cache_evictions = since(cache.evictions, telemetry.cache.evictions);
  record.cache_regenerations = since(cache.regenerations, telemetry.cache.regenerations);
  record.requests_queued = made.requests;
  record.requests_refused = made.refused_visible;
  record.requests_completed = made.completed;
  record.models_failed = made.failed;
  record.models_synthesised = made.models_synthesised;
  record.triangles_synthesised = made.triangles_synthesised;
  record.bytes_synthesised = made.bytes_synthesised;
  record.synthesis_seconds = made.synthesis_seconds;
  telemetry.cache = cache;
}

}  // namespace psygen::scene
