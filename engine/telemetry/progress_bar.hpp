// A progress bar on a terminal: one line that is rewritten at most ten times a second and shows the
// remaining time. Writes nothing if the output is not a terminal, which keeps logs and pipes clean.
// Not a log. One thread.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace psygen::telemetry {

// The terminal of a bar. `write` is called only if `interactive`.
struct Terminal {
  bool interactive = false;
  int columns = 80;  // width in characters
  std::function<void(std::string_view)> write;
};

// Standard error; interactive if it is a terminal that supports carriage returns.
Terminal stderr_terminal();

// Progress bar of one task. The clock starts at the first update.
class ProgressBar {
 public:
  // `total` has any unit, such as frames or blocks; at 0 or less, the bar shows only the label and
  // the time.
  ProgressBar(Terminal terminal, std::string label, double total);
  // Calls finish().
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Draws `done` of `total`. `now_s` is core::monotonic_seconds() (the default) or a test's clock.
  void update(double done, double now_s);
  void update(double done);
  // Removes the line; later updates have no effect. A second call does nothing.
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
