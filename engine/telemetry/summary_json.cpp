#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/replace_file.hpp"
#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/verdict.hpp"

namespace psygen::telemetry {
namespace {

using Json = nlohmann::ordered_json;

// Writes numbers as values or nulls, and collects the reasons of the nulls.
class Writer {
 public:
  Json figure(const std::string& path, const Figure& figure) {
    if (!figure.has_value()) return missing(path, figure.reason);
    if (!std::isfinite(*figure)) return missing(path, "the value is not a finite number");
    return *figure;
  }
  Json count(const std::string& path, const Count& count) {
    return count.has_value() ? Json(*count) : missing(path, count.reason);
  }
  Json hash(const std::string& path, const Count& hash) {
    return hash.has_value() ? Json(fmt::format("{:016x}", *hash)) : missing(path, hash.reason);
  }
  Json text(const std::string& path, const std::string& text, const char* reason) {
    return text.empty() ? missing(path, reason) : Json(text);
  }
  Json number(const std::string& path, double value) { return figure(path, Figure(value)); }
  const Json& reasons() const { return reasons_; }

 private:
  Json missing(const std::string& path, const std::string& reason) {
    reasons_[path] = reason;
    return nullptr;
  }
  Json reasons_ = Json::object();
};

Json world_json(const WorldFacts& world, Writer& w) {
  return {{"name", world.name},
          {"seed", world.seed},
          {"blocks", world.blocks},
          {"triangles", w.count("world.triangles", world.triangles)},
          {"bytes_paper", w.count("world.bytes_paper", world.bytes_paper)},
          {"bytes", w.count("world.bytes", world.bytes)},
          {"block",
           {{"side_m", world.block_m},
            {"models", w.number("world.block.models", world.block_models)},
            {"triangles", w.number("world.block.triangles", world.block_triangles)},
            {"bytes", w.number("world.block.bytes", world.block_bytes)}}}};
}

Json apart_json(const Summary& s) {
  Json result = Json::object();
  for (std::size_t kind = 1; kind < kApartKinds; ++kind)
    result[std::string(name_of(static_cast<Apart>(kind)))] = s.run.apart_frames[kind];
  return result;
}

Json spread_json(const std::string& path, const Spread& spread, Writer& w) {
  return {{"p50", w.figure(path + ".p50", spread.p50)},
          {"p99", w.figure(path + ".p99", spread.p99)}};
}

Json picture_json(const Summary& s) {
  const Verdict verdict = judge_quality(s);
  return {{"grade", name_of(verdict.grade)},
          {"headline", verdict.headline},
          {"reasons", verdict.reasons},
          {"advice", verdict.advice}};
}

Json run_json(const Summary& s, Writer& w) {
  return {{"path", w.text("run.path", s.run.path, "the run had no path")},
          {"paradigm", s.run.paradigm},
          {"policy", s.run.policy},
          {"modelers", s.run.modelers},
          {"width", s.run.width},
          {"height", s.run.height},
          {"frames", s.run.frames},
          {"seconds", w.number("run.seconds", s.run.seconds)},
          {"lod", s.run.lod},
          {"fixed_step", w.figure("run.fixed_step", s.run.fixed_step)},
          {"warmup_seconds", w.number("run.warmup_seconds", s.run.warmup_seconds)},
          {"measured_frames", s.run.measured_frames},
          {"timed_frames", s.run.timed_frames},
          {"apart_frames", apart_json(s)},
          {"real_seconds", w.figure("run.real_seconds", s.run.real_seconds)},
          {"error_pixels", s.run.error_pixels},
          {"target_fps", w.figure("run.target_fps", s.run.target_fps)}};
}

Json frame_json(const FrameTimes& t, Writer& w) {
  return {{"mean", w.figure("frame_ms.mean", t.mean)}, {"p50", w.figure("frame_ms.p50", t.p50)},
          {"p95", w.figure("frame_ms.p95", t.p95)},    {"p99", w.figure("frame_ms.p99", t.p99)},
          {"p999", w.figure("frame_ms.p999", t.p999)}, {"max", w.figure("frame_ms.max", t.max)}};
}

Json systems_json(const std::vector<SystemTimes>& systems, Writer& w) {
  Json result = Json::object();
  for (const SystemTimes& system : systems)
    result[system.name] = spread_json("system_ms." + system.name, {system.p50, system.p99}, w);
  return result;
}

Json wait_json(const Summary& s, Writer& w) {
  Json result = spread_json("wait_ms", s.wait_ms.all, w);
  result["device"] = spread_json("wait_ms.device", s.wait_ms.device, w);
  result["acquire"] = spread_json("wait_ms.acquire", s.wait_ms.acquire, w);
  result["present"] = spread_json("wait_ms.present", s.wait_ms.present, w);
  return result;
}

Json gpu_json(const Summary& s, Writer& w) {
  return {{"p50", w.figure("gpu_ms.p50", s.gpu_ms.p50)},
          {"p99", w.figure("gpu_ms.p99", s.gpu_ms.p99)},
          {"max", w.figure("gpu_ms.max", s.gpu_ms.max)},
          {"shadows_p50", w.figure("gpu_ms.shadows_p50", s.gpu_ms.shadows_p50)}};
}

Json detail_json(const Summary& s, Writer& w) {
  const auto& d = s.detail;
  return {
      {"asked_pixels", s.run.error_pixels},
      {"p50_pixels", w.figure("detail.p50_pixels", d.p50_pixels)},
      {"max_pixels", w.figure("detail.max_pixels", d.max_pixels)},
      {"resolution_p50", w.figure("detail.resolution_p50", d.resolution_p50)},
      {"resolution_min", w.figure("detail.resolution_min", d.resolution_min)},
      {"raised_by_memory_frames", w.count("detail.raised_by_memory_frames", d.raised_by_memory)},
      {"raised_for_target_frames", w.count("detail.raised_for_target_frames", d.raised_for_target)},
      {"refused_frames", w.count("detail.refused_frames", d.refused_frames)}};
}

Json missing_json(const Summary& s, Writer& w) {
  const auto& wait = s.missing.time_to_visible_ms;
  const std::string path = "missing.time_to_visible_ms";
  return {
      {"frames", w.count("missing.frames", s.missing.frames)},
      {"nodes_p99", w.figure("missing.nodes_p99", s.missing.nodes_p99)},
      {"pixels_p99_percent", w.figure("missing.pixels_p99_percent", s.missing.pixels_p99_percent)},
      {"pixels_max_percent", w.figure("missing.pixels_max_percent", s.missing.pixels_max_percent)},
      {"coarse_p99_percent", w.figure("missing.coarse_p99_percent", s.missing.coarse_p99_percent)},
      {"coarse_max_percent", w.figure("missing.coarse_max_percent", s.missing.coarse_max_percent)},
      {"coarse_frames", w.count("missing.coarse_frames", s.missing.coarse_frames)},
      {"coarse_seconds", w.figure("missing.coarse_seconds", s.missing.coarse_seconds)},
      {"time_to_visible_ms",
       {{"p50", w.figure(path + ".p50", wait.p50)},
        {"p99", w.figure(path + ".p99", wait.p99)},
        {"max", w.figure(path + ".max", wait.max)}}}};
}

Json cache_json(const Summary& s, Writer& w) {
  const auto& cache = s.cache;
  return {
      {"budget_bytes", cache.budget_bytes},
      {"peak_bytes", w.count("cache.peak_bytes", cache.peak_bytes)},
      {"hits", w.count("cache.hits", cache.hits)},
      {"misses", w.count("cache.misses", cache.misses)},
      {"evictions", w.count("cache.evictions", cache.evictions)},
      {"regenerations", w.count("cache.regenerations", cache.regenerations)},
      {"prefetch_hit_percent", w.figure("cache.prefetch_hit_percent", cache.prefetch_hit_percent)}};
}

Json synthesis_json(const Summary& s, Writer& w) {
  const auto& synthesis = s.synthesis;
  const std::string error = "synthesis.cost_error_percent";
  return {{"models", w.count("synthesis.models", synthesis.models)},
          {"triangles", w.count("synthesis.triangles", synthesis.triangles)},
          {"bytes", w.count("synthesis.bytes", synthesis.bytes)},
          {"failed", w.count("synthesis.failed", synthesis.failed)},
          {"seconds", w.figure("synthesis.seconds", synthesis.seconds)},
          {"busy_percent", w.figure("synthesis.busy_percent", synthesis.busy_percent)},
          {"coarse_busy_percent",
           w.figure("synthesis.coarse_busy_percent", synthesis.coarse_busy_percent)},
          {"share_drawn", w.figure("synthesis.share_drawn", synthesis.share_drawn)},
          {"triangles_per_second",
           w.figure("synthesis.triangles_per_second", synthesis.triangles_per_second)},
          {"cost_error_percent",
           {{"p50", w.figure(error + ".p50", synthesis.cost_error_percent.p50)},
            {"p95", w.figure(error + ".p95", synthesis.cost_error_percent.p95)}}}};
}

}  // namespace

std::string to_json(const Summary& s) {
  Writer w;
  Json json;
  json["schema"] = kSummarySchema;
  json["world"] = world_json(s.world, w);
  json["device"] = {{"name", s.device.name}, {"driver", s.device.driver}, {"api", s.device.api}};
  json["run"] = run_json(s, w);
  json["frame_ms"] = frame_json(s.frame_ms, w);
  json["low1_fps"] = w.figure("low1_fps", s.low1_fps);
  json["hitches"] = w.count("hitches", s.hitches);
  json["stutter_percent"] = w.figure("stutter_percent", s.stutter_percent);
  json["system_ms"] = systems_json(s.system_ms, w);
  json["wait_ms"] = wait_json(s, w);
  json["record_ms"] = spread_json("record_ms", s.record_ms, w);
  json["gpu_ms"] = gpu_json(s, w);
  json["picture"] = picture_json(s);
  json["detail"] = detail_json(s, w);
  json["missing"] = missing_json(s, w);
  json["cache"] = cache_json(s, w);
  json["synthesis"] = synthesis_json(s, w);
  json["draw"] = {{"triangles_p50", w.figure("draw.triangles_p50", s.draw.triangles_p50)},
                  {"draws_p50", w.figure("draw.draws_p50", s.draw.draws_p50)},
                  {"floor_ratio", w.figure("draw.floor_ratio", s.draw.floor_ratio)}};
  json["memory"] = {{"peak_rss_bytes", w.count("memory.peak_rss_bytes", s.memory.peak_rss_bytes)}};
  json["hash"] = {{"world", w.hash("hash.world", s.hash.world)},
                  {"path", w.hash("hash.path", s.hash.path)},
                  {"images", w.hash("hash.images", s.hash.images)}};
  json["reasons"] = w.reasons();
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

core::Result<void> write_summary_json(const std::filesystem::path& path, const Summary& summary) {
  return core::replace_file(path, to_json(summary));
}

}  // namespace psygen::telemetry
