#include "engine/core/log.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "engine/core/file_calls.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::core {
namespace {

// The last lines, in memory that is allocated once.
class KeptLines final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  bool write_to(int descriptor) const {
    const std::size_t end = next_.load(std::memory_order_acquire);
    for (std::size_t i = end - std::min(end, kKeptLogLines); i < end; ++i) {
      const Line& line = lines_[i % kKeptLogLines];
      if (write_some(descriptor, {line.text.data(), line.bytes}) !=
          static_cast<std::ptrdiff_t>(line.bytes))
        return false;
    }
    return true;
  }

 private:
  struct Line {
    std::array<char, kKeptLogLineBytes + 1> text{};
    std::size_t bytes = 0;
  };

  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    const std::size_t number = next_.load(std::memory_order_relaxed);
    Line& line = lines_[number % kKeptLogLines];
    line.bytes = std::min(text.size(), line.text.size());
    std::copy_n(text.data(), line.bytes, line.text.data());
    line.text[line.bytes - 1] = '\n';
    next_.store(number + 1, std::memory_order_release);
  }
  void flush_() override {}

  std::array<Line, kKeptLogLines> lines_;
  std::atomic<std::size_t> next_ = 0;
};

struct Log {
  std::shared_ptr<KeptLines> kept = std::make_shared<KeptLines>();
  spdlog::logger logger{"psygen", {std::make_shared<spdlog::sinks::stderr_color_sink_mt>(), kept}};
};

// It lives as long as the process, which may crash at its end.
Log& log() {
  static Log& instance = []() -> Log& {
    auto* const created = new Log();
    created->logger.set_pattern("psygen: %^%l%$: %v");
    return *created;
  }();
  return instance;
}
}  // namespace

void set_log_name(std::string_view name) {
  std::string pattern;
  for (const char c : shown(name))
    pattern += c == '%' ? "%%" : std::string(1, c);
  log().logger.set_pattern(pattern + ": %^%l%$: %v");
}

void log_info(std::string_view message) {
  log().logger.info(shown(message));
}
void log_warning(std::string_view message) {
  log().logger.warn(shown(message));
}
void log_error(std::string_view message) {
  log().logger.error(shown(message));
}

bool write_kept_log_lines(int descriptor) {
  return log().kept->write_to(descriptor);
}

}  // namespace psygen::core
