// Tables of engines: Unreal's CSV profiler, and Unity's Profile Analyzer.
#include <fmt/format.h>

#include <algorithm>

#include "engine/captures/readers.hpp"

namespace psygen::captures {
namespace {

using Cells = std::vector<std::string_view>;

// Removes the last line and returns it. Blank lines at the end are removed as well.
std::string_view take_last_line(std::string_view& text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r'))
    text.remove_suffix(1);
  const std::size_t end = text.rfind('\n');
  const std::size_t start = end == std::string_view::npos ? 0 : end + 1;
  const std::string_view line = text.substr(start);
  text = text.substr(0, start);
  return line;
}

bool is_metadata(std::string_view line) {
  return line.starts_with('[') || line.starts_with("\"[");
}

// The metadata are pairs of a name in brackets and a value.
bool has_header_at_end(std::string_view metadata) {
  if (metadata.size() > kMaxLineBytes) return false;
  Cells cells;
  split(metadata, separator_of(metadata), cells);
  for (std::size_t i = 0; i + 1 < cells.size(); i += 2)
    if (same_name(cells[i], "[HasHeaderRowAtEnd]")) return cells[i + 1] == "1";
  return false;
}

// Reads the rows of Unreal's table. Columns are added during a capture, so rows grow. The first
// column holds events, whose commas shift the other cells.
class Unreal {
 public:
  explicit Unreal(const Source& source) : source_(source) {}

  Reading read() {
    std::string_view rest = source_.text;
    const bool finished = find_header(rest);
    result_.capture.tool = "Unreal CSV profiler";
    result_.capture.column = "FrameTime";
    result_.capture.meaning = Meaning::kGameThread;
    if (!finished) result_.capture.notes.emplace_back("the capture was cut: it has no metadata");
    if (times_.empty()) return refused(source_, "the table has no column FrameTime");

    Line line;
    while (next_line(rest, line)) {
      if (line.number == 1 && has_first_header_) continue;
      if (auto ok = add(line, rest.empty()); !ok) return tl::unexpected(ok.error());
    }
    if (auto ok = add_pending(std::max(width_, finished ? header_.size() : width_)); !ok)
      return tl::unexpected(ok.error());
    return std::move(result_);
  }

 private:
  // Finds the header, and removes a header and metadata at the end of `rows`. Returns true if the
  // file has metadata.
  bool find_header(std::string_view& rows) {
    std::string_view body = rows;
    const std::string_view metadata = take_last_line(body);
    const std::string_view first = source_.text.substr(0, source_.text.find('\n'));
    const bool finished = is_metadata(metadata);
    std::string_view header = first;
    const auto is_time = [](std::string_view cell) { return same_name(cell, "FrameTime"); };
    if (finished) {
      rows = body;
      if (has_header_at_end(metadata)) {
        header = take_last_line(body).substr(0, kMaxLineBytes);
        if (!body.empty()) rows = body;
      }
    }
    separator_ = separator_of(header);
    split(first, separator_, header_);
    has_first_header_ = std::ranges::any_of(header_, is_time);
    if (has_first_header_) width_ = header_.size();
    split(header, separator_, header_);
    for (std::size_t i = 0; i < header_.size(); ++i)
      if (is_time(header_[i])) times_.push_back(i);
    has_events_ = same_name(header_.front(), "EVENTS");
    most_ = finished ? header_.size() : std::string_view::npos;
    return finished;
  }

  core::Result<void> add(const Line& row, bool is_last) {
    if (auto ok = check_length(source_, row); !ok) return ok;
    if (trimmed(row.text).empty()) return {};
    split(row.text, separator_, cells_);
    if (cells_.size() < std::max(width_, times_.front() + 1)) {
      if (is_last && !row.ended) return result_.cut = true, core::Result<void>{};
      return damaged(source_, row.number,
                     fmt::format("the line has {} cells, but {} columns are known", cells_.size(),
                                 std::max(width_, times_.front() + 1)));
    }
    const bool is_event = has_events_ && !cells_.front().empty();
    if (is_event && cells_.size() > width_) return pending_.push_back(row), core::Result<void>{};
    if (cells_.size() > most_)
      return decimal_commas(source_, row.number, fmt::format("{} cells", cells_.size()), most_);
    if (!pending_.empty()) {
      if (auto ok = add_pending(cells_.size()); !ok) return ok;
      split(row.text, separator_, cells_);  // add_pending() uses the cells
    }
    width_ = cells_.size();
    return add_times(0, row.number);
  }

  // Adds the rows with commas in their events. They have at least the cells of the rows before, and
  // at most `most`. Of several readings, the one with the shortest event counts.
  core::Result<void> add_pending(std::size_t most) {
    for (const Line& row : pending_) {
      split(row.text, separator_, cells_);
      if (!row.ended) {  // a cut row may have any cells
        result_.cut = true;
        break;
      }
      const auto is_text = [this](std::string_view cell) {
        const Number number = number_in(cell, separator_);
        return !number.missing && !number.value;
      };
      const auto last_text = std::find_if(cells_.rbegin(), cells_.rend(), is_text);
      const auto texts = static_cast<std::size_t>(cells_.rend() - last_text);
      const std::size_t fewest = cells_.size() - std::min(cells_.size(), most);
      const std::size_t shift = std::max(fewest, std::max<std::size_t>(texts, 1) - 1);
      if (shift + std::max<std::size_t>(width_, 1) > cells_.size())
        return damaged(source_, row.number, "the cells after the event are not numbers");
      width_ = cells_.size() - shift;
      if (auto ok = add_times(shift, row.number); !ok) return ok;
    }
    pending_.clear();
    return {};
  }

  // A column may occur twice; the values add up.
  core::Result<void> add_times(std::size_t shift, std::size_t line) {
    const Table table{.header = {}, .separator = separator_, .rows = {}, .line = line};
    double sum = 0;
    for (const std::size_t column : times_) {
      if (column + shift >= cells_.size()) continue;  // added later in the capture
      const auto time = time_in(cells_[column + shift], table, source_, line);
      if (!time) return tl::unexpected(time.error());
      sum += time->value_or(0);
    }
    result_.add(sum);
    return {};
  }

  const Source& source_;
  Cells header_, cells_;
  std::vector<std::size_t> times_;  // columns
  std::vector<Line> pending_;  // rows whose events hold commas: their other cells are not known yet
  std::size_t width_ = 0;      // cells of the last row without commas in its event
  std::size_t most_ = 0;       // cells of the header
  char separator_ = ',';
  bool has_first_header_ = false, has_events_ = false;
  Collected result_;
};

}  // namespace

bool is_unreal(const Source& source, const Table& table) {
  if (table.find("FrameTime") && (table.find("GameThreadTime") || table.find("EVENTS")))
    return true;
  std::string_view text = source.text;
  const std::string_view last = take_last_line(text);
  return is_metadata(last) && has_header_at_end(last);
}

Reading read_unreal(const Source& source) {
  return Unreal(source).read();
}

Reading read_profile_analyzer(const Source& source, const Table& table) {
  const std::size_t all = table.header.size(), time = table.find("Frame Time (ms)").value_or(0);
  Collected result;
  const auto cut = for_each_row(source, table, {.fewest = all, .most = all, .max_of_first = all},
                                [&](const Cells& cells, std::size_t line) -> core::Result<void> {
                                  const auto ms = time_in(cells[time], table, source, line);
                                  if (!ms) return tl::unexpected(ms.error());
                                  result.add(ms->value_or(0));
                                  return {};
                                });
  if (!cut) return tl::unexpected(cut.error());
  result.cut = *cut;
  result.capture.tool = "Unity Profile Analyzer";
  result.capture.column = "Frame Time (ms)";
  result.capture.meaning = Meaning::kGameThread;
  return result;
}

}  // namespace psygen::captures
