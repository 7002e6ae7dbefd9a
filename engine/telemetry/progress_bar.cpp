#include "engine/telemetry/progress_bar.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "engine/core/clock.hpp"

namespace psygen::telemetry {
namespace {

constexpr double kPauseSeconds = 0.1;
constexpr int kWidestBar = 30;
constexpr const char* kClearLine = "\r\x1B[K";

std::string duration(double seconds) {
  const auto s = static_cast<long long>(std::min(std::ceil(seconds), 359'999.0));
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

}  // namespace

Terminal stderr_terminal() {
  Terminal terminal;
  const char* kind = std::getenv("TERM");
  terminal.interactive =
      isatty(STDERR_FILENO) == 1 && (kind == nullptr || std::string_view(kind) != "dumb");
  winsize size{};
  if (terminal.interactive && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    terminal.columns = size.ws_col;
  }
  terminal.write = [](std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  };
  return terminal;
}

ProgressBar::ProgressBar(Terminal terminal, std::string label, double total)
    : terminal_(std::move(terminal)), label_(std::move(label)), total_(total) {}

ProgressBar::~ProgressBar() {
  finish();
}

std::string ProgressBar::line(double done, double now_s) const {
  const double elapsed = now_s - start_s_;
  if (!(total_ > 0)) return fmt::format("{}  {}", label_, duration(elapsed));
  const double share = std::isfinite(done) ? std::clamp(done / total_, 0.0, 1.0) : 0.0;
  std::string text = fmt::format(" {:3.0f} %", share * 100.0);
  if (share > 0.01 && elapsed > 0.5) {
    text += fmt::format("  {} left", duration(elapsed * (1.0 - share) / share));
  }
  const int room = terminal_.columns - static_cast<int>(label_.size() + text.size()) - 5;
  const int width = std::clamp(room, 0, kWidestBar);
  const int filled = static_cast<int>(share * width);
  const std::string bar =
      width < 5 ? "" : fmt::format(" [{:#<{}}{:.<{}}]", "", filled, "", width - filled);
  return label_ + bar + text;
}

void ProgressBar::update(double done, double now_s) {
  if (!terminal_.interactive || finished_) return;
  if (start_s_ < 0) start_s_ = now_s;
  if (last_drawn_s_ >= 0 && now_s - last_drawn_s_ < kPauseSeconds) return;
  last_drawn_s_ = now_s;
  std::string text = line(done, now_s);
  text.resize(std::min(text.size(), static_cast<std::size_t>(std::max(terminal_.columns - 1, 1))));
  terminal_.write(kClearLine + text);
}

void ProgressBar::update(double done) {
  if (terminal_.interactive) update(done, core::monotonic_seconds());
}

void ProgressBar::finish() {
  if (finished_) return;
  finished_ = true;
  if (last_drawn_s_ >= 0) terminal_.write(kClearLine);
}

}  // namespace psygen::telemetry
