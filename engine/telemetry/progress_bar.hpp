// A progress bar on a terminal: one line that is rewritten at most ten times a second and shows the
// time left. Writes nothing when the output is not a terminal, which keeps logs and pipes clean.
// Not a log. One thread.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace psygen::telemetry {

// Where the bar is drawn. `write` is called only when `interactive`.
struct Terminal {
  bool interactive = false;
  int columns = 80;  // width in characters
  std::function<void(std::string_view)> write;
};

// Standard error; interactive when it is a terminal that understands carriage returns.
Terminal stderr_terminal();

// The bar of one task. The clock starts at the first update.
class ProgressBar {
 public:
  // `total` is in any unit, e.g. frames or blocks; at 0 or less only the label and the time are
  // shown.
  ProgressBar(Terminal terminal, std::string label, double total);
  // Finishes.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Draws `done` of `total`. `now_s` is core::monotonic_seconds() (the default) or a test's clock.
  void update(double done, double now_s);
  void update(double done);
  // Removes the line; updates have no effect from then on. A second call does nothing.
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
