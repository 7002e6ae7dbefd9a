#include "engine/inspect/json_screen.hpp"

namespace psygen::inspect {
namespace {

constexpr int kMaxMarks = 64, kMaxDepth = 4;
constexpr std::size_t kMaxOutside = 4096;  // bytes outside strings: numbers, blanks

}  // namespace

bool is_small_json(std::string_view text) {
  int depth = 0, marks = 0;
  std::size_t outside = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (++outside > kMaxOutside) return false;
    if (c == '"') in_string = true;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (c == '[' || c == '{' || c == ',' || c == ':') ++marks;
    if (depth > kMaxDepth || marks > kMaxMarks) return false;
  }
  return true;
}

}  // namespace psygen::inspect
