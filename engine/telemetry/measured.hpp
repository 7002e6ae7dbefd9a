// A figure that may be missing, with the reason why: too few frames, a world without an end, a
// device that cannot tell. Becomes a number, or null with a reason, in summary.json.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace psygen::telemetry {

template <class T>
struct Measured {
  std::optional<T> value;
  std::string reason = "not measured in this run";  // a sentence; empty where there is a value

  Measured() = default;
  Measured(T known) : value(std::move(known)), reason() {}  // a figure is its value
  static Measured missing(std::string why) {
    Measured result;
    result.reason = std::move(why);
    return result;
  }

  bool has_value() const { return value.has_value(); }
  const T& operator*() const { return *value; }  // requires has_value()
  friend bool operator==(const Measured&, const Measured&) = default;
};

using Figure = Measured<double>;

}  // namespace psygen::telemetry
