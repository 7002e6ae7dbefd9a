// What finished requests teach of one level of a type beyond its calibrated curve: a factor on all
// of it, and what cold caches add. Calibration repeats a synthesis until everything it touches is
// cached; a modeler that slept finds nothing there, and pays up to ten times as much for a small
// mesh. Medians rather than means: of a hundred requests some are interrupted. Pure; O(1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace psygen::synthesis {

// What the caches of a modeler hold of what a request needs when it claims it.
enum class Warmth : std::uint8_t {
  kWarm,   // it has run the same code since it slept
  kCold,   // it has run something else
  kWoken,  // nothing
};
inline constexpr std::size_t kWarmths = 3;

// What is predicted of a request before it is known who claims it, and when.
struct RequestCost {
  std::array<double, kWarmths> seconds{};  // of one core, by warmth
  std::size_t code = 0;                    // CostModel::code_of
  // Seconds of one core where the caches are warm, and by warmth.
  double warm_s() const { return seconds[0]; }
  double of(Warmth warmth) const { return seconds[static_cast<std::size_t>(warmth)]; }
};

// A number of seconds that follows the middle of its observations in steps of bounded size.
class LearnedSeconds {
 public:
  // `beside_s`: what is known of the whole that this is added to. A step is at most half of both.
  void observe(double seconds, double beside_s);
  // Takes over what is known elsewhere, as a first guess.
  void guess(double seconds) { value_ = seconds; }
  double value() const { return value_; }  // never below 0
  std::uint32_t count() const { return count_; }

 private:
  double value_ = 0;
  std::uint32_t count_ = 0;
};

// Added times of cold requests, of one level or of all types with the same code.
class ColdSeconds {
 public:
  static constexpr std::uint32_t kEnough = 3;  // observations that are believed
  // What a request of this warmth takes beyond a warm one.
  const LearnedSeconds& of(Warmth warmth) const { return added_[static_cast<std::size_t>(warmth)]; }
  LearnedSeconds& of(Warmth warmth) { return added_[static_cast<std::size_t>(warmth)]; }

 private:
  std::array<LearnedSeconds, kWarmths> added_;  // nothing where it is warm
};

// What finished requests teach of one level of a type.
class CostCorrection {
 public:
  // The curve was measured on this machine: one observation says little against it.
  void trust_curve() { count_ = kTrusted; }
  // On the curve's prediction; 1 until something was observed.
  double factor() const { return factor_; }

  // A request that took `seconds` where the curve says `curve_s`, both above 0; `shared` knows of
  // other levels with the same code. A cold one that took less than a warm one should lowers the
  // factor too.
  void observe(double curve_s, Warmth warmth, double seconds, ColdSeconds& shared);
  // Predicted of a request that the curve says takes `curve_s`.
  double seconds(double curve_s, Warmth warmth, const ColdSeconds& shared) const;

 private:
  void follow(double warm_s, double seconds);

  static constexpr std::uint32_t kTrusted = 10;
  double factor_ = 1;
  std::uint32_t count_ = 1;  // of observations, for the size of steps
  ColdSeconds cold_;
};

}  // namespace psygen::synthesis
