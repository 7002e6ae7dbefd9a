#include "engine/telemetry/report.hpp"

#include <fmt/format.h>

#include "engine/core/replace_file.hpp"
#include "engine/telemetry/page_files.hpp"
#include "engine/telemetry/report_parts.hpp"

namespace psygen::telemetry {

std::string report_html(const FrameLog& log, const Summary& s) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">";
  html += "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">";
  html += fmt::format("<title>psygen: flight through {}</title>", escaped(s.world.name));
  html += fmt::format("<style>\n{}</style></head><body><main>\n", page_style());
  html += fmt::format(
      "<h1>Flight through {}</h1>\n<p class=\"lead\">{} frame{} in {} s at {} × {} on {}</p>\n",
      escaped(s.world.name), s.run.frames, s.run.frames == 1 ? "" : "s",
      three_digits(s.run.seconds), s.run.width, s.run.height, escaped(s.device.name));
  if (!s.run.command.empty())
    html += fmt::format("<p class=\"command\"><code>{}</code></p>\n", escaped(s.run.command));
  html += report_cards(s) + report_plots(log, s) + report_facts(s);
  html += "</main>";
  if (!log.frames().empty()) html += fmt::format("<script>{}</script>", page_script());
  html += "</body></html>\n";
  return html;
}

core::Result<void> write_report_html(const std::filesystem::path& path, const FrameLog& log,
                                     const Summary& summary) {
  return core::replace_file(path, report_html(log, summary));
}

}  // namespace psygen::telemetry
