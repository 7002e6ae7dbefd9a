// A history as CSV and as JSON lines, with all columns: exporting and importing into an empty
// history keeps every bit. Pure but for read_entries(); linear in the text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/history/entry.hpp"

namespace psygen::history {

// Formats of a history as text.
enum class ExchangeFormat { kCsv, kJsonLines };

// Entries as text, a line each. CSV has a header, and quotes as RFC 4180 has them.
std::string to_text(std::span<const Entry> entries, ExchangeFormat format);

struct Import {
  std::vector<Entry>
      entries;  // orders from 1: rows with equal columns but for the figure are a job
  std::vector<std::string> notes;  // sentences: values that are no numbers
};

// Parses such a text; JSON lines begin with "{". Columns may have any order; test, figure and value
// are required, and "series", "run" and "seconds" are other names of test, order and time. Values
// that are empty, NaN or infinite are missing, and counted. Fails with kParse, naming file, line
// and column.
core::Result<Import> parse_entries(std::string_view text, const std::string& file);

// Most bytes of a file that is imported.
inline constexpr std::uint64_t kMaxImportBytes = std::uint64_t{256} << 20;

// Reads and parses a file. Fails with kIo and kOverBudget, and like parse_entries().
core::Result<Import> read_entries(const std::filesystem::path& file);

}  // namespace psygen::history
