// Marks of a run, such as "spawn" or "boss", and the sections between them. A game sets a mark when
// something begins, so that budgets can hold for a part of a flight. A mark belongs to the frame in
// which it is set. One thread, or systems by the rules of a schedule.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::telemetry {

inline constexpr std::size_t kMaxMarks = 4096;  // of a run

// The marks that a game sets: a resource of its systems.
class Marks {
 public:
  // Sets a mark in this frame. Ignores and counts names that is_own_name() (own_figures.hpp)
  // refuses, "end", which is the end of a run, and marks beyond kMaxMarks.
  void set(std::string_view name);
  // Returns the marks since the last call, in order.
  std::vector<std::string> take();
  // Number of ignored marks.
  std::uint64_t ignored() const { return ignored_; }

 private:
  std::vector<std::string> pending_;
  std::uint64_t set_ = 0, ignored_ = 0;
};

// The end of a run, as a section's `to`.
inline constexpr std::string_view kEndOfRun = "end";
inline constexpr std::size_t kMaxSections = 32;

// A part of a run: from the first frame with the mark `from` to the frame before the first mark
// `to` after it, or to the end of the run.
struct SectionRange {
  std::string name, from;
  std::string to{kEndOfRun};
};

// A mark in a log of frames.
struct FrameMark {
  std::size_t row = 0;  // in FrameLog::frames()
  std::string name;
};

}  // namespace psygen::telemetry
