#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/summary_fields.hpp"
#include "engine/telemetry/verdict.hpp"

namespace psygen::telemetry {

// Key of the object that stands for a missing number until take_reasons() replaces it.
constexpr const char* kReason = "\nreason";

// nlohmann::json finds these by the types of their arguments.
template <class Json, class T>
void to_json(Json& json, const Measured<T>& measured) {
  if constexpr (std::is_same_v<T, double>) {
    if (measured.has_value() && !std::isfinite(*measured))
      return to_json(json, Measured<T>::missing("the value is not a finite number"));
  }
  if (measured.has_value()) {
    json = *measured;
  } else {
    json[kReason] = measured.reason;
  }
}
template <class Json>
void to_json(Json& json, const Spread& spread) {
  json = {{"p50", spread.p50}, {"p99", spread.p99}};
}

namespace {

using Json = nlohmann::ordered_json;
MeasuredText hash_text(const Count& hash) {
  return hash.has_value() ? MeasuredText(fmt::format("{:016x}", *hash))
                          : MeasuredText::missing(hash.reason);
}

// Replaces missing numbers by null, and adds their reasons by path ("frame_ms.p999").
void take_reasons(Json& json, const std::string& path, Json& reasons) {
  if (!json.is_object()) return;
  for (auto& [key, value] : json.items()) {
    const std::string name = path.empty() ? key : path + "." + key;
    if (value.is_object() && value.contains(kReason)) {
      reasons[name] = value[kReason];
      value = nullptr;
    } else {
      take_reasons(value, name, reasons);
    }
  }
}

Json world_json(const WorldFacts& world) {
  return {{"name", world.name},
          {"seed", world.seed},
          {"blocks", world.blocks},
          {"triangles", world.triangles},
          {"bytes_paper", world.bytes_paper},
          {"bytes", world.bytes},
          {"block",
           {{"side_m", world.block_m},
            {"models", Figure(world.block_models)},
            {"triangles", Figure(world.block_triangles)},
            {"bytes", Figure(world.block_bytes)}}}};
}

Json machine_json(const MachineFacts& m) {
  return {{"cpu", m.cpu},
          {"cpu_features", m.cpu_features},
          {"cores", m.cores},
          {"quota_cores", m.quota_cores},
          {"memory_bytes", m.memory_bytes},
          {"governor", m.governor},
          {"kernel", m.kernel}};
}

Json build_json(const BuildFacts& b) {
  return {{"version", b.version},
          {"compiler", b.compiler},
          {"type", b.type},
          {"revision", b.revision},
          {"clean", b.clean}};
}

Json load_json(const LoadFacts& l) {
  return {{"before", l.before},
          {"others_cores", l.others_cores},
          {"steal_percent", l.steal_percent},
          {"cpu_seconds", l.cpu_seconds}};
}

Json times_json(const LoadTimes& times) {
  return {{"wall_s", times.wall_s}, {"cpu_s", times.cpu_s}};
}

Json reference_json(const Summary& s) {
  const ReferenceRatios ratios = reference_ratios(s);
  return {
      {"arith", times_json(s.reference.arith)},
      {"stream", times_json(s.reference.stream)},
      {"pair", times_json(s.reference.pair)},
      {"ratio",
       {{"cpu", ratios.cpu}, {"frame_p50", ratios.frame_p50}, {"frame_p99", ratios.frame_p99}}}};
}

Json picture_json(const Summary& s) {
  const Verdict verdict = judge_quality(s);
  return {{"grade", name_of(verdict.grade)},
          {"headline", verdict.headline},
          {"reasons", verdict.reasons},
          {"advice", verdict.advice}};
}

Json run_json(const Summary& s) {
  Json apart = Json::object();
  for (std::size_t kind = 1; kind < kApartKinds; ++kind)
    apart[std::string(name_of(static_cast<Apart>(kind)))] = s.run.apart_frames[kind];
  return {{"path", s.run.path.empty() ? MeasuredText::missing("the run had no path")
                                      : MeasuredText(s.run.path)},
          {"paradigm", s.run.paradigm},
          {"policy", s.run.policy},
          {"preset", s.run.preset},
          {"modelers", s.run.modelers},
          {"width", s.run.width},
          {"height", s.run.height},
          {"frames", s.run.frames},
          {"seconds", Figure(s.run.seconds)},
          {"lod", s.run.lod},
          {"fixed_step", s.run.fixed_step},
          {"warmup_seconds", Figure(s.run.warmup_seconds)},
          {"measured_frames", s.run.measured_frames},
          {"timed_frames", s.run.timed_frames},
          {"apart_frames", apart},
          {"real_seconds", s.run.real_seconds},
          {"error_pixels", s.run.error_pixels},
          {"target_fps", s.run.target_fps}};
}

Json systems_json(const std::vector<SystemTimes>& systems) {
  Json result = Json::object();
  for (const SystemTimes& system : systems)
    result[system.name] = Spread{system.p50, system.p99};
  return result;
}

Json wait_json(const Summary& s) {
  Json result = s.wait_ms.all;
  result["device"] = s.wait_ms.device;
  result["acquire"] = s.wait_ms.acquire;
  result["present"] = s.wait_ms.present;
  return result;
}

Json detail_json(const Summary& s) {
  const auto& d = s.detail;
  return {{"asked_pixels", s.run.error_pixels},
          {"p50_pixels", d.p50_pixels},
          {"max_pixels", d.max_pixels},
          {"resolution_p50", d.resolution_p50},
          {"resolution_min", d.resolution_min},
          {"raised_by_memory_frames", d.raised_by_memory},
          {"raised_for_target_frames", d.raised_for_target},
          {"refused_frames", d.refused_frames}};
}

Json missing_json(const Summary& s) {
  const auto& m = s.missing;
  const auto& wait = m.time_to_visible_ms;
  return {{"frames", m.frames},
          {"nodes_p99", m.nodes_p99},
          {"pixels_p99_percent", m.pixels_p99_percent},
          {"pixels_max_percent", m.pixels_max_percent},
          {"coarse_p99_percent", m.coarse_p99_percent},
          {"coarse_max_percent", m.coarse_max_percent},
          {"coarse_frames", m.coarse_frames},
          {"coarse_seconds", m.coarse_seconds},
          {"time_to_visible_ms", {{"p50", wait.p50}, {"p99", wait.p99}, {"max", wait.max}}}};
}

Json cache_json(const Summary& s) {
  return {{"budget_bytes", s.cache.budget_bytes},
          {"peak_bytes", s.cache.peak_bytes},
          {"hits", s.cache.hits},
          {"misses", s.cache.misses},
          {"evictions", s.cache.evictions},
          {"regenerations", s.cache.regenerations},
          {"prefetch_hit_percent", s.cache.prefetch_hit_percent}};
}

Json synthesis_json(const Summary& s) {
  const auto& synthesis = s.synthesis;
  const auto& error = synthesis.cost_error_percent;
  return {{"models", synthesis.models},
          {"triangles", synthesis.triangles},
          {"bytes", synthesis.bytes},
          {"failed", synthesis.failed},
          {"seconds", synthesis.seconds},
          {"busy_percent", synthesis.busy_percent},
          {"coarse_busy_percent", synthesis.coarse_busy_percent},
          {"share_drawn", synthesis.share_drawn},
          {"triangles_per_second", synthesis.triangles_per_second},
          {"cost_error_percent", {{"p50", error.p50}, {"p95", error.p95}}}};
}

Json frame_ms_json(const FrameTimes& t) {
  return {{"mean", t.mean}, {"p50", t.p50},   {"p95", t.p95},
          {"p99", t.p99},   {"p999", t.p999}, {"max", t.max}};
}

Json distribution_json(const Distribution& d) {
  return {{"mean", d.mean}, {"p50", d.p50}, {"p95", d.p95}, {"p99", d.p99}, {"max", d.max}};
}

Json passes_json(const std::vector<PassTimes>& passes) {
  Json result = Json::object();
  for (const PassTimes& pass : passes)
    result[pass.name] = {{"p50", pass.p50}, {"p99", pass.p99}, {"max", pass.max}};
  return result;
}

Json gpu_json(const Summary& s) {
  return {{"p50", s.gpu_ms.p50},
          {"p99", s.gpu_ms.p99},
          {"max", s.gpu_ms.max},
          {"shadows_p50", s.gpu_ms.shadows_p50}};
}

Json figures_json(const std::vector<OwnFigureTimes>& figures) {
  Json result = Json::object();
  for (const OwnFigureTimes& each : figures)
    result[each.info.name] = {{"unit", each.info.unit}, {"kind", name_of(each.info.kind)},
                              {"frames", each.frames},  {"invalid", each.invalid},
                              {"mean", each.mean},      {"min", each.min},
                              {"p50", each.p50},        {"p95", each.p95},
                              {"p99", each.p99},        {"max", each.max}};
  return result;
}

Json marks_json(const std::vector<MarkFacts>& marks) {
  Json result = Json::object();
  for (const MarkFacts& mark : marks)
    result[mark.name] = {
        {"count", mark.count}, {"frame", mark.frame}, {"time_s", Figure(mark.time_s)}};
  return result;
}

// Replaces the reason of each missing number.
void set_reasons(Json& json, const std::string& reason) {
  if (!json.is_object()) return;
  if (json.contains(kReason)) json[kReason] = reason;
  for (auto& [key, value] : json.items())
    if (key != kReason) set_reasons(value, reason);
}

// The times that a flight and each of its sections have.
Json times_json(const Summary& s) {
  return {{"frame_ms", frame_ms_json(s.frame_ms)},
          {"low1_fps", s.low1_fps},
          {"low01_fps", s.low01_fps},
          {"hitches", s.hitches},
          {"stutter_percent", s.stutter_percent},
          {"between_presents_ms", distribution_json(s.between_presents_ms)},
          {"animation_error_ms", distribution_json(s.animation_error_ms)},
          {"system_ms", systems_json(s.system_ms)},
          {"wait_ms", wait_json(s)},
          {"record_ms", s.record_ms},
          {"gpu_ms", gpu_json(s)},
          {"pass_ms", passes_json(s.pass_ms)}};
}

Json section_json(const Section& section) {
  const Summary& s = section.frames;
  Json json = {
      {"from", section.range.from},
      {"to", section.range.to},
      {"start_s", section.start_s},
      {"end_s", section.end_s},
      {"measured_frames", Count(s.run.measured_frames)},
      {"timed_frames", Count(s.run.timed_frames)},
  };
  json.update(times_json(s));
  json.update(
      {{"missing", missing_json(s)},
       {"draw", {{"triangles_p50", s.draw.triangles_p50}, {"draws_p50", s.draw.draws_p50}}},
       {"synthesis", {{"models", s.synthesis.models}, {"triangles", s.synthesis.triangles}}},
       {"figures", figures_json(s.figures)}});
  if (section.missing.empty()) return json;
  json["measured_frames"] = json["timed_frames"] = Count();
  set_reasons(json, section.missing);
  return json;
}

Json sections_json(const std::vector<Section>& sections) {
  Json result = Json::object();
  for (const Section& section : sections)
    result[section.range.name] = section_json(section);
  return result;
}

void flatten(const Json& json, const std::string& name, std::vector<SummaryField>& fields) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      flatten(value, name.empty() ? key : name + "." + key, fields);
    return;
  }
  if (json.is_array()) return;
  SummaryField field{name, {}, {}};
  if (json.is_number()) field.value = json.get<double>();
  if (json.is_string()) field.value = json.get<std::string>();
  if (json.is_boolean()) field.value = std::string(json.get<bool>() ? "true" : "false");
  fields.push_back(std::move(field));
}

std::vector<SummaryField> fields_of(Json json) {
  const Json reasons = json.value("reasons", Json::object());
  json.erase("reasons");
  std::vector<SummaryField> fields;
  flatten(json, "", fields);
  for (SummaryField& field : fields)
    if (reasons.contains(field.name) && reasons[field.name].is_string())
      field.reason = reasons[field.name].get<std::string>();
  return fields;
}

}  // namespace

std::string to_json(const Summary& s) {
  Json json = {
      {"schema", kSummarySchema},
      {"world", world_json(s.world)},
      {"device", {{"name", s.device.name}, {"driver", s.device.driver}, {"api", s.device.api}}},
      {"machine", machine_json(s.machine)},
      {"build", build_json(s.build)},
      {"load", load_json(s.load)},
      {"reference", reference_json(s)},
      {"run", run_json(s)},
  };
  json.update(times_json(s));
  json.update({{"picture", picture_json(s)},
               {"detail", detail_json(s)},
               {"missing", missing_json(s)},
               {"cache", cache_json(s)},
               {"synthesis", synthesis_json(s)},
               {"draw",
                {{"triangles_p50", s.draw.triangles_p50},
                 {"draws_p50", s.draw.draws_p50},
                 {"floor_ratio", s.draw.floor_ratio}}},
               {"memory",
                {{"peak_rss_bytes", s.memory.peak_rss_bytes},
                 {"device_peak_bytes", s.memory.device_peak_bytes}}},
               {"hash",
                {{"world", hash_text(s.hash.world)},
                 {"types", hash_text(s.hash.types)},
                 {"path", hash_text(s.hash.path)},
                 {"images", hash_text(s.hash.images)}}},
               {"figures", figures_json(s.figures)},
               {"marks", marks_json(s.marks)},
               {"ignored_marks", s.ignored_marks},
               {"sections", sections_json(s.sections)}});
  Json reasons = Json::object();
  take_reasons(json, "", reasons);
  json["reasons"] = reasons;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<SummaryField> summary_fields(const Summary& summary) {
  return fields_of(Json::parse(to_json(summary)));
}

core::Result<std::vector<SummaryField>> summary_fields_in(std::string_view text,
                                                          const std::string& file) {
  Json json = Json::parse(text, nullptr, false);
  const auto refuse = [&file](std::string_view sentence) {
    return core::fail(core::ErrorCode::kParse, fmt::format("{}: {}", file, sentence));
  };
  if (!json.is_object()) return refuse("it is not JSON, or is truncated");
  if (json.value("schema", Json()) != kSummarySchema)
    return refuse(fmt::format("schema: it must be \"{}\"", kSummarySchema));
  return fields_of(std::move(json));
}

}  // namespace psygen::telemetry
