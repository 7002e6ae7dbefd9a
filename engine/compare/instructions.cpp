#include "engine/compare/instructions.hpp"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "engine/compare/csv_rows.hpp"

namespace psygen::compare {
namespace {

// Text after a word at the beginning of a line, without blanks; empty if no line begins with it.
std::string_view after(std::string_view text, std::string_view word) {
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!line.starts_with(word)) continue;
    line.remove_prefix(word.size());
    const std::size_t first = line.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view() : line.substr(first);
  }
  return {};
}

}  // namespace

Verdict Instructions::verdict() const {
  return ratio() > 1 + kInstructionsShare   ? Verdict::kWorse
         : ratio() < 1 - kInstructionsShare ? Verdict::kBetter
                                            : Verdict::kSame;
}

core::Result<std::uint64_t> instructions_in(std::string_view callgrind, const std::string& file) {
  const std::string_view number = after(callgrind, "totals:");
  std::uint64_t count = 0;
  const auto read = std::from_chars(number.data(), number.data() + number.size(), count);
  if (read.ec != std::errc() || count == 0)
    return refuse_file(file, "callgrind wrote no instruction count (totals)");
  return count;
}

std::string_view hash_in(std::string_view output) {
  return after(output, "hash ");
}

std::string to_text(const Instructions& instructions) {
  return fmt::format("verdict: {}\n  instructions {} and {}: {:+.2f} % (limit {:g} %)\n",
                     name_of(instructions.verdict()), instructions.a, instructions.b,
                     100 * (instructions.ratio() - 1), 100 * kInstructionsShare);
}

std::string to_json(const Instructions& instructions) {
  const nlohmann::ordered_json json = {{"schema", "psygen.instructions/1"},
                                       {"verdict", name_of(instructions.verdict())},
                                       {"a", instructions.a},
                                       {"b", instructions.b},
                                       {"ratio", instructions.ratio()}};
  return json.dump(2) + "\n";
}

}  // namespace psygen::compare
