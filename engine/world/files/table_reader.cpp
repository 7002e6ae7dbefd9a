#include "engine/world/files/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxShownBytes = 60;  // of an unknown key, in messages

// The allowed values: "an integer from 1 to 9".
std::string allowed_text(Limits limits, bool integer) {
  constexpr double kExact = 0x1.0p53;  // larger integers are shown rounded
  if (integer && limits.low >= -kExact && limits.high <= kExact)
    return fmt::format("an integer from {:.0f} to {:.0f}", limits.low, limits.high);
  return fmt::format("{} from {:g} to {:g}", integer ? "an integer" : "a number", limits.low,
                     limits.high);
}

bool is_number(const Node& node) {
  return node.kind == Node::Kind::kInteger || node.kind == Node::Kind::kReal;
}

// Control characters of ASCII and of Latin-1.
bool has_control_characters(std::string_view text) {
  while (!text.empty()) {
    const core::CodePoint point = core::first_code_point(text);
    if (point.value < ' ' || (point.value >= 0x7F && point.value < 0xA0)) return true;
    text.remove_prefix(point.bytes);
  }
  return false;
}

}  // namespace

void Problems::keep_first(int line, int rank, std::string_view field, std::string_view sentence,
                          core::ErrorCode code) {
  if (first_ && rank >= first_rank_) return;
  // Uses shown(), because the sentence may contain text from the file.
  first_ = core::Error{code, fmt::format("{}:{}: {}", file_, line,
                                         core::shown(fmt::format("{}: {}", field, sentence)))};
  first_rank_ = rank;
}

void Problems::add(int line, std::string_view field, std::string_view sentence,
                   core::ErrorCode code) {
  keep_first(line, line, field, sentence, code);
}

void Problems::add_missing(int line, std::string_view field) {
  keep_first(line, std::numeric_limits<int>::max(), field, "this field is missing",
             core::ErrorCode::kParse);
}

TableReader::TableReader(const Node& table, std::string path, int line, Problems& problems)
    : table_(table), path_(std::move(path)), line_(line), problems_(problems) {}

std::string TableReader::field(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

void TableReader::problem(std::string_view key, std::string_view sentence, core::ErrorCode code) {
  const Member* member = table_.find(key);
  problem(member != nullptr ? member->line : line_, key, sentence, code);
}

const Member* TableReader::find(std::string_view key, Presence presence) {
  if (std::ranges::find(known_, key) == known_.end()) known_.emplace_back(key);
  const Member* member = table_.find(key);
  if (member == nullptr && presence == Presence::kRequired)
    problems_.add_missing(line_, field(key));
  return member;
}

bool TableReader::check_number(const Node& node, std::string_view name, Limits limits,
                               bool integer) {
  const bool right_kind = integer ? node.kind == Node::Kind::kInteger : is_number(node);
  // False for NaN.
  if (right_kind && node.real >= limits.low && node.real <= limits.high) return true;
  problems_.add(node.line, name,
                fmt::format("{} is not allowed: it must be {}", value_text(node),
                            allowed_text(limits, integer)));
  return false;
}

const Node* TableReader::number_of(std::string_view key, Limits limits, bool integer,
                                   Presence presence) {
  const Member* member = find(key, presence);
  const bool sound = member != nullptr && check_number(member->value, field(key), limits, integer);
  return sound ? &member->value : nullptr;
}

const Node* TableReader::array_of(std::string_view key, std::size_t count, Limits limits,
                                  bool integers, Presence presence) {
  const Member* member = find(key, presence);
  if (member == nullptr) return nullptr;
  const Node& node = member->value;
  if (node.kind != Node::Kind::kArray || node.items.size() != count) {
    problem(key, fmt::format("it must be an array of {}, each {}", count,
                             allowed_text(limits, integers)));
    return nullptr;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!check_number(node.items[i], fmt::format("{}[{}]", field(key), i), limits, integers))
      return nullptr;
  }
  return &node;
}

bool TableReader::read(std::string_view key, double& value, Limits limits, Presence presence) {
  const Node* node = number_of(key, limits, false, presence);
  if (node != nullptr) value = node->real;
  return node != nullptr;
}

bool TableReader::read(std::string_view key, float& value, Limits limits, Presence presence) {
  const Node* node = number_of(key, limits, false, presence);
  if (node != nullptr) value = static_cast<float>(node->real);
  return node != nullptr;
}

bool TableReader::read(std::string_view key, std::int64_t& value, Limits limits,
                       Presence presence) {
  const Node* node = number_of(key, limits, true, presence);
  if (node != nullptr) value = node->integer;
  return node != nullptr;
}

bool TableReader::read(std::string_view key, bool& value, Presence presence) {
  const Member* member = find(key, presence);
  if (member == nullptr) return false;
  const bool sound = member->value.kind == Node::Kind::kBoolean;
  if (sound)
    value = member->value.boolean;
  else
    problem(key, "it must be true or false");
  return sound;
}

bool TableReader::read(std::string_view key, std::string& value, std::size_t max_bytes,
                       Presence presence) {
  const Member* member = find(key, presence);
  if (member == nullptr) return false;
  const std::string& text = member->value.text;
  const bool sound = member->value.kind == Node::Kind::kText && !text.empty() &&
                     text.size() <= max_bytes && !has_control_characters(text);
  if (sound)
    value = text;
  else
    problem(key, fmt::format("it must be a string of 1 to {} bytes without control characters",
                             max_bytes));
  return sound;
}

bool TableReader::read(std::string_view key, glm::vec3& value, Limits limits, Presence presence) {
  const Node* node = array_of(key, 3, limits, false, presence);
  if (node != nullptr)
    value = glm::vec3(node->items[0].real, node->items[1].real, node->items[2].real);
  return node != nullptr;
}

bool TableReader::read(std::string_view key, glm::dvec2& value, Limits limits, Presence presence) {
  const Node* node = array_of(key, 2, limits, false, presence);
  if (node != nullptr) value = {node->items[0].real, node->items[1].real};
  return node != nullptr;
}

bool TableReader::read(std::string_view key, std::array<double, 4>& value, Limits limits,
                       Presence presence) {
  const Node* node = array_of(key, value.size(), limits, false, presence);
  if (node != nullptr) std::ranges::transform(node->items, value.begin(), &Node::real);
  return node != nullptr;
}

bool TableReader::read_pair(std::string_view key, std::int64_t (&value)[2], Limits limits,
                            Presence presence) {
  const Node* node = array_of(key, 2, limits, true, presence);
  if (node != nullptr) std::ranges::transform(node->items, value, &Node::integer);
  return node != nullptr;
}

std::optional<NumberRange> TableReader::read_range(std::string_view key) {
  const Member* member = find(key);
  if (member == nullptr) return std::nullopt;
  const Node& node = member->value;
  const bool is_pair = node.kind == Node::Kind::kArray && node.items.size() == 2;
  const Node& low = is_pair ? node.items[0] : node;
  const Node& high = is_pair ? node.items[1] : node;
  if (!is_number(low) || !is_number(high)) {
    problem(key, "it must be a number, or [lowest, highest]");
  } else if (!std::isfinite(low.real) || !std::isfinite(high.real)) {
    problem(key, fmt::format("{} is not allowed: it must be finite",
                             value_text(std::isfinite(low.real) ? high : low)));
  } else if (low.real > high.real) {
    problem(key, fmt::format("[{}, {}] is reversed: give the lowest value first", value_text(low),
                             value_text(high)));
  } else {
    return NumberRange{low.real, high.real,
                       low.kind == Node::Kind::kInteger && high.kind == Node::Kind::kInteger,
                       node.line};
  }
  return std::nullopt;
}

std::optional<TableReader> TableReader::table(std::string_view key, Presence presence) {
  const Member* member = find(key, presence);
  if (member == nullptr) return std::nullopt;
  if (member->value.kind == Node::Kind::kTable)
    return TableReader(member->value, field(key), member->line, problems_);
  problem(key, fmt::format("it must be a table, [{}], not {}", key, kind_name(member->value.kind)));
  return std::nullopt;
}

std::vector<TableReader> TableReader::tables(std::string_view key, std::size_t max_count) {
  const Member* member = find(key);
  if (member == nullptr) return {};
  const std::vector<Node>& items = member->value.items;
  std::vector<TableReader> found;
  if (member->value.kind == Node::Kind::kArray && items.size() <= max_count &&
      std::ranges::all_of(
          items, [](Node::Kind kind) { return kind == Node::Kind::kTable; }, &Node::kind)) {
    for (const Node& item : items)
      found.push_back(
          {item, fmt::format("{}[{}]", field(key), found.size()), item.line, problems_});
  } else {
    problem(key, fmt::format("it must be at most {} tables, [[{}]]", max_count, key));
  }
  return found;
}

void TableReader::finish() {
  for (const Member& member : table_.members) {
    if (std::ranges::find(known_, member.key) != known_.end()) continue;
    std::string more = core::suggestion(member.key, known_);
    if (more.empty()) more = fmt::format("; known here: {}", fmt::join(known_, ", "));
    problem(member.line, core::shown(member.key, kMaxShownBytes), "this key is unknown" + more);
  }
}

std::string value_text(const Node& node) {
  if (node.kind == Node::Kind::kInteger) return fmt::format("{}", node.integer);
  if (node.kind == Node::Kind::kReal) return fmt::format("{:g}", node.real);
  return std::string(kind_name(node.kind));
}

void read_format(TableReader& root, int current) {
  const Member* member = root.find("format", Presence::kRequired);
  if (member == nullptr) return;
  const Node& node = member->value;
  const bool is_integer = node.kind == Node::Kind::kInteger;
  if (is_integer && node.integer == current) return;
  root.problem(node.line, "format",
               is_integer && node.integer > current
                   ? fmt::format("the file has version {}, which is newer than this program; "
                                 "allowed: {}",
                                 node.integer, current)
                   : fmt::format("it must be {}", current));
}

}  // namespace psygen::world
