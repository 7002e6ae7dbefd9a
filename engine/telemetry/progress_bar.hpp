// A progress bar on a terminal: one line that is rewritten at most ten times a second, with the
// time that is left. Writes nothing when the output is not a terminal, so that logs and pipes stay
// clean. One thread.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace psygen::telemetry {

// Where the bar is drawn.
struct Terminal {
  bool interactive = false;
  int columns = 80;
  std::function<void(std::string_view)> write;
};

// Standard error; interactive when it is a terminal that understands carriage returns.
Terminal stderr_terminal();

class ProgressBar {
 public:
  // `total` in any unit, e.g. frames or blocks; at 0 or less only the label and the time are shown.
  ProgressBar(Terminal terminal, std::string label, double total);
  ~ProgressBar();  // finishes
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // `done` of `total` so far. `now_s` is core::monotonic_seconds() or a test's clock.
  void update(double done, double now_s);
  void update(double done);
  // Removes the line. Called twice, does nothing the second time.
  void finish();

 private:
  std::string line(double done, double now_s) const;

  Terminal terminal_;
  std::string label_;
  double total_;
  double start_s_ = -1;
  double last_drawn_s_ = -1;
  bool finished_ = false;
};

}  // namespace psygen::telemetry
