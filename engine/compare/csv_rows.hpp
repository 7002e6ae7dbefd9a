// Parses CSV as psygen writes it: a header and rows of cells, without quotes. Stores nothing. Any
// thread.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::compare {

// The cells of a line, and its location ("file:3").
using CsvCells = std::span<const std::string_view>;
using OnCsvLine = std::function<core::Result<void>(CsvCells cells, const std::string& where)>;

// Calls `header` with the first line and `row` with every other. Fails with kParse, naming file and
// line, for a last line without an end and for rows with another number of cells. Returns errors of
// the callbacks.
core::Result<void> read_csv(std::string_view text, const std::string& file, const OnCsvLine& header,
                            const OnCsvLine& row);

// Positions of these columns in a header. Fails with kParse for a missing column.
core::Result<std::vector<std::size_t>> find_columns(CsvCells header,
                                                    std::span<const std::string_view> names,
                                                    const std::string& where);

// Parses a cell as a number in [0, 1e15). Fails with kParse, naming the column.
core::Result<double> number_in(std::string_view cell, const std::string& where,
                               std::string_view name);

// Error kParse with the message "where: sentence".
tl::unexpected<core::Error> refuse_file(const std::string& where, std::string_view sentence);

}  // namespace psygen::compare
