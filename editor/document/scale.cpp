#include "editor/document/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace psygen::editor {

double with_digits(double value) {
  const std::string digits = fmt::format("{:.3g}", value);
  double read = value;
  std::from_chars(digits.data(), digits.data() + digits.size(), read);
  return read;
}

double Scale::at(double fraction) const {
  if (fraction <= 0) return low;
  if (fraction >= 1) return high;
  const double value =
      logarithmic ? low * std::pow(high / low, fraction) : low + fraction * (high - low);
  return std::clamp(whole ? std::round(value) : with_digits(value), low, high);
}

double Scale::fraction_of(double value) const {
  if (!(high > low)) return 0;
  const double v = std::clamp(value, low, high);
  return logarithmic ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
}

Scale scale_of(const world::WorldField& field) {
  return {field.soft_min, field.soft_max, field.logarithmic, is_whole(field.kind)};
}

bool is_whole(world::FieldKind kind) {
  return kind == world::FieldKind::kInteger || kind == world::FieldKind::kIntegerRange ||
         kind == world::FieldKind::kIntegerPair;
}

}  // namespace psygen::editor
