#include "engine/captures/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/core/utf8.hpp"

namespace psygen::captures {
namespace {

constexpr std::size_t kMaxShownBytes = 40;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// The end of a quoted cell at the start of `line`: the position behind its last quote and blanks,
// which is a separator or the line's end. npos if the quote does not close so.
std::size_t end_of_quoted(std::string_view line, char separator) {
  for (std::size_t at = line.find('"', 1); at != std::string_view::npos;
       at = line.find('"', at + 2)) {
    if (at + 1 < line.size() && line[at + 1] == '"') continue;  // a quote in the cell
    const std::size_t next = std::min(line.find_first_not_of(' ', at + 1), line.size());
    return next == line.size() || line[next] == separator ? next : std::string_view::npos;
  }
  return std::string_view::npos;
}

std::string_view without_quotes(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"')
    cell = cell.substr(1, cell.size() - 2);
  return cell;
}

// Error for a row of too many cells. Between commas they come from decimal commas.
tl::unexpected<core::Error> too_wide(const Source& source, const Table& table, const Line& line,
                                     std::string_view rest, std::size_t cells) {
  if (table.separator != ',')
    return damaged(
        source, line.number,
        fmt::format("the line has {} cells, but the header has {}", cells, table.header.size()));
  std::string next;
  Line other;
  const bool is_followed = next_line(rest, other) && !other.text.empty();
  if (is_followed && other.text.size() <= kMaxLineBytes) {
    std::vector<std::string_view> others;
    split(other.text, table.separator, others);
    if (others.size() != cells)
      next = fmt::format(" (line {} has {})", line.number + 1, others.size());
  }
  return decimal_commas(source, line.number, fmt::format("{} cells{}", cells, next),
                        table.header.size());
}

// Parses digits, with a decimal comma unless commas separate the cells.
std::optional<double> parsed(std::string_view cell, char separator) {
  std::array<char, 64> digits{};
  if (cell.size() > digits.size()) return std::nullopt;
  std::ranges::copy(cell, digits.begin());
  if (separator != ',' && std::ranges::count(cell, ',') == 1 &&
      cell.find('.') == std::string_view::npos)
    digits[cell.find(',')] = '.';
  double value = 0;
  const char* end = digits.data() + cell.size();
  const auto [last, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc() || last != end) return std::nullopt;
  return value;
}

}  // namespace

tl::unexpected<core::Error> damaged(const Source& source, std::size_t line,
                                    std::string_view sentence) {
  return core::fail(core::ErrorCode::kParse,
                    core::shown(fmt::format("{}:{}: {}", source.name, line, sentence)));
}

tl::unexpected<core::Error> refused(const Source& source, std::string_view sentence) {
  return core::invalid_argument(core::shown(fmt::format("{}: {}", source.name, sentence)));
}

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

bool next_line(std::string_view& rest, Line& line) {
  if (rest.empty()) return false;
  const std::size_t end = rest.find('\n');
  line.ended = end != std::string_view::npos;
  line.text = rest.substr(0, end);
  rest.remove_prefix(line.ended ? end + 1 : rest.size());
  if (line.text.ends_with('\r')) line.text.remove_suffix(1);
  ++line.number;
  return true;
}

core::Result<void> check_length(const Source& source, const Line& line) {
  if (line.text.size() > kMaxLineBytes)
    return damaged(source, line.number, "the line is longer than 1 MiB");
  return {};
}

tl::unexpected<core::Error> decimal_commas(const Source& source, std::size_t line,
                                           std::string_view cells, std::size_t columns) {
  return damaged(source, line,
                 fmt::format("the line has {} under a header of {}: decimal commas between commas "
                             "cannot be read; export with a language that writes decimal points",
                             cells, columns));
}

void split(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    while (line.starts_with(' '))
      line.remove_prefix(1);
    std::size_t end = std::string_view::npos;
    if (line.starts_with('"')) end = end_of_quoted(line, separator);
    if (end == std::string_view::npos) end = std::min(line.find(separator), line.size());
    cells.push_back(without_quotes(line.substr(0, end)));
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
  }
}

char separator_of(std::string_view header) {
  char best = ',';
  for (const char separator : {';', '\t'})
    if (std::ranges::count(header, separator) > std::ranges::count(header, best)) best = separator;
  return best;
}

std::optional<std::size_t> Table::find(std::string_view name) const {
  const auto found =
      std::ranges::find_if(header, [&](std::string_view cell) { return same_name(cell, name); });
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

std::optional<std::size_t> Table::find_any(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names)
    if (const auto found = find(name)) return found;
  return std::nullopt;
}

Table table_at(const Line& line, std::string_view rest) {
  Table table;
  table.separator = separator_of(line.text);
  table.rows = rest;
  table.line = line.number;
  split(line.text, table.separator, table.header);
  return table;
}

core::Result<bool> for_each_row(const Source& source, const Table& table, const Width& width,
                                const OnRow& row) {
  std::vector<std::string_view> cells;
  Line line{.text = {}, .number = table.line, .ended = false};
  std::size_t most = width.max_of_first;
  for (std::string_view rest = table.rows; next_line(rest, line);) {
    if (auto ok = check_length(source, line); !ok) return tl::unexpected(ok.error());
    split(line.text, table.separator, cells);
    if (std::ranges::all_of(cells, &std::string_view::empty)) continue;
    if (cells.size() > most) return too_wide(source, table, line, rest, cells.size());
    if (cells.size() < width.fewest) {
      if (!line.ended) return true;
      return damaged(source, line.number,
                     fmt::format("the line has {} cells, but the header has {}", cells.size(),
                                 table.header.size()));
    }
    if (auto ok = row(cells, line.number); !ok) return tl::unexpected(ok.error());
    most = width.most;
  }
  return false;
}

Number number_in(std::string_view cell, char separator) {
  constexpr std::array<std::string_view, 6> kMissing = {"", "NA", "N/A", "null", "-", "nan(ind)"};
  if (const auto value = parsed(cell, separator)) {
    if (std::isfinite(*value)) return {.value = value, .missing = false};
    return {.value = {}, .missing = true};
  }
  const auto is_cell = [cell](std::string_view name) { return same_name(cell, name); };
  if (std::ranges::any_of(kMissing, is_cell) || is_cell("-nan(ind)") || cell.starts_with("1.#") ||
      cell.starts_with("-1.#"))
    return {.value = {}, .missing = true};
  return {};
}

core::Result<std::optional<double>> time_in(std::string_view cell, const Table& table,
                                            const Source& source, std::size_t line) {
  const Number number = number_in(cell, table.separator);
  if (number.missing || number.value == 0.0) return std::nullopt;
  if (number.value && *number.value > 0 && *number.value < kMaxMs) return number.value;
  return damaged(source, line,
                 fmt::format("'{}' is not a time from 0 to {:g} ms",
                             core::shown(cell, kMaxShownBytes), kMaxMs));
}

}  // namespace psygen::captures
