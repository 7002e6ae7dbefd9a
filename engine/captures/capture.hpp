// Captures of other tools: logs with a time for each frame. Recognises the format by the content
// and reads the frame times (docs/frame-tests.md, "Captures of other tools"). Judges nothing, and
// copies no figure of a tool. Any thread; linear in the size of the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::captures {

// The interval that a time column measures. Times of different intervals are comparable only
// roughly.
enum class Meaning : std::uint8_t {
  kPresents,    // a present call to the next one of the swap chain
  kStarts,      // start of the CPU's work to the next start
  kDisplayed,   // time on the screen
  kGameThread,  // the game thread's frame, with its waits
};
std::string_view phrase_of(Meaning meaning);  // "present to present", …

struct Capture {
  std::string name;  // the file
  std::string tool;  // with its version as far as the columns tell it: "PresentMon 1.0 to 1.6"
  std::string column;
  Meaning meaning = Meaning::kPresents;
  std::vector<double> frame_ms;    // above 0, in the order of the file; not empty
  std::vector<std::string> notes;  // sentences: frames left out by reason, with their counts
};

// Reads a capture. Frames that were not displayed, generated frames, other swap chains, rows
// without a time, a cut last line, and suspended frames are left out and counted in `notes`. Fails
// with kIo; with kOverBudget for files of over 1 GiB; with kInvalidArgument for files without frame
// times (summaries, rates, sampled logs) and unknown formats, naming the setting that logs every
// frame if there is one; with kParse, naming the line, for damaged content.
core::Result<Capture> read(const std::filesystem::path& file);

// Reads a capture from its bytes; `name` is for messages, and tells mangoapp from MangoHud.
core::Result<Capture> parse(std::string_view bytes, const std::string& name);

// A longer frame counts as suspended: the machine slept or stalled. 5 s, or 20 times the median if
// that is more. O(N), copies the times.
double suspended_limit_ms(std::span<const double> frame_ms);

}  // namespace psygen::captures
