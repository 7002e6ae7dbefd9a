// The scale of a number's slider: converts a fraction of the soft range to a value and back, on a
// linear or logarithmic scale. Values have at most three significant digits. Pure.
#pragma once

#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

// Rounds to three significant digits, so that files contain 0.7 and not 0.7000000000000001.
double with_digits(double value);

struct Scale {
  double low = 0, high = 1;  // low < high; above 0 if logarithmic
  bool logarithmic = false;
  bool whole = false;

  // The value at a fraction of the range, 0 to 1; the ends are exact.
  double at(double fraction) const;
  // The fraction of a value; values outside the range are at its ends.
  double fraction_of(double value) const;
};

// The scale of the soft range of a field of numbers.
Scale scale_of(const world::WorldField& field);
// True if the numbers of such fields are integers.
bool is_whole(world::FieldKind kind);

}  // namespace psygen::editor
