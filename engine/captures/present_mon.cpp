// PresentMon 1.x and 2.x, and the tools that write its columns: OCAT, CapFrameX, FrameView.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "engine/captures/readers.hpp"

namespace psygen::captures {
namespace {

using Cells = std::vector<std::string_view>;
using Column = std::optional<std::size_t>;

// The time columns in the order of preference. 2.0 has the sum of two.
struct TimeColumn {
  std::string_view name, added;
  Meaning meaning;
};
constexpr std::array<TimeColumn, 7> kTimeColumns = {{
    {"MsBetweenPresents", "", Meaning::kPresents},
    {"FrameTime", "", Meaning::kStarts},
    {"MsBetweenAppStart", "", Meaning::kStarts},
    {"CPUBusy", "CPUWait", Meaning::kStarts},
    {"MsBetweenAppPresents", "", Meaning::kPresents},  // OCAT with a headset
    {"MsBetweenDisplayChange", "", Meaning::kDisplayed},
    {"DisplayedTime", "", Meaning::kDisplayed},
}};

bool exists(const Table& table, const TimeColumn& time) {
  return table.find(time.name) && (time.added.empty() || table.find(time.added));
}

// Columns that have no value if the display did not take a frame. They count only if some frame of
// the swap chain has a value: the display may not be tracked at all.
constexpr std::array<std::string_view, 3> kDisplayColumns = {
    "DisplayedTime", "MsBetweenDisplayChange", "MsUntilDisplayed"};
constexpr std::uint8_t kDropped = 1 << 3, kGenerated = 1 << 4;  // after a bit for each of these

struct Frame {
  double ms;  // NaN: not measured
  std::uint8_t flags;
};

// The rows of one swap chain.
struct Chain {
  std::string application, process, address;
  std::vector<Frame> frames;
  std::uint8_t displayed = 0;  // display columns that have a value somewhere
  double sum_ms = 0, longest_ms = 0;
  double first = std::numeric_limits<double>::infinity(), last = -first;  // of the time column, ms
};

struct Columns {
  Column application, process, address, time, added, dropped, type, clock, events_lost;
  std::array<Column, kDisplayColumns.size()> displays;
  double clock_ms = 1;  // unit of the clock
};

Columns columns_of(const Table& table, const TimeColumn& time) {
  Columns c;
  c.application = table.find("Application");
  c.process = table.find("ProcessID");
  c.address = table.find("SwapChainAddress");
  c.time = table.find(time.name);
  if (!time.added.empty()) c.added = table.find(time.added);
  c.dropped = table.find_any({"Dropped", "AppMissed"});
  c.type = table.find("FrameType");
  c.events_lost = table.find("EtwEventsLost");
  c.clock = table.find("TimeInSeconds");
  if (c.clock) {
    c.clock_ms = 1000;
  } else {
    c.clock = table.find_any({"TimeInMs", "CPUStartTime"});
  }
  if (!c.dropped)
    std::ranges::transform(kDisplayColumns, c.displays.begin(),
                           [&](std::string_view name) { return table.find(name); });
  return c;
}

constexpr std::array<std::string_view, 11> kOcatSystem = {
    "Motherboard",    "OS",    "Processor", "System RAM",           "Base Driver Version",
    "Driver Package", "GPU #", "GPU",       "GPU Core Clock (MHz)", "GPU Memory Clock (MHz)",
    "GPU Memory (MB)"};

// OCAT writes its columns about the system into the first row only, and more with several GPUs.
Width width_of(const Table& table, const Columns& columns) {
  const std::size_t all = table.header.size();
  Width width{.fewest = all, .most = all, .max_of_first = all};
  if (!table.find("Motherboard")) return width;
  for (const std::string_view name : kOcatSystem)
    width.fewest = std::min(width.fewest, table.find(name).value_or(all));
  for (const Column& used : {columns.application, columns.process, columns.address, columns.time,
                             columns.dropped, columns.clock})
    if (used) width.fewest = std::max(width.fewest, *used + 1);
  width.max_of_first = std::numeric_limits<std::size_t>::max();
  return width;
}

std::string tool_of(const Table& table, bool from_cap_frame_x) {
  const auto has = [&](std::string_view name) { return table.find(name).has_value(); };
  if (from_cap_frame_x) return "CapFrameX";
  if (has("MsEstimatedDriverLag") || has("Motherboard") || has("MsBetweenAppPresents"))
    return "OCAT";
  if (has("GPU0Util(%)")) return "FrameView";
  if (has("MsBetweenAppStart")) return "PresentMon 2.3.1 or later";
  if (has("FrameTime")) return "PresentMon 2.1 to 2.3.0";
  if (has("CPUBusy")) return "PresentMon 2.0";
  // The small letters of 1.7 are the only difference.
  const bool small = std::ranges::find(table.header, "msBetweenPresents") != table.header.end();
  return small ? "PresentMon 1.7 to 1.10" : "PresentMon 1.0 to 1.6";
}

class PresentMon {
 public:
  PresentMon(const Source& source, const Table& table, const TimeColumn& time)
      : source_(source), table_(table), columns_(columns_of(table, time)) {}

  core::Result<void> read() {
    const auto cut =
        for_each_row(source_, table_, width_of(table_, columns_),
                     [this](const Cells& cells, std::size_t line) { return add(cells, line); });
    if (!cut) return tl::unexpected(cut.error());
    cut_ = *cut;
    return {};
  }

  bool measured() const { return measured_; }

  // The frames of the swap chain with the most rows; never of the desktop's compositor, dwm.exe.
  Reading chosen() const {
    const Chain* best = nullptr;
    for (const Chain& chain : chains_)
      if (!same_name(chain.application, "dwm.exe") &&
          (best == nullptr || chain.frames.size() > best->frames.size()))
        best = &chain;
    if (best == nullptr)
      return refused(source_, chains_.empty()
                                  ? "the capture has no rows"
                                  : "all rows are of dwm.exe, the desktop's compositor; capture "
                                    "the process of the game");
    Collected result;
    result.cut = cut_;
    for (const Frame& frame : best->frames) {
      if ((frame.flags & kGenerated) != 0) {
        ++result.generated;
      } else if ((frame.flags & (kDropped | best->displayed)) != 0) {
        ++result.not_drawn;
      } else {
        result.add(frame.ms);
      }
    }
    note_others(*best, result.capture.notes);
    note_span(*best, result.capture.notes);
    if (events_lost_ > 0)
      result.capture.notes.push_back(
          fmt::format("{:.0f} events were lost, so frames are missing", events_lost_));
    return result;
  }

 private:
  std::string_view cell(const Cells& cells, const Column& column) const {
    return column && *column < cells.size() ? cells[*column] : std::string_view();
  }

  core::Result<Chain*> chain_of(const Cells& cells) {
    constexpr std::size_t kMaxChains = 4096;
    const std::string_view application = cell(cells, columns_.application),
                           process = cell(cells, columns_.process),
                           address = cell(cells, columns_.address);
    if (last_ < chains_.size() && chains_[last_].application == application &&
        chains_[last_].process == process && chains_[last_].address == address)
      return &chains_[last_];
    const auto [entry, is_new] = index_.try_emplace(
        fmt::format("{}\n{}\n{}", application, process, address), chains_.size());
    if (is_new) {
      if (chains_.size() == kMaxChains)
        return refused(source_, fmt::format("the capture has over {} swap chains", kMaxChains));
      chains_.push_back({.application = std::string(application),
                         .process = std::string(process),
                         .address = std::string(address),
                         .frames = {}});
    }
    last_ = entry->second;
    return &chains_[last_];
  }

  core::Result<std::optional<double>> time_of(const Cells& cells, std::size_t line) {
    auto time = time_in(cell(cells, columns_.time), table_, source_, line);
    if (!time || !columns_.added) return time;
    const auto added = time_in(cell(cells, columns_.added), table_, source_, line);
    if (!added) return added;
    if (!*time && !*added) return std::nullopt;
    return time->value_or(0) + added->value_or(0);
  }

  std::uint8_t flags_of(const Cells& cells, Chain& chain) const {
    std::uint8_t flags = 0;
    const std::string_view dropped = cell(cells, columns_.dropped);
    if (number_in(dropped, table_.separator).value.value_or(0) != 0 || same_name(dropped, "true"))
      flags |= kDropped;
    const std::string_view type = cell(cells, columns_.type);
    if (!number_in(type, table_.separator).missing && !same_name(type, "Application"))
      flags |= kGenerated;
    for (std::size_t i = 0; i < columns_.displays.size(); ++i) {
      if (!columns_.displays[i]) continue;
      const auto bit = static_cast<std::uint8_t>(1U << i);
      const auto value = number_in(cell(cells, columns_.displays[i]), table_.separator).value;
      const bool displayed = value && (i != 0 || *value != 0);  // 2.0 writes a DisplayedTime of 0
      if (displayed) {
        chain.displayed |= bit;
      } else {
        flags |= bit;
      }
    }
    return flags;
  }

  core::Result<void> add(const Cells& cells, std::size_t line) {
    const auto chain = chain_of(cells);
    if (!chain) return tl::unexpected(chain.error());
    const auto time = time_of(cells, line);
    if (!time) return tl::unexpected(time.error());
    measured_ = measured_ || time->has_value();
    Chain& c = **chain;
    if (!c.frames.empty()) c.sum_ms += time->value_or(0);
    c.longest_ms = std::max(c.longest_ms, time->value_or(0));
    c.frames.push_back({.ms = time->value_or(std::numeric_limits<double>::quiet_NaN()),
                        .flags = flags_of(cells, c)});
    const auto at = number_in(cell(cells, columns_.clock), table_.separator).value;
    has_clock_ = has_clock_ && at;
    if (at) {
      c.first = std::min(c.first, *at * columns_.clock_ms);
      c.last = std::max(c.last, *at * columns_.clock_ms);
    }
    if (const auto lost = number_in(cell(cells, columns_.events_lost), table_.separator).value)
      events_lost_ = std::max(events_lost_, *lost);
    return {};
  }

  void note_others(const Chain& best, std::vector<std::string>& notes) const {
    constexpr std::size_t kMaxNamed = 8;
    std::size_t named = 0;
    for (const Chain& chain : chains_) {
      if (&chain == &best) continue;
      if (++named > kMaxNamed) continue;
      notes.push_back(fmt::format("left out: rows of {} (process {}), swap chain {}: {}",
                                  chain.application, chain.process, chain.address,
                                  chain.frames.size()));
    }
    if (named > kMaxNamed)
      notes.push_back(fmt::format("left out: rows of other swap chains, of which there are {}",
                                  named - kMaxNamed));
  }

  // The frames' times add up to the span of the clock.
  void note_span(const Chain& chain, std::vector<std::string>& notes) const {
    constexpr double kTolerance = 0.05;
    const double span_ms = chain.last - chain.first;
    if (!has_clock_ || chain.frames.size() < 2 ||
        std::abs(chain.sum_ms - span_ms) <= kTolerance * span_ms + chain.longest_ms)
      return;
    notes.push_back(fmt::format(
        "the times add up to {:.4g} s, but {} spans {:.4g} s: rows are missing, or the rows of "
        "several swap chains are mixed",
        chain.sum_ms / 1000, table_.header[*columns_.clock], span_ms / 1000));
  }

  const Source& source_;
  const Table& table_;
  Columns columns_;
  std::vector<Chain> chains_;
  std::unordered_map<std::string, std::size_t> index_;
  std::size_t last_ = 0;
  double events_lost_ = 0;
  bool measured_ = false, cut_ = false, has_clock_ = true;
};

}  // namespace

bool is_present_mon(const Table& table) {
  const bool is_named =
      table.find_any({"Application", "ProcessID", "SwapChainAddress"}).has_value();
  return std::ranges::any_of(kTimeColumns, [&](const TimeColumn& time) {
    return exists(table, time) && (is_named || time.name.starts_with("Ms"));
  });
}

// A column may be empty throughout, where the user chose the columns: then the next one counts.
Reading read_present_mon(const Source& source, const Table& table, bool from_cap_frame_x) {
  std::string_view unmeasured;
  for (const TimeColumn& time : kTimeColumns) {
    if (!exists(table, time)) continue;
    PresentMon reader(source, table, time);
    if (auto ok = reader.read(); !ok) return tl::unexpected(ok.error());
    const bool last = &time == &kTimeColumns.back() ||
                      std::none_of(&time + 1, kTimeColumns.data() + kTimeColumns.size(),
                                   [&](const TimeColumn& t) { return exists(table, t); });
    if (!reader.measured() && !last) {
      unmeasured = time.name;
      continue;
    }
    auto result = reader.chosen();
    if (!result) return result;
    Capture& capture = result->capture;
    capture.tool = tool_of(table, from_cap_frame_x);
    capture.column =
        time.added.empty() ? std::string(time.name) : fmt::format("{} + {}", time.name, time.added);
    capture.meaning = time.meaning;
    if (!unmeasured.empty())
      capture.notes.push_back(
          fmt::format("{} has no value throughout, so {} counts", unmeasured, capture.column));
    return result;
  }
  return refused(source, "no column of frame times");
}

}  // namespace psygen::captures
