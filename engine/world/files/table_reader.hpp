// Reads the fields of a table into variables and checks types, ranges, missing keys and unknown
// keys. Messages name file, line, field and allowed values. The user gets the problem on the lowest
// line. Missing fields come last, because they may be misspelt. One thread per file. It parses no
// text (document.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/world/files/document.hpp"

namespace psygen::world {

// Collects the problems of one file and keeps the first.
class Problems {
 public:
  // `file` is the name for messages.
  explicit Problems(std::string_view file) : file_(file) {}
  // Adds a problem with a field, or a missing required field. `line` counts from 1.
  void add(int line, std::string_view field, std::string_view sentence,
           core::ErrorCode code = core::ErrorCode::kParse);
  void add_missing(int line, std::string_view field);
  // True if there was a problem; and the first one. first() requires any().
  bool any() const { return first_.has_value(); }
  core::Error first() const { return *first_; }

 private:
  void keep_first(int line, int rank, std::string_view field, std::string_view sentence,
                  core::ErrorCode code);

  std::string file_;
  std::optional<core::Error> first_;
  int first_rank_ = 0;
};

// The allowed range of a number, both ends included.
struct Limits {
  double low = 0;
  double high = 0;
};

// A missing required key is a problem.
enum class Presence : std::uint8_t { kOptional, kRequired };

// A value written as one number or as [low, high], without a check against limits. Both are finite
// and low <= high.
struct NumberRange {
  double low = 0, high = 0;
  bool integers = false;  // both ends were written as integers
  int line = 0;
};

// Reads one table.
class TableReader {
 public:
  // `path` names the table in messages ("sky", "scatter[2]"); it is empty for the root. `line` is
  // the first line of the table. The node and the problems must outlive the reader.
  TableReader(const Node& table, std::string path, int line, Problems& problems);

  // Each reads the value of a key, registers the key as known, and returns true if it set `value`.
  // A missing key or a wrong value leaves `value` unchanged. Strings have 1 to `max_bytes` bytes
  // and no control characters; read_range() returns nothing instead of false.
  bool read(std::string_view key, double& value, Limits limits, Presence = Presence::kOptional);
  bool read(std::string_view key, float& value, Limits limits, Presence = Presence::kOptional);
  bool read(std::string_view key, std::int64_t& value, Limits limits,
            Presence = Presence::kOptional);
  bool read(std::string_view key, bool& value, Presence = Presence::kOptional);
  bool read(std::string_view key, std::string& value, std::size_t max_bytes,
            Presence = Presence::kOptional);
  bool read(std::string_view key, glm::vec3& value, Limits limits, Presence = Presence::kOptional);
  bool read(std::string_view key, glm::dvec2& value, Limits limits, Presence = Presence::kOptional);
  bool read(std::string_view key, std::array<double, 4>& value, Limits limits,
            Presence = Presence::kOptional);
  bool read_pair(std::string_view key, std::int64_t (&value)[2], Limits limits,
                 Presence = Presence::kOptional);
  std::optional<NumberRange> read_range(std::string_view key);

  // The reader of a sub-table; nothing if it is missing or not a table.
  std::optional<TableReader> table(std::string_view key, Presence = Presence::kOptional);
  // The readers of an array of tables; none if it is missing or wrong.
  std::vector<TableReader> tables(std::string_view key, std::size_t max_count);

  // Adds a problem for every key that was never read and suggests the nearest known key. Call it
  // last.
  void finish();

  // A member of the table, or null. Registers the key as known.
  const Member* find(std::string_view key, Presence = Presence::kOptional);
  // The full name of a key ("sky.exposure"), the table, its first line, and its file's problems.
  std::string field(std::string_view key) const;
  const Node& node() const { return table_; }
  int line() const { return line_; }
  Problems& problems() const { return problems_; }
  // Adds a problem with a key: on this line, or on the key's line (the table's if it is missing).
  void problem(int line, std::string_view key, std::string_view sentence,
               core::ErrorCode code = core::ErrorCode::kParse) {
    problems_.add(line, field(key), sentence, code);
  }
  void problem(std::string_view key, std::string_view sentence,
               core::ErrorCode code = core::ErrorCode::kParse);

 private:
  bool check_number(const Node& node, std::string_view field, Limits limits, bool integer);
  // The value of a key if it is a number, or an array of numbers, within the limits; else null.
  const Node* number_of(std::string_view key, Limits limits, bool integer, Presence presence);
  const Node* array_of(std::string_view key, std::size_t count, Limits limits, bool integers,
                       Presence presence);

  const Node& table_;
  std::string path_;
  int line_;
  Problems& problems_;
  std::vector<std::string> known_;
};

// A value for messages: a number as text, else its kind. "7", "a string".
std::string value_text(const Node& node);

// Checks the required field `format` of a root table, which must equal `current`.
void read_format(TableReader& root, int current);

}  // namespace psygen::world
