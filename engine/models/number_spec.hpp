// Description of a number that is not a parameter of a model type, for editors: unit, allowed and
// usual range, and a line of help. The lists of such numbers (tree/species.hpp,
// world/files/fields.hpp) are visited with it. Parameters of types have a ParameterSpec
// (model_type.hpp). Plain values.
#pragma once

#include <string_view>

namespace psygen::models {

// The strings are literals.
struct NumberSpec {
  double low = 0, high = 0;            // values outside are rejected
  double soft_low = 0, soft_high = 0;  // the range of a slider
  std::string_view unit;               // "m", "degrees"; "" for none
  std::string_view doc;                // one line for users
};

}  // namespace psygen::models
