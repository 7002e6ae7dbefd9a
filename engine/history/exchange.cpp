#include "engine/history/exchange.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "engine/core/nearest_word.hpp"
#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::history {
namespace {

using Json = nlohmann::ordered_json;

enum Column {
  kOrder,
  kTest,
  kFigure,
  kUnit,
  kValue,
  kReference,
  kRevision,
  kFingerprint,
  kTime,
  kWork,
  kReport,
  kColumns
};
constexpr std::array<std::string_view, kColumns> kNames = {
    "order",    "test",        "figure", "unit", "value", "reference",
    "revision", "fingerprint", "time",   "work", "report"};
// The texts of a row; empty: missing.
using Row = std::array<std::string, kColumns>;

std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text)
    result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string csv_line(const Entry& e) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", e.order, quoted(e.test),
                     quoted(e.figure), quoted(e.unit), number_text(e.value),
                     number_text(e.reference), quoted(e.revision), quoted(e.fingerprint), e.time,
                     number_text(e.work), quoted(e.report));
}

std::string json_line(const Entry& e) {
  const auto number = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  const Json json = {{"order", e.order},         {"test", e.test},
                     {"figure", e.figure},       {"unit", e.unit},
                     {"value", number(e.value)}, {"reference", number(e.reference)},
                     {"revision", e.revision},   {"fingerprint", e.fingerprint},
                     {"time", e.time},           {"work", number(e.work)},
                     {"report", e.report}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

tl::unexpected<core::Error> refuse(const std::string& where, std::string_view sentence) {
  return core::fail(core::ErrorCode::kParse, fmt::format("{}: {}", where, sentence));
}

// The column of a name, or of another name for it.
std::optional<Column> column_of(std::string_view name) {
  const std::string_view usual = name == "series"    ? "test"
                                 : name == "run"     ? "order"
                                 : name == "seconds" ? "time"
                                                     : name;
  const auto found = std::ranges::find(kNames, usual);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Column>(found - kNames.begin());
}

// Collects rows as entries.
class Rows {
 public:
  core::Result<void> add(const Row& row, const std::string& where) {
    Entry entry{.test = row[kTest],
                .figure = row[kFigure],
                .unit = row[kUnit],
                .revision = row[kRevision],
                .fingerprint = row[kFingerprint],
                .report = row[kReport]};
    if (entry.test.empty() || entry.figure.empty())
      return refuse(where, "a row needs a test and a figure");
    for (const auto& [column, field] :
         {std::pair(kValue, &Entry::value), std::pair(kReference, &Entry::reference),
          std::pair(kWork, &Entry::work)}) {
      const auto number = number_in(row[column], where, kNames[column]);
      if (!number) return tl::unexpected(number.error());
      entry.*field = *number;
    }
    if (!entry.value) ++missing_[entry.test];
    if (!row[kTime].empty()) {
      const char* const end = row[kTime].data() + row[kTime].size();
      const auto parsed = std::from_chars(row[kTime].data(), end, entry.time);
      if (parsed.ec != std::errc() || parsed.ptr != end)
        return refuse(where, fmt::format("time: '{}' is not a whole number of seconds",
                                         core::shown(row[kTime], 60)));
    }
    entry.order = order_of(row, entry);
    import_.entries.push_back(std::move(entry));
    return {};
  }

  Import finish() {
    for (const auto& [test, count] : missing_)
      import_.notes.push_back(fmt::format("{}: {} value{} missing or not a number",
                                          core::shown(test, 200), count,
                                          count == 1 ? " is" : "s are"));
    return std::move(import_);
  }

 private:
  // A missing number is none. NaN and infinity are none, too.
  static core::Result<std::optional<double>> number_in(const std::string& text,
                                                       const std::string& where,
                                                       std::string_view name) {
    if (text.empty() || text == "null") return std::nullopt;
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end)
      return refuse(where, fmt::format("{}: '{}' is not a number", name, core::shown(text, 60)));
    if (!std::isfinite(value)) return std::nullopt;
    return value;
  }

  // The job of a row: a new one if its columns differ from those before, or it has the figure.
  std::int64_t order_of(const Row& row, const Entry& entry) {
    const Key key{row[kOrder], entry.test, entry.revision, row[kTime], row[kWork], entry.report};
    auto [job, is_new] = jobs_.try_emplace(key);
    if (is_new || !job->second.figures.insert(entry.figure).second)
      job->second = {++last_, {entry.figure}};
    return job->second.order;
  }

  struct Job {
    std::int64_t order = 0;
    std::set<std::string> figures;
  };
  using Key = std::array<std::string, 6>;
  std::map<Key, Job> jobs_;
  std::int64_t last_ = 0;
  std::map<std::string, std::size_t> missing_;
  Import import_;
};

// Reads records of CSV: cells with quotes may hold commas, quotes and line ends.
class CsvReader {
 public:
  CsvReader(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  bool at_end() const { return at_ == text_.size(); }
  std::string where() const { return fmt::format("{}:{}", file_, record_line_); }

  core::Result<std::vector<std::string>> next() {
    record_line_ = line_;
    std::vector<std::string> cells(1);
    while (!at_end()) {
      const char c = text_[at_++];
      if (c == '"' && cells.back().empty()) {
        if (auto ok = read_quoted(cells.back()); !ok) return tl::unexpected(ok.error());
      } else if (c == ',') {
        cells.emplace_back();
      } else if (c == '\n') {
        ++line_;
        if (!cells.back().empty() && cells.back().back() == '\r') cells.back().pop_back();
        return cells;
      } else {
        cells.back() += c;
      }
    }
    return refuse(where(), "the last line has no end: the file is truncated");
  }

 private:
  core::Result<void> read_quoted(std::string& cell) {
    while (!at_end()) {
      const char c = text_[at_++];
      line_ += c == '\n' ? 1 : 0;
      if (c != '"') {
        cell += c;
      } else if (!at_end() && text_[at_] == '"') {
        cell += text_[at_++];
      } else {
        return {};
      }
    }
    return refuse(where(), "a quote is open");
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0, line_ = 1, record_line_ = 1;
};

core::Result<std::vector<Column>> header_of(const std::vector<std::string>& cells,
                                            const std::string& where) {
  std::vector<Column> columns;
  for (const std::string& cell : cells) {
    const auto column = column_of(cell);
    if (!column)
      return refuse(where, fmt::format("'{}' is not a column of a history{}", core::shown(cell, 60),
                                       core::suggestion(cell, kNames)));
    if (std::ranges::find(columns, *column) != columns.end())
      return refuse(where, fmt::format("the column {} is there twice", kNames[*column]));
    columns.push_back(*column);
  }
  for (const Column column : {kTest, kFigure, kValue})
    if (std::ranges::find(columns, column) == columns.end())
      return refuse(where, fmt::format("the column {} is missing", kNames[column]));
  return columns;
}

core::Result<Import> parse_csv(std::string_view text, const std::string& file) {
  CsvReader reader(text, file);
  const auto first = reader.next();
  if (!first) return tl::unexpected(first.error());
  const auto columns = header_of(*first, reader.where());
  if (!columns) return tl::unexpected(columns.error());
  Rows rows;
  while (!reader.at_end()) {
    auto cells = reader.next();
    if (!cells) return tl::unexpected(cells.error());
    if (cells->size() != columns->size())
      return refuse(reader.where(), fmt::format("the row has {} cells, and the header {}",
                                                cells->size(), columns->size()));
    Row row;
    for (std::size_t i = 0; i < columns->size(); ++i)
      row[(*columns)[i]] = std::move((*cells)[i]);
    if (auto ok = rows.add(row, reader.where()); !ok) return tl::unexpected(ok.error());
  }
  return rows.finish();
}

core::Result<Row> row_of(const Json& json, const std::string& where) {
  Row row;
  for (const auto& [name, value] : json.items()) {
    const auto column = column_of(name);
    if (!column)
      return refuse(where, fmt::format("'{}' is not a column of a history{}", core::shown(name, 60),
                                       core::suggestion(name, kNames)));
    if (value.is_string())
      row[*column] = value.get<std::string>();
    else if (value.is_number_float())
      row[*column] = fmt::format("{}", value.get<double>());
    else if (value.is_number())
      row[*column] = value.dump();
    else if (!value.is_null())
      return refuse(where, fmt::format("{}: it must be a text, a number or null", kNames[*column]));
  }
  return row;
}

core::Result<Import> parse_json_lines(std::string_view text, const std::string& file) {
  Rows rows;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string where = fmt::format("{}:{}", file, line);
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos)
      return refuse(where, "the last line has no end: the file is truncated");
    const std::string_view each = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (each.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const Json json = Json::parse(each, nullptr, false);
    if (!json.is_object()) return refuse(where, "the line is not a JSON object");
    const auto row = row_of(json, where);
    if (!row) return tl::unexpected(row.error());
    if (auto ok = rows.add(*row, where); !ok) return tl::unexpected(ok.error());
  }
  return rows.finish();
}

}  // namespace

std::string to_text(std::span<const Entry> entries, ExchangeFormat format) {
  const bool csv = format == ExchangeFormat::kCsv;
  std::string text = csv ? fmt::format("{}\n", fmt::join(kNames, ",")) : "";
  for (const Entry& entry : entries)
    text += csv ? csv_line(entry) : json_line(entry);
  return text;
}

core::Result<Import> parse_entries(std::string_view text, const std::string& file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.empty()) return refuse(file, "the file is empty");
  return text.starts_with('{') ? parse_json_lines(text, file) : parse_csv(text, file);
}

core::Result<Import> read_entries(const std::filesystem::path& file) {
  const auto bytes = core::read_file(file, kMaxImportBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_entries({reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                       file.string());
}

}  // namespace psygen::history
