// A number that may be missing, with the reason: too few frames, an endless world, a GPU without
// timestamps. In summary.json it becomes a number, or null with a reason. Not an Error: nothing
// failed. A plain value.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace psygen::telemetry {

// A value, or the reason for its absence.
template <class T>
struct Measured {
  std::optional<T> value;
  std::string reason = "not measured in this run";  // a phrase; empty if there is a value

  // Missing with the default reason, or known. The conversion is implicit on purpose.
  Measured() = default;
  Measured(T known) : value(std::move(known)), reason() {}
  // Missing for this reason.
  static Measured missing(std::string why) {
    Measured result;
    result.reason = std::move(why);
    return result;
  }

  // True if the value is known, which operator* requires.
  bool has_value() const { return value.has_value(); }
  const T& operator*() const { return *value; }
  friend bool operator==(const Measured&, const Measured&) = default;
};

// A measured real number.
using Figure = Measured<double>;

}  // namespace psygen::telemetry
