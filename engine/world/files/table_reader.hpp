// Reads the fields of a table into variables and finds everything that is wrong with it: types,
// ranges, missing and unknown keys. Errors name file, line and field and say what is allowed. The
// first problem of the file (by line) is what the user is told; missing fields come last, for they
// may have been misspelt.
#pragma once

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

class Problems {
 public:
  explicit Problems(std::string_view file) : file_(file) {}
  void add(int line, std::string_view field, std::string_view sentence,
           core::ErrorCode code = core::ErrorCode::kParse);
  void add_missing(int line, std::string_view field);
  bool any() const { return first_.has_value(); }
  // Requires any().
  core::Error first() const { return *first_; }

 private:
  void keep_first(int line, int rank, std::string_view field, std::string_view sentence,
                  core::ErrorCode code);

  std::string file_;
  std::optional<core::Error> first_;
  int first_rank_ = 0;
};

// What a number may be; both ends are allowed.
struct Limits {
  double low = 0;
  double high = 0;
};

enum class Presence : std::uint8_t { kOptional, kRequired };

// Numbers that are given as one number or as [low, high], not yet checked against any limits.
struct NumberRange {
  double low = 0, high = 0;
  bool integers = false;  // both ends were written as integers
  int line = 0;
};

class TableReader {
 public:
  // `path` names the table in messages ("sky", "scatter[2]"); empty for the root. `line` is where
  // the table begins. The node and the problems outlive the reader.
  TableReader(const Node& table, std::string path, int line, Problems& problems);

  // Each takes note of the key and leaves `value` as it is when the key is missing or wrong.
  // Returns true if `value` was set.
  bool read(std::string_view key, double& value, Limits limits, Presence = Presence::kOptional);
  bool read(std::string_view key, float& value, Limits limits, Presence = Presence::kOptional);
  bool read(std::string_view key, std::int64_t& value, Limits limits,
            Presence = Presence::kOptional);
  bool read(std::string_view key, bool& value, Presence = Presence::kOptional);
  bool read(std::string_view key, std::string& value, std::size_t max_bytes,
            Presence = Presence::kOptional);
  bool read(std::string_view key, glm::vec3& value, Limits limits, Presence = Presence::kOptional);
  bool read(std::string_view key, glm::dvec2& value, Limits limits, Presence = Presence::kOptional);
  bool read_pair(std::string_view key, std::int64_t (&value)[2], Limits limits,
                 Presence = Presence::kOptional);
  std::optional<NumberRange> read_range(std::string_view key);

  // A sub-table, or null if it is missing.
  const Member* table(std::string_view key, Presence = Presence::kOptional);
  // The tables of an array of tables; empty if it is missing.
  std::vector<const Node*> tables(std::string_view key, std::size_t max_count);

  // Every key that nobody asked for is unknown; the nearest known one is suggested.
  void finish();

  // A key that is there, or null; takes note of it.
  const Member* find(std::string_view key, Presence = Presence::kOptional);
  std::string field(std::string_view key) const;
  int line() const { return line_; }
  void problem(int line, std::string_view key, std::string_view sentence) {
    problems_.add(line, field(key), sentence);
  }

 private:
  bool check_number(const Node& node, std::string_view field, Limits limits, bool integer);
  const Node* array_of(std::string_view key, std::size_t count, Limits limits, bool integers,
                       Presence presence);

  const Node& table_;
  std::string path_;
  int line_;
  Problems& problems_;
  std::vector<std::string> known_;
};

// A number as it was written, or what else the value is: "7", "a string".
std::string value_text(const Node& node);

// Reads the field `format` of a root table, which must be exactly `current`.
void read_format(TableReader& root, int current);

}  // namespace psygen::world
