#include "engine/telemetry/process.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "engine/core/utf8.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::size_t kMaxBytes = 2000;

bool is_plain(char c) {
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return letter || std::string_view("-_./=,:+%@").find(c) != std::string_view::npos;
}

// Puts a word in single quotes if a shell would interpret it otherwise.
std::string quoted(std::string_view word) {
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return std::string(word);
  std::string text = "'";
  for (const char c : word)
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string shell_text(std::string_view words) {
  std::string text;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find('\0'), words.size());
    if (!text.empty()) text += ' ';
    text += quoted(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return core::shown(text, kMaxBytes);
}

std::string process_command() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string words((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return shell_text(words);
}

Measured<std::uint64_t> peak_rss_bytes() {
  const std::string name = "VmHWM:";
  std::ifstream status("/proc/self/status");
  std::string key;
  while (status >> key) {
    std::uint64_t kibibytes = 0;
    if (key == name && status >> kibibytes) return kibibytes * 1024;
    std::getline(status, key);
  }
  return Measured<std::uint64_t>::missing("/proc/self/status has no field " + name);
}

void forget_peak_rss() {
  std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): since Linux 4.0
}

}  // namespace psygen::telemetry
