#include "engine/captures/capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "engine/captures/readers.hpp"
#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::captures {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kMaxBytes = std::size_t{1} << 30;  // of a file; over 10⁶ rows

// Decodes UTF-16 after its byte-order mark; an odd last byte is cut.
std::string utf8_of(std::string_view bytes, bool little_endian) {
  const auto unit_at = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]),
               second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<char32_t>(little_endian ? first | second << 8 : first << 8 | second);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    char32_t value = unit_at(at);
    const char32_t next = at + 3 < bytes.size() ? unit_at(at + 2) : 0;
    if (value >= 0xd800 && value < 0xdc00 && next >= 0xdc00 && next < 0xe000) {
      value = 0x10000 + ((value - 0xd800) << 10) + (next - 0xdc00);
      at += 2;
    }
    core::append_utf8(text, value);
  }
  return text;
}

// Forms that are no text, and the sentence for each.
Reading refuse_binary(const Source& source) {
  const std::string_view bytes = source.text;
  if (bytes.starts_with("\x1f\x8b"))
    return refused(source,
                   "the file is compressed (gzip): unpack it; Unreal writes plain CSV with "
                   "-csvCompression=0");
  if (bytes.starts_with("\x06"
                        "CSVBIN"))
    return refused(source,
                   "the binary form of Unreal's CSV profiler is not read; convert it to "
                   "the text form (.csv) with CsvConvert -outFormat=csv");
  const bool is_unity =
      bytes.size() >= 12 && bytes[0] >= 1 && bytes[0] <= 7 && bytes.substr(1, 3) == "\0\0\0"sv;
  if (is_unity)
    return refused(source,
                   "the binary data of Unity's Profile Analyzer (.pdata) are not read; "
                   "export the frame times as CSV");
  return refused(source, "the file is binary, and no capture as text; export it as CSV");
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

// Logs without frame times, recognised by their texts.
core::Result<void> check_logs(const Source& source, std::string_view first_line) {
  const std::string_view text = source.text;
  if (contains(first_line, "Hardware monitoring log") || first_line.starts_with("02, ") ||
      first_line.starts_with("80, "))
    return refused(source,
                   "MSI Afterburner samples one frame at each poll, so its log has no "
                   "frame times; capture with PresentMon or CapFrameX");
  if (first_line.starts_with("fps=") || first_line.starts_with("focus="))
    return refused(source,
                   "gamescope writes a rate every 300 frames, no frame times; log with "
                   "mangoapp");
  if (contains(text, "glmark2 20") || (contains(text, " FPS: ") && contains(text, " FrameTime: ")))
    return refused(source, "glmark2 writes means of scenes, no frames; capture with MangoHud");
  constexpr std::array<std::string_view, 5> kGodot = {
      " mspf)", "Project FPS: ", "Game FPS: ", "Editor FPS: ", "\nFPS: "};
  if (first_line.starts_with("FPS: ") ||
      std::ranges::any_of(kGodot, [&](std::string_view mark) { return contains(text, mark); }))
    return refused(source,
                   "Godot prints a rate each second, no frame times; capture with "
                   "PresentMon or MangoHud");
  return {};
}

// Tables without frame times, recognised by their headers.
core::Result<void> check_summaries(const Source& source, const Table& table) {
  const auto has_part = [&](std::string_view part) {
    return std::ranges::any_of(table.header, [&](std::string_view cell) {
      const auto is_same = [](char c, char wanted) {
        return std::tolower(static_cast<unsigned char>(c)) == wanted;
      };
      return std::search(cell.begin(), cell.end(), part.begin(), part.end(), is_same) != cell.end();
    });
  };
  if (table.find("0.1% Min FPS"))
    return refused(source, "a summary of MangoHud, no frames; give the log beside it");
  if (table.find("Total Frames") && table.find("Average FPS"))
    return refused(source,
                   "a summary of PresentMon's capture application, no frames; give the "
                   "file without -stats");
  if (table.find("File") && table.find("Compositor"))
    return refused(source, "a summary of OCAT, no frames; give the capture of the game");
  if (table.find("frame_ms"))
    return refused(source, "these are psygen's own frames; give the folder of the run");
  if (has_part("median"))
    return refused(source,
                   "the table has no frames; export the frame times of the Profile "
                   "Analyzer, not its markers");
  if (has_part("avg") || has_part("average"))
    return refused(source, "a summary, no frames; give the log of the frames");
  return {};
}

// MangoHud's log: lines about the system, then the header of the frames.
Reading read_mango_hud_below(const Source& source, Line line, std::string_view rest) {
  constexpr std::size_t kMaxLines = 16;
  std::string_view version;
  do {
    if (auto ok = check_length(source, line); !ok) return tl::unexpected(ok.error());
    if (line.number == 2 && line.text.starts_with('v')) version = trimmed(line.text.substr(1));
    const Table table = table_at(line, rest);
    if (table.find("fps")) return read_mango_hud(source, table, version);
  } while (line.number < kMaxLines && next_line(rest, line));
  return refused(source,
                 "the log has rates, no frame times; log with log_interval=0 and a version "
                 "of MangoHud from 0.6 on");
}

Reading read_table(const Source& source) {
  std::string_view rest = source.text;
  bool from_cap_frame_x = false;
  for (Line line; next_line(rest, line);) {
    if (line.text.size() > kMaxLineBytes && contains(source.text, kUnityMark))
      return read_unity_lines(source);
    if (auto ok = check_length(source, line); !ok) return tl::unexpected(ok.error());
    const std::string_view text = trimmed(line.text);
    if (text.starts_with("//") || text.starts_with("\"//")) {
      from_cap_frame_x = true;
      continue;
    }
    if (text.empty() || text.starts_with("sep=")) continue;
    const Table table = table_at(line, rest);
    if (text == "v1" || table.find("fps") || (table.find("os") == 0U && table.find("gpu")))
      return read_mango_hud_below(source, line, rest);
    if (table.find("Frame Time (ms)")) return read_profile_analyzer(source, table);
    if (is_unreal(source, table)) return read_unreal(source);
    if (is_present_mon(table)) return read_present_mon(source, table, from_cap_frame_x);
    if (auto ok = check_summaries(source, table); !ok) return tl::unexpected(ok.error());
    if (auto ok = check_logs(source, text); !ok) return tl::unexpected(ok.error());
    if (contains(source.text, kUnityMark)) return read_unity_lines(source);
    return refused(source,
                   "the file is no capture that psygen reads: PresentMon, OCAT, CapFrameX, "
                   "FrameView, MangoHud, Unreal, Unity, Chrome trace");
  }
  return refused(source, "the file is empty");
}

Reading read_text(const Source& source) {
  constexpr std::size_t kBeginning = 4096;
  const std::string_view text = source.text;
  if (contains(text.substr(0, kBeginning), "\0"sv) || text.starts_with("\x1f\x8b"))
    return refuse_binary(source);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const std::size_t second =
      first == std::string_view::npos ? first : text.find_first_not_of(" \t\r\n", first + 1);
  const char opens = first == std::string_view::npos ? '\0' : text[first],
             next = second == std::string_view::npos ? '\0' : text[second];
  if (opens == '{' || (opens == '[' && (next == '{' || next == ']'))) return read_json(source);
  return read_table(source);
}

// Leaves out suspended frames and writes the counts as notes.
core::Result<Capture> finished(Collected collected, const Source& source) {
  Capture capture = std::move(collected.capture);
  capture.name = source.name;
  const double limit_ms = suspended_limit_ms(capture.frame_ms);
  const std::size_t suspended =
      std::erase_if(capture.frame_ms, [&](double ms) { return ms > limit_ms; });
  const std::array<std::pair<std::string_view, std::size_t>, 4> counts = {
      {{"frames that were not displayed", collected.not_drawn},
       {"generated frames", collected.generated},
       {"rows without a time", collected.unmeasured},
       {"suspended frames (over 5 s and 20 times the median)", suspended}}};
  for (const auto& [what, count] : counts)
    if (count > 0) capture.notes.push_back(fmt::format("left out: {}: {}", what, count));
  if (collected.cut) capture.notes.emplace_back("left out: the cut last row");
  if (capture.frame_ms.empty())
    return refused(source, capture.notes.empty()
                               ? std::string("the capture has no frames")
                               : "the capture has no frames; " + capture.notes.back());
  return capture;
}

}  // namespace

std::string_view phrase_of(Meaning meaning) {
  constexpr std::array<std::string_view, 4> kPhrases = {
      "present to present", "start to start", "time on the screen", "the game thread's frame"};
  return kPhrases[static_cast<std::size_t>(meaning)];
}

double suspended_limit_ms(std::span<const double> frame_ms) {
  constexpr double kSuspendedMs = 5000, kSuspendedRatio = 20;
  if (frame_ms.empty()) return kSuspendedMs;
  std::vector<double> sorted(frame_ms.begin(), frame_ms.end());
  const auto median = sorted.begin() + std::ssize(sorted) / 2;
  std::ranges::nth_element(sorted, median);
  return std::max(kSuspendedMs, kSuspendedRatio * *median);
}

core::Result<Capture> parse(std::string_view bytes, const std::string& name) {
  std::string decoded;
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
    if (bytes.size() > kMaxBytes)
      return core::fail(core::ErrorCode::kOverBudget,
                        fmt::format("{}: UTF-16 of at most {} bytes is read", name, kMaxBytes));
    decoded = utf8_of(bytes, bytes.starts_with("\xff\xfe"));
    bytes = decoded;
  }
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const Source source{bytes, name};
  auto collected = read_text(source);
  if (!collected) return tl::unexpected(collected.error());
  return finished(std::move(*collected), source);
}

core::Result<Capture> read(const std::filesystem::path& file) {
  const auto bytes = core::read_file(file, kMaxBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.string());
}

}  // namespace psygen::captures
