// The readers of the formats, which capture.cpp chooses from. Private. Each takes a whole text that
// it recognises and returns its frame times with the counts of left-out rows; errors are those of
// read(). Linear in the text.
#pragma once

#include <cstddef>
#include <string>

#include "engine/captures/capture.hpp"
#include "engine/captures/table.hpp"

namespace psygen::captures {

// A capture before its counts become notes.
struct Collected {
  Capture capture;
  std::size_t not_drawn = 0, generated = 0;
  std::size_t unmeasured = 0;  // rows without a time, or with 0
  bool cut = false;            // the last line is cut

  // Adds a frame; a time that is not above 0 counts as unmeasured.
  void add(double ms) {
    if (ms > 0) {
      capture.frame_ms.push_back(ms);
    } else {
      ++unmeasured;
    }
  }
};
using Reading = core::Result<Collected>;

// True if a header has a time column of PresentMon, OCAT, CapFrameX or FrameView.
bool is_present_mon(const Table& table);
// PresentMon's family. `from_cap_frame_x`: CapFrameX's preamble precedes the header.
Reading read_present_mon(const Source& source, const Table& table, bool from_cap_frame_x);

// MangoHud and mangoapp: the header of the frames has `fps`. `version` is empty if unknown. Refuses
// rates and sampled logs.
Reading read_mango_hud(const Source& source, const Table& table, std::string_view version);

// True for a table of Unreal's CSV profiler: by its header, or by the metadata in its last line.
bool is_unreal(const Source& source, const Table& table);
Reading read_unreal(const Source& source);

// The export of frame times of Unity's Profile Analyzer: a header with `Frame Time (ms)`.
Reading read_profile_analyzer(const Source& source, const Table& table);

// JSON: CapFrameX, Unity Performance Testing, traces of Chrome.
Reading read_json(const Source& source);
// The results of Unity Performance Testing in the output of NUnit (XML): lines with this mark.
inline constexpr std::string_view kUnityMark = "##performancetestresult2:";
Reading read_unity_lines(const Source& source);

}  // namespace psygen::captures
