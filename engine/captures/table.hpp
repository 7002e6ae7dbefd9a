// Tables of text as capture tools, spreadsheets and shells leave them: commas, semicolons or tabs,
// quotes, decimal commas, any line end, cut last lines. Views into the text; stores no rows. Any
// thread.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::captures {

// The text of a capture as UTF-8, without a byte-order mark, and its file's name for messages.
struct Source {
  std::string_view text;
  const std::string& name;
};

// Error kParse "name:line: sentence", for damaged content.
tl::unexpected<core::Error> damaged(const Source& source, std::size_t line,
                                    std::string_view sentence);
// Error kInvalidArgument "name: sentence", for files without frame times.
tl::unexpected<core::Error> refused(const Source& source, std::string_view sentence);

// Compares ASCII letters without their case.
bool same_name(std::string_view a, std::string_view b);
// The text without blanks at its ends.
std::string_view trimmed(std::string_view text);

// Walks over the lines of a text.
struct Line {
  std::string_view text;   // without its end
  std::size_t number = 0;  // from 1
  bool ended = false;      // false for a last line without an end
};
// Moves to the next line; false at the end of `rest`.
bool next_line(std::string_view& rest, Line& line);
// Fails with kParse for a line of over kMaxLineBytes.
inline constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;
core::Result<void> check_length(const Source& source, const Line& line);
// Error for a row with more `cells` ("5 cells") than the header, between commas.
tl::unexpected<core::Error> decimal_commas(const Source& source, std::size_t line,
                                           std::string_view cells, std::size_t columns);

// Splits a line at `separator` outside of quotes. Cells lose their blanks and quotes.
void split(std::string_view line, char separator, std::vector<std::string_view>& cells);
// The separator of a header: the most frequent of comma, semicolon and tab.
char separator_of(std::string_view header);

// A header, and the text below it.
struct Table {
  std::vector<std::string_view> header;
  char separator = ',';
  std::string_view rows;
  std::size_t line = 1;  // number of the header's line

  // Position of a column, without regard to case.
  std::optional<std::size_t> find(std::string_view name) const;
  // The first of these columns that exists.
  std::optional<std::size_t> find_any(std::initializer_list<std::string_view> names) const;
};
// Makes a table whose header is `line`; `rest` follows it.
Table table_at(const Line& line, std::string_view rest);

// Numbers of cells that a row may have.
struct Width {
  std::size_t fewest, most;
  std::size_t max_of_first;  // OCAT's first row has more
};
// A row's cells, and the number of its line.
using OnRow = std::function<core::Result<void>(const std::vector<std::string_view>&, std::size_t)>;
// Calls `row` for each row that is not blank. Returns true if the last line is cut: it has too few
// cells and no end, and `row` does not receive it. Fails with kParse for other numbers of cells.
core::Result<bool> for_each_row(const Source& source, const Table& table, const Width& width,
                                const OnRow& row);

// Parses a number; a decimal comma is allowed unless commas separate the cells. `missing` is true
// for cells that mean "not measured": empty, NA, N/A, NaN, inf. Otherwise empty if it is no number.
struct Number {
  std::optional<double> value;
  bool missing = false;
};
Number number_in(std::string_view cell, char separator);

// Times of a million seconds or more are refused.
inline constexpr double kMaxMs = 1e9;
// Parses a time in the unit of its column: nothing if it is not measured or 0. Fails with kParse
// for text, negative times, and times of a million seconds or more.
core::Result<std::optional<double>> time_in(std::string_view cell, const Table& table,
                                            const Source& source, std::size_t line);

}  // namespace psygen::captures
