#include "engine/cli/amplify_stats.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/telemetry/units.hpp"

namespace psygen::cli {
std::string text_of(const AmplifyStats& figures) {
  const amplify::Report& r = figures.report;
  const amplify::Totals& t = r.totals;
  std::string text;
  const auto row = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("{:<31} {}\n", name, value);
  };
  if (!figures.part.empty()) row("part", figures.part);
  if (figures.parts > 0) row("parts", fmt::format("{}", figures.parts));
  row("blocks", fmt::format("{}", t.blocks));
  row("models", fmt::format("{}", t.models));
  row("triangles", fmt::format("{}  ({})", t.triangles,
                               telemetry::count_text(static_cast<double>(t.triangles))));
  row("bytes",
      fmt::format("{}  ({})", t.bytes, telemetry::size_text(static_cast<double>(t.bytes))));
  if (r.threads > 0) {
    const double rate = r.triangles_per_second_per_core();
    row("seconds", fmt::format("{:.3f}", r.seconds));
    row("cpu_seconds", fmt::format("{:.3f}  (threads: {})", r.cpu_seconds, r.threads));
    row("triangles_per_second_per_core",
        fmt::format("{:.0f}  ({})", rate, telemetry::count_text(rate)));
  }
  if (figures.ranks > 0)
    row("ranks", fmt::format("{}  (messages: {})", figures.ranks, figures.messages));
  row("hash", r.complete ? fmt::format("{:016x}", t.hash.value())
                         : std::string("– (the region is incomplete)"));
  if (figures.files)
    row("files",
        fmt::format("{} written, {} existed", figures.files->written, figures.files->skipped));
  return text;
}

std::string json_of(const AmplifyStats& figures) {
  const amplify::Report& r = figures.report;
  const amplify::Totals& t = r.totals;
  nlohmann::ordered_json json;
  if (!figures.part.empty()) json["part"] = figures.part;
  if (figures.parts > 0) json["parts"] = figures.parts;
  json["blocks"] = t.blocks;
  json["models"] = t.models;
  json["triangles"] = t.triangles;
  json["bytes"] = t.bytes;
  if (r.threads > 0) {
    json["seconds"] = r.seconds;
    json["cpu_seconds"] = r.cpu_seconds;
    json["threads"] = r.threads;
    json["triangles_per_second_per_core"] = r.triangles_per_second_per_core();
  }
  if (figures.ranks > 0) {
    json["ranks"] = figures.ranks;
    json["messages"] = figures.messages;
  }
  json["complete"] = r.complete;
  json["failed"] = t.failed;
  json["hash"] = nullptr;
  if (r.complete) json["hash"] = fmt::format("{:016x}", t.hash.value());
  if (figures.files) {
    json["files_written"] = figures.files->written;
    json["files_skipped"] = figures.files->skipped;
  }
  return json.dump(2) + "\n";
}

}  // namespace psygen::cli
