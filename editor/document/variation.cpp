#include "editor/document/variation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "editor/document/recovery.hpp"
#include "editor/document/scale.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/text_path.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

using world::FieldKind;
using world::WorldField;

constexpr double kStepsOfRange = 100;
constexpr std::uint64_t kMaxLockBytes = 1 << 20;

// 0 … 1, the same on every machine.
double random_fraction(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1.0p-53;
}

double drawn(const WorldField& field, std::mt19937_64& random) {
  const double low = field.soft_min, high = field.soft_max, at = random_fraction(random);
  // All integers are equally likely.
  if (is_whole(field.kind)) return std::min(high, std::floor(low + at * (high - low + 1)));
  return std::clamp(scale_of(field).at(at), field.hard_min, field.hard_max);
}

double stepped(const WorldField& field, double value, int steps) {
  double next = value + steps;
  if (!is_whole(field.kind)) {
    next = field.logarithmic && value > 0
               ? value * std::pow(field.soft_max / field.soft_min, steps / kStepsOfRange)
               : value + steps * (field.soft_max - field.soft_min) / kStepsOfRange;
    // A step needs six digits.
    const std::string digits = fmt::format("{:.6g}", next);
    std::from_chars(digits.data(), digits.data() + digits.size(), next);
  }
  return std::clamp(next, field.hard_min, field.hard_max);
}

std::string stepped_seed(const WorldField& field, int steps) {
  std::uint64_t seed = 0;
  std::from_chars(field.plain.data(), field.plain.data() + field.plain.size(), seed);
  return world::toml_seed(seed + static_cast<std::uint64_t>(std::int64_t{steps}));
}

std::string stepped_choice(const WorldField& field, int steps) {
  const auto count = static_cast<std::ptrdiff_t>(field.choices.size());
  const std::ptrdiff_t now = std::ranges::find(field.choices, field.plain) - field.choices.begin();
  const std::ptrdiff_t next = ((now + steps) % count + count) % count;
  return world::toml_string(field.choices[static_cast<std::size_t>(next)]);
}

std::filesystem::path locks_file(const std::filesystem::path& state_folder,
                                 const std::filesystem::path& world_file) {
  return state_folder / (file_key(world_file).toStdString() + ".fields");
}

}  // namespace

std::optional<std::string> random_value(const WorldField& field, std::mt19937_64& random) {
  switch (field.kind) {
    case FieldKind::kSeed:
      return world::toml_seed(random() >> 1);
    case FieldKind::kBoolean:
      return (random() >> 63) != 0 ? "true" : "false";
    case FieldKind::kChoice:
      return world::toml_string(field.choices[random() % field.choices.size()]);
    case FieldKind::kColour: {
      const double red = drawn(field, random), green = drawn(field, random);
      return fmt::format("[{}, {}, {}]", red, green, drawn(field, random));
    }
    case FieldKind::kIntegerRange:
    case FieldKind::kRealRange: {
      const double a = drawn(field, random), b = drawn(field, random);
      return world::toml_range(std::min(a, b), std::max(a, b), is_whole(field.kind));
    }
    case FieldKind::kRealPair: {
      const double x = drawn(field, random);
      return world::toml_range(x, drawn(field, random));
    }
    case FieldKind::kInteger:
    case FieldKind::kReal: {
      const double value = drawn(field, random);
      return world::toml_range(value, value, is_whole(field.kind));
    }
    case FieldKind::kIntegerPair:
    case FieldKind::kText:
    case FieldKind::kImage:
    case FieldKind::kToml:
      return {};
  }
  return {};
}

std::optional<std::string> stepped_value(const WorldField& field, int steps) {
  switch (field.kind) {
    case FieldKind::kSeed:
      return stepped_seed(field, steps);
    case FieldKind::kBoolean:
      return (steps % 2 != 0) != (field.value == "true") ? "true" : "false";
    case FieldKind::kChoice:
      return stepped_choice(field, steps);
    case FieldKind::kInteger:
    case FieldKind::kReal:
    case FieldKind::kIntegerRange:
    case FieldKind::kRealRange:
    case FieldKind::kRealPair:
      if (field.numbers.empty()) return {};
      return world::toml_range(stepped(field, field.numbers.front(), steps),
                               stepped(field, field.numbers.back(), steps), is_whole(field.kind));
    case FieldKind::kColour:
    case FieldKind::kIntegerPair:
    case FieldKind::kText:
    case FieldKind::kImage:
    case FieldKind::kToml:
      return {};
  }
  return {};
}

bool FieldLocks::is_locked(const world::TextPath& path) const {
  for (std::size_t steps = path.size(); steps > 0; --steps)
    if (paths_.contains(path.first(steps).text())) return true;
  return false;
}

void FieldLocks::set_locked(const world::TextPath& path, bool locked) {
  if (locked)
    paths_.insert(path.text());
  else
    paths_.erase(path.text());
}

void FieldLocks::note_removed(const world::TextPath& item) {
  const std::size_t gone = item.back().index;
  renumber(item.parent(), [gone](std::size_t i) -> std::optional<std::size_t> {
    if (i == gone) return {};
    return i > gone ? i - 1 : i;
  });
}

void FieldLocks::note_inserted(const world::TextPath& item) {
  const std::size_t at = item.back().index;
  renumber(item.parent(),
           [at](std::size_t i) -> std::optional<std::size_t> { return i >= at ? i + 1 : i; });
}

void FieldLocks::note_moved(const world::TextPath& item, std::size_t to) {
  const std::size_t from = item.back().index;
  renumber(item.parent(), [from, to](std::size_t i) -> std::optional<std::size_t> {
    if (i == from) return to;
    if (i > from) --i;
    return i >= to ? i + 1 : i;
  });
}

void FieldLocks::renumber(const world::TextPath& array,
                          const std::function<std::optional<std::size_t>(std::size_t)>& next) {
  std::set<std::string> moved;
  for (const std::string& text : paths_) {
    auto path = world::parse_text_path(text);
    if (path && path->size() > array.size() && path->starts_with(array) &&
        path->steps[array.size()].is_index) {
      std::size_t& index = path->steps[array.size()].index;
      const auto now = next(index);
      if (!now) continue;
      index = *now;
    }
    moved.insert(path ? path->text() : text);
  }
  paths_ = std::move(moved);
}

FieldLocks FieldLocks::load(const std::filesystem::path& state_folder,
                            const std::filesystem::path& world_file) {
  FieldLocks locks;
  const auto text = world::read_text_file(locks_file(state_folder, world_file), kMaxLockBytes);
  std::istringstream lines(text.value_or(""));
  for (std::string line; std::getline(lines, line);) {
    if (const auto path = world::parse_text_path(line); path && !path->empty())
      locks.set_locked(*path, true);
  }
  return locks;
}

core::Result<void> FieldLocks::save(const std::filesystem::path& state_folder,
                                    const std::filesystem::path& world_file) const {
  std::string text;
  for (const std::string& path : paths_)
    text += path + "\n";
  return core::replace_file(locks_file(state_folder, world_file), text);
}

}  // namespace psygen::editor
