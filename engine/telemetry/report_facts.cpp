// Tables of report.html.
#include <fmt/format.h>

#include <iterator>

#include "engine/telemetry/report_parts.hpp"

namespace psygen::telemetry {
namespace {

// A titled table of labels (plain text) and values (HTML).
class Facts {
 public:
  explicit Facts(std::string_view title)
      : html_(fmt::format("<section><h2>{}</h2><table>", escaped(title))) {}
  void add(std::string_view label, std::string_view html) {
    fmt::format_to(std::back_inserter(html_), "<tr><th>{}</th><td>{}</td></tr>", escaped(label),
                   html);
  }
  std::string end() { return std::move(html_) + "</table></section>\n"; }

 private:
  std::string html_;
};

std::string world_facts(const Summary& s) {
  Facts facts("World");
  facts.add("name", escaped(s.world.name));
  facts.add("seed", std::to_string(s.world.seed));
  facts.add("blocks", s.world.endless()
                          ? std::string("endless")
                          : fmt::format("{} × {}", s.world.blocks[0], s.world.blocks[1]));
  if (!s.world.endless()) {
    facts.add("triangles", shown(s.world.triangles, count_text));
    facts.add("size", shown(s.world.bytes, size_text));
    facts.add("paper's format", shown(s.world.bytes_paper, size_text));
  }
  if (s.world.block_m > 0) {
    facts.add("a block", fmt::format("{:g} m, {} models", s.world.block_m,
                                     three_digits(s.world.block_models)));
    facts.add("triangles per km²", count_text(s.world.per_km2(s.world.block_triangles)));
    facts.add("size per km²", size_text(s.world.per_km2(s.world.block_bytes)));
  }
  facts.add("hash",
            shown(s.hash.world, [&](double) { return fmt::format("{:016x}", *s.hash.world); }));
  return facts.end();
}

std::string run_facts(const Summary& s) {
  Facts facts("Run and device");
  if (!s.run.command.empty()) facts.add("command", "<code>" + escaped(s.run.command) + "</code>");
  facts.add("preset", escaped(s.run.preset));
  facts.add("view distance", s.run.view_distance_m > 0
                                 ? fmt::format("{:g} m", s.run.view_distance_m)
                                 : std::string("–"));
  facts.add("paradigm", escaped(s.run.paradigm));
  facts.add("policy", escaped(s.run.policy));
  facts.add("modelers", std::to_string(s.run.modelers));
  facts.add("picture", fmt::format("{} × {}", s.run.width, s.run.height));
  facts.add("levels of detail", s.run.lod ? "on" : "off");
  facts.add("fixed step",
            shown(s.run.fixed_step, [](double v) { return fmt::format("{:g} Hz", v); }));
  facts.add("requested error", fmt::format("{:g} pixels", s.run.error_pixels));
  facts.add("target frame rate",
            shown(s.run.target_fps, [](double v) { return fmt::format("{:g} frames/s", v); }));
  facts.add("length", fmt::format("{} frames, {} s", s.run.frames, three_digits(s.run.seconds)));
  facts.add("warm-up", fmt::format("{:g} s", s.run.warmup_seconds));
  facts.add("device", escaped(s.device.name));
  facts.add("driver", escaped(s.device.driver));
  facts.add("Vulkan", escaped(s.device.api));
  return facts.end();
}

std::string frame_facts(const Summary& s) {
  Facts facts("Frames");
  facts.add("mean", shown(s.frame_ms.mean, ms_text));
  facts.add("p50", shown(s.frame_ms.p50, ms_text));
  facts.add("p95", shown(s.frame_ms.p95, ms_text));
  facts.add("p99", shown(s.frame_ms.p99, ms_text));
  facts.add("p99.9", shown(s.frame_ms.p999, ms_text));
  facts.add("slowest", shown(s.frame_ms.max, ms_text));
  facts.add("lowest 1 %", shown(s.low1_fps, three_digits) + " frames/s");
  facts.add("timed", fmt::format("{} of {} frames", s.run.timed_frames, s.run.measured_frames));
  facts.add("triangles, median", shown(s.draw.triangles_p50, count_text));
  facts.add("draws, median", shown(s.draw.draws_p50, whole));
  facts.add("frame ÷ floor", shown(s.draw.floor_ratio, three_digits));
  return facts.end();
}

std::string system_facts(const Summary& s) {
  Facts facts("Parts of a frame, p50 and p99");
  const auto both = [](const Figure& p50, const Figure& p99) {
    return shown(p50, three_digits) + " / " + shown(p99, ms_text);
  };
  for (const SystemTimes& system : s.system_ms)
    facts.add(system.name, both(system.p50, system.p99));
  facts.add("render: recording", both(s.record_ms.p50, s.record_ms.p99));
  facts.add("waiting for the GPU", both(s.wait_ms.device.p50, s.wait_ms.device.p99));
  facts.add("waiting for the window", both(s.wait_ms.acquire.p50, s.wait_ms.acquire.p99));
  facts.add("… presenting", both(s.wait_ms.present.p50, s.wait_ms.present.p99));
  facts.add("GPU", both(s.gpu_ms.p50, s.gpu_ms.p99));
  facts.add("… shadows, p50", shown(s.gpu_ms.shadows_p50, ms_text));
  return facts.end();
}

std::string streaming_facts(const Summary& s) {
  Facts cache("Cache");
  cache.add("budget", bytes_text(static_cast<double>(s.cache.budget_bytes)));
  cache.add("peak", shown(s.cache.peak_bytes, bytes_text));
  cache.add("hits", shown(s.cache.hits, count_text));
  cache.add("misses", shown(s.cache.misses, count_text));
  cache.add("evictions", shown(s.cache.evictions, count_text));
  cache.add("regenerations", shown(s.cache.regenerations, count_text));
  cache.add("prefetched, then visible", shown(s.cache.prefetch_hit_percent, percent_text));
  Facts synthesis("Synthesis and missing geometry");
  synthesis.add("models", shown(s.synthesis.models, count_text));
  synthesis.add("triangles", shown(s.synthesis.triangles, count_text));
  synthesis.add("bytes", shown(s.synthesis.bytes, bytes_text));
  synthesis.add("failed", shown(s.synthesis.failed, whole));
  synthesis.add("busy time", shown(s.synthesis.seconds, three_digits) + " s");
  synthesis.add("modelers busy", shown(s.synthesis.busy_percent, percent_text));
  synthesis.add("cost error, p50", shown(s.synthesis.cost_error_percent.p50, percent_text));
  synthesis.add("cost error, p95", shown(s.synthesis.cost_error_percent.p95, percent_text));
  synthesis.add("missing nodes, p99", shown(s.missing.nodes_p99, whole));
  synthesis.add("too coarse, p99", shown(s.missing.coarse_p99_percent, percent_text));
  synthesis.add("missing pixels, worst", shown(s.missing.pixels_max_percent, percent_text));
  synthesis.add("time to visible, p50", shown(s.missing.time_to_visible_ms.p50, ms_text));
  return cache.end() + synthesis.end();
}

}  // namespace

std::string report_facts(const Summary& s) {
  return "<div class=\"facts\">\n" + frame_facts(s) + world_facts(s) + run_facts(s) +
         streaming_facts(s) + system_facts(s) + "</div>\n";
}

}  // namespace psygen::telemetry
