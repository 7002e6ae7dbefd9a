#include "tests/limits/page.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/source_file.hpp"

namespace psygen::limits {
namespace {

constexpr const char* kBetween = "…";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line.substr(1));
  for (std::string cell; std::getline(in, cell, '|');)
    cells.push_back(trimmed(cell));
  return cells;
}

// The parts of a text between backticks.
std::vector<std::string> code_of(const std::string& cell) {
  std::vector<std::string> found;
  for (std::size_t from = cell.find('`'); from != std::string::npos; from = cell.find('`', from)) {
    const std::size_t to = cell.find('`', from + 1);
    if (to == std::string::npos) return {};
    found.push_back(cell.substr(from + 1, to - from - 1));
    from = to + 1;
  }
  return found;
}

// "1,000 m", "4 MiB", "1e9 m".
double number_of(std::string text) {
  static const std::map<std::string, double> units{
      {"KiB", 0x1p10}, {"MiB", 0x1p20}, {"GiB", 0x1p30}};
  std::erase(text, ',');
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const auto unit = units.find(trimmed(end).substr(0, 3));
  return unit == units.end() ? number : number * unit->second;
}

}  // namespace

Page read_page() {
  Page page;
  std::vector<Row>* table = nullptr;
  std::ifstream in(source_file("docs/limits.md"));
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| ")) {
      table = nullptr;
      continue;
    }
    const auto cells = cells_of(line);
    if (cells.front() == "input") {
      table = cells.back() == "refused with" ? &page.tried : &page.held_elsewhere;
    } else if (table != nullptr && cells.size() == 4 && !cells.front().starts_with("--")) {
      const auto constant = code_of(cells[2]), last = code_of(cells[3]);
      if (constant.size() != 2 || last.size() != 1 || last[0].empty()) {
        ADD_FAILURE() << "not a row of limits: " << line;
        continue;
      }
      const bool tried = table == &page.tried;
      table->push_back({.input = cells[0],
                        .most = number_of(cells[1]),
                        .constant = constant[0],
                        .file = constant[1],
                        .refusal = tried ? last[0] : "",
                        .test = tried ? "" : last[0]});
    }
  }
  return page;
}

bool matches(const std::string& message, const std::string& refusal) {
  std::size_t at = 0, from = 0;
  while (from <= refusal.size()) {
    const std::size_t to = std::min(refusal.find(kBetween, from), refusal.size());
    const std::string part = refusal.substr(from, to - from);
    at = message.find(part, at);
    if (at == std::string::npos) return false;
    at += part.size();
    from = to + std::string(kBetween).size();
  }
  return true;
}

}  // namespace psygen::limits
