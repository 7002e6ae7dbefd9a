// Parses columns of CSV as psygen writes it: a header and rows of cells, without quotes. Stores
// nothing. Any thread.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::compare {

// Some cells of a row, and the row's location ("file:3").
using CsvCells = std::span<const std::string_view>;
using OnCsvRow = std::function<core::Result<void>(CsvCells cells, const std::string& where)>;

// Calls `row` for every line after the header with its cells of the columns `names`, and of the
// column `optional` if the header has it. Fails with kParse, naming file and line, for a missing
// column, a last line without an end, and rows with another number of cells. Returns errors of
// `row`.
core::Result<void> read_csv(std::string_view text, const std::string& file,
                            std::span<const std::string_view> names, const OnCsvRow& row,
                            std::string_view optional = {});

// Parses a cell as a number in [0, 1e15). Fails with kParse, naming the column.
core::Result<double> number_in(std::string_view cell, const std::string& where,
                               std::string_view name);

// Error kParse with the message "where: sentence".
tl::unexpected<core::Error> refuse_file(const std::string& where, std::string_view sentence);

}  // namespace psygen::compare
