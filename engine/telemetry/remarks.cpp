#include "engine/telemetry/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/core/hash.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/telemetry/output_file.hpp"

namespace psygen::telemetry {
namespace {

using Json = nlohmann::ordered_json;

// Escapes of workflow commands: a message ends at the line's end, a property also at : and ,
std::string command_text(std::string_view text, bool property) {
  std::string escaped;
  for (const char c : text) {
    const bool special = c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ','));
    if (special)
      escaped += fmt::format("%{:02X}", static_cast<unsigned>(c));
    else
      escaped += c;
  }
  return escaped;
}

// The path from the current folder if the file is in it. Both services want paths from the root of
// the repository, where their jobs run.
std::string path_of(const Remark& remark) {
  if (remark.file.empty()) return {};
  std::error_code error;
  const std::filesystem::path here = std::filesystem::current_path(error);
  const std::filesystem::path file = remark.file.lexically_normal();
  if (error || !file.is_absolute()) return file.string();
  const std::filesystem::path relative = file.lexically_relative(here);
  const bool inside = !relative.empty() && *relative.begin() != "..";
  return (inside ? relative : file).string();
}

std::vector<Remark> by_level(std::span<const Remark> remarks) {
  std::vector<Remark> sorted(remarks.begin(), remarks.end());
  std::ranges::stable_sort(sorted, {}, &Remark::level);
  return sorted;
}

std::uint64_t hash_of(const std::string& text) {
  return core::hash_bytes(std::as_bytes(std::span(text)));
}

}  // namespace

std::string to_github(std::span<const Remark> remarks) {
  constexpr std::array<std::string_view, 3> kCommands{"error", "warning", "notice"};
  std::string text;
  for (const Remark& remark : by_level(remarks)) {
    std::string properties;
    const auto add = [&properties](std::string_view name, const std::string& value) {
      if (value.empty()) return;
      properties +=
          fmt::format("{}{}={}", properties.empty() ? " " : ",", name, command_text(value, true));
    };
    add("file", path_of(remark));
    if (remark.line > 0) add("line", std::to_string(remark.line));
    add("title", core::shown(remark.title));
    text += fmt::format("::{}{}::{}\n", kCommands[static_cast<std::size_t>(remark.level)],
                        properties, command_text(remark.message, false));
  }
  return text;
}

std::string to_gitlab(std::span<const Remark> remarks) {
  constexpr std::array<std::string_view, 3> kSeverities{"major", "minor", "info"};
  std::map<std::string, int> seen;  // a finding twice at one file needs two fingerprints
  Json json = Json::array();
  for (const Remark& remark : by_level(remarks)) {
    const std::string path = path_of(remark);
    const std::string key = remark.title + "\n" + path;
    const std::string fingerprint =
        fmt::format("{:016x}", hash_of(fmt::format("{}\n{}", key, seen[key]++)));
    json.push_back({{"description", remark.title + ": " + remark.message},
                    {"check_name", "psygen"},
                    {"fingerprint", fingerprint},
                    {"severity", kSeverities[static_cast<std::size_t>(remark.level)]},
                    {"location",
                     {{"path", path.empty() ? "psygen" : path},
                      {"lines", {{"begin", std::max(remark.line, 1)}}}}}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

core::Result<Annotations> annotations_from(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  Annotations where;
  if (name == "github") where.format = Annotations::Format::kGithub;
  if (name == "gitlab") where.format = Annotations::Format::kGitlab;
  if (where.format == Annotations::Format::kNone)
    return core::invalid_argument("it must be github, gitlab, or either with :FILE");
  if (colon != std::string_view::npos) where.file = text.substr(colon + 1);
  if (colon != std::string_view::npos && where.file.empty())
    return core::invalid_argument("the name of the file is missing after the colon");
  return where;
}

std::string to_text(const Annotations& where, std::span<const Remark> remarks) {
  switch (where.format) {
    case Annotations::Format::kGithub:
      return to_github(remarks);
    case Annotations::Format::kGitlab:
      return to_gitlab(remarks);
    default:
      return {};
  }
}

core::Result<void> PullRequestWords::check() const {
  for (const std::filesystem::path& file : {markdown, annotations.file}) {
    if (file.empty()) continue;
    if (auto ok = check_output_file(file); !ok) return ok;
  }
  return {};
}

core::Result<void> PullRequestWords::write(std::string_view text,
                                           std::span<const Remark> remarks) const {
  if (!markdown.empty()) {
    if (auto ok = core::replace_file(markdown, text); !ok) return ok;
  }
  if (annotations.file.empty()) return {};
  return core::replace_file(annotations.file, to_text(annotations, remarks));
}

std::string markdown_text(std::string_view text) {
  constexpr std::string_view kSpecial = "\\`*_[]<>~$|&!";
  constexpr std::string_view kZeroWidthSpace = "\xe2\x80\x8b";
  std::string line(text);
  std::ranges::replace(line, '\n', ' ');
  std::string escaped;
  for (const char c : core::shown(line)) {
    if (kSpecial.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
    if (c == '@' || c == '#') escaped += kZeroWidthSpace;
  }
  return escaped;
}

std::string markdown_table(const MarkdownRow& header, std::span<const MarkdownRow> rows) {
  std::string text = "\n";
  const auto add = [&text](const MarkdownRow& row) {
    for (const std::string& cell : row)
      text += "| " + markdown_text(cell) + " ";
    text += "|\n";
  };
  add(header);
  for (std::size_t i = 0; i < header.size(); ++i)
    text += "| --- ";
  text += "|\n";
  for (const MarkdownRow& row : rows)
    add(row);
  return text + "\n";
}

}  // namespace psygen::telemetry
