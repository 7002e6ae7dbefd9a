// The scale of a number's slider: from a share of its usual range to a value and back, evenly or by
// factors. Values have the few digits that a slider means. Pure.
#pragma once

#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

// The number nearest to `value` that three decimal digits write, so that files have 0.7 and not
// 0.7000000000000001.
double with_digits(double value);

struct Scale {
  double low = 0, high = 1;  // low < high; above 0 if logarithmic
  bool logarithmic = false;
  bool whole = false;

  // The value at a share of the range, 0 to 1; the ends are exact.
  double at(double share) const;
  // The share at which a value is; values outside the range are at its ends.
  double share_of(double value) const;
};

// Of the usual range of a field of numbers.
Scale scale_of(const world::WorldField& field);
// Whether its numbers are integers.
bool is_whole(world::FieldKind kind);

}  // namespace psygen::editor
