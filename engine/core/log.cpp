#include "engine/core/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <string>

#include "engine/core/utf8.hpp"

namespace psygen::core {
namespace {
spdlog::logger& logger() {
  static const auto instance = [] {
    auto created = spdlog::stderr_color_mt("psygen");
    created->set_pattern("psygen: %^%l%$: %v");
    return created;
  }();
  return *instance;
}
}  // namespace

void set_log_name(std::string_view name) {
  std::string pattern;
  for (const char c : shown(name))
    pattern += c == '%' ? "%%" : std::string(1, c);
  logger().set_pattern(pattern + ": %^%l%$: %v");
}

void log_info(std::string_view message) {
  logger().info(shown(message));
}
void log_warning(std::string_view message) {
  logger().warn(shown(message));
}
void log_error(std::string_view message) {
  logger().error(shown(message));
}

}  // namespace psygen::core
