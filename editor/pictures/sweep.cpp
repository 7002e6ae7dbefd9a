#include "editor/pictures/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "editor/document/field_value.hpp"
#include "editor/document/scale.hpp"
#include "engine/core/hash.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

using world::FieldKind;

constexpr std::uint64_t kSeeds = 100'000;  // short numbers are easy to write down

// The value at a fraction of the soft range.
double value_at(const world::WorldField& field, double fraction) {
  return std::clamp(scale_of(field).at(fraction), field.hard_min, field.hard_max);
}

std::string number_toml(const world::WorldField& field, double v) {
  if (field.kind == FieldKind::kInteger)
    return world::toml_number(static_cast<std::int64_t>(std::llround(v)));
  if (field.kind == FieldKind::kReal) return world::toml_number(v);
  const double half = field.numbers.size() == 2 ? (field.numbers[1] - field.numbers[0]) / 2 : 0;
  const double low = std::clamp(with_digits(v - half), field.hard_min, field.hard_max);
  const double high = std::clamp(with_digits(v + half), low, field.hard_max);
  return world::toml_range(low, high, is_whole(field.kind));
}

std::vector<std::string> seeds_of(const world::WorldField& field, std::size_t count,
                                  std::uint64_t page) {
  std::vector<std::string> values;
  if (page == 0 && !field.value.empty()) values.push_back(field.value);
  for (std::uint64_t i = 0; values.size() < count; ++i) {
    const std::uint64_t seed = core::mix64(page * kSeeds + i) % kSeeds;
    std::string value = world::toml_seed(seed);
    if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
  }
  return values;
}

}  // namespace

bool can_sweep(const world::WorldField& field) {
  switch (field.kind) {
    case FieldKind::kInteger:
    case FieldKind::kReal:
    case FieldKind::kIntegerRange:
    case FieldKind::kRealRange:
      return field.soft_max > field.soft_min;
    case FieldKind::kSeed:
    case FieldKind::kBoolean:
      return true;
    case FieldKind::kChoice:
      return field.choices.size() > 1;
    default:
      return false;
  }
}

std::vector<std::string> sweep_values(const world::WorldField& field, std::size_t count,
                                      std::uint64_t page) {
  std::vector<std::string> values;
  if (!can_sweep(field) || count == 0) return values;
  if (field.kind == FieldKind::kSeed) return seeds_of(field, count, page);
  if (field.kind == FieldKind::kBoolean) {
    values = {"false", "true"};
  } else if (field.kind == FieldKind::kChoice) {
    for (const std::string& choice : field.choices)
      values.push_back(world::toml_string(choice));
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      const double fraction =
          count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
      std::string value = number_toml(field, value_at(field, fraction));
      if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
    }
  }
  if (values.size() > count) values.resize(count);
  return values;
}

core::Result<std::vector<SweepCell>> sweep_cells(const std::string& text, const ParsedWorld& world,
                                                 const std::vector<world::WorldField>& fields,
                                                 std::size_t rows, std::size_t columns,
                                                 std::uint64_t page) {
  std::vector<SweepCell> cells;
  const auto add = [&](std::vector<std::string> values) -> core::Result<void> {
    SweepCell cell{.values = std::move(values), .text = text};
    for (std::size_t i = 0; i < fields.size(); ++i) {
      auto changed = with_field_value(cell.text, world, fields[i].path, cell.values[i]);
      if (!changed) return tl::unexpected(changed.error());
      cell.text = *std::move(changed);
    }
    cells.push_back(std::move(cell));
    return {};
  };
  if (fields.size() == 1) {
    for (std::string& value : sweep_values(fields[0], rows * columns, page))
      if (auto ok = add({std::move(value)}); !ok) return tl::unexpected(ok.error());
  } else if (fields.size() == 2) {
    const auto along = sweep_values(fields[0], columns, page);
    for (const std::string& down : sweep_values(fields[1], rows, page)) {
      for (const std::string& value : along)
        if (auto ok = add({value, down}); !ok) return tl::unexpected(ok.error());
    }
  }
  return cells;
}

}  // namespace psygen::editor
