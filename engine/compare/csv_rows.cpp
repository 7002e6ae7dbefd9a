#include "engine/compare/csv_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "engine/core/utf8.hpp"

namespace psygen::compare {
namespace {

constexpr std::size_t kMaxShownBytes = 40;

void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

// Positions of these columns in a header.
core::Result<void> find_columns(std::span<const std::string_view> header,
                                std::span<const std::string_view> names, const std::string& where,
                                std::vector<std::size_t>& columns) {
  for (const std::string_view name : names) {
    const auto found = std::ranges::find(header, name);
    if (found == header.end())
      return refuse_file(where, fmt::format("the column {} is missing", name));
    columns.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return {};
}

}  // namespace

tl::unexpected<core::Error> refuse_file(const std::string& where, std::string_view sentence) {
  return core::fail(core::ErrorCode::kParse, core::shown(fmt::format("{}: {}", where, sentence)));
}

core::Result<void> read_csv(std::string_view text, const std::string& file,
                            std::span<const std::string_view> names, const OnCsvRow& row,
                            std::string_view optional) {
  if (!text.ends_with('\n'))
    return refuse_file(file, "the file is truncated: its last line has no end");
  std::vector<std::string_view> cells, wanted;
  std::vector<std::size_t> columns;
  std::size_t cells_in_header = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(line.size() + 1);
    const std::string where = fmt::format("{}:{}", file, number);
    split(line, cells);
    if (number == 1) {
      cells_in_header = cells.size();
      if (auto ok = find_columns(cells, names, where, columns); !ok) return ok;
      const auto at = std::ranges::find(cells, optional);
      if (!optional.empty() && at != cells.end())
        columns.push_back(static_cast<std::size_t>(at - cells.begin()));
      continue;
    }
    if (cells.size() != cells_in_header)
      return refuse_file(where, fmt::format("the line has {} cells, but the header has {}",
                                            cells.size(), cells_in_header));
    wanted.clear();
    for (const std::size_t column : columns)
      wanted.push_back(cells[column]);
    if (auto ok = row(wanted, where); !ok) return ok;
  }
  return {};
}

core::Result<double> number_in(std::string_view cell, const std::string& where,
                               std::string_view name) {
  double value = 0;
  const auto parsed = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (parsed.ec == std::errc() && parsed.ptr == cell.data() + cell.size() && value >= 0 &&
      value < 1e15)
    return value;
  return refuse_file(where, fmt::format("{}: '{}' is not a number from 0 on", name,
                                        core::shown(cell, kMaxShownBytes)));
}

}  // namespace psygen::compare
