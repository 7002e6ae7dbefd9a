// Figures of a game, beside the engine's own: values that its systems report in every frame. They
// become columns of frames.csv and fields of summary.json, so that plots, budgets and comparisons
// treat them like frame times. A game declares its figures before the first frame and keeps a
// handle to each. Reporting a value is O(1) without allocation or locks, from any thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

inline constexpr std::size_t kMaxOwnFigures = 256, kMaxOwnNameBytes = 64, kMaxUnitBytes = 16;

// The value of a frame, from the values that were reported in it.
enum class FigureKind : std::uint8_t {
  kGauge,     // the last value; it stays until the next one
  kCounter,   // the sum; 0 without values
  kDuration,  // the sum of milliseconds of a real clock; 0 without values
};
std::string_view name_of(FigureKind kind);  // "gauge", "counter", "duration"

// A declaration.
struct FigureInfo {
  std::string name;       // words of a-z, 0-9 and _ with dots between them: "ai.pathfinding_ms"
  std::string unit = {};  // at most kMaxUnitBytes; durations have "ms", which need not be stated
  FigureKind kind = FigureKind::kGauge;

  friend bool operator==(const FigureInfo&, const FigureInfo&) = default;
};

// True for the names of figures, marks and sections: 1 to kMaxOwnNameBytes bytes, words of a-z, 0-9
// and _ with dots between them.
bool is_own_name(std::string_view name);

namespace detail {

// The reported values of a figure since the end of the last frame. One cache line each, so that
// threads with different figures do not wait for each other.
struct alignas(64) FigureSlot {
  explicit FigureSlot(FigureKind its_kind) : kind(its_kind) {}

  const FigureKind kind;
  std::atomic<double> value{kind == FigureKind::kGauge ? std::numeric_limits<double>::quiet_NaN()
                                                       : 0.0};
  std::atomic<std::uint64_t> invalid{0};  // values that were not finite
};

}  // namespace detail

// A handle to a figure. Copies report to the same figure. A default handle reports to none.
class OwnFigure {
 public:
  OwnFigure() = default;

  // Reports a value of this frame. Values that are not finite are left out and counted. Any thread;
  // about 10 ns.
  void report(double value);

 private:
  friend class OwnFigures;
  explicit OwnFigure(detail::FigureSlot& slot) : slot_(&slot) {}

  detail::FigureSlot* slot_ = nullptr;  // of an OwnFigures, which outlives the handle
};

// Reports the real time of a scope in milliseconds.
class ScopedTime {
 public:
  explicit ScopedTime(OwnFigure& figure);
  ~ScopedTime();
  ScopedTime(const ScopedTime&) = delete;
  ScopedTime& operator=(const ScopedTime&) = delete;

 private:
  OwnFigure& figure_;
  double start_s_;
};

// The figures of a run, in the order of their declaration. One thread, but for the handles.
class OwnFigures {
 public:
  // Declares a figure. Fails with kInvalidArgument, naming the figure, for a name that
  // is_own_name() refuses, a repeated name, a name that continues another one after a dot, a unit
  // with control characters or that is too long, a duration in another unit than ms, and after
  // close(); with kOverBudget beyond kMaxOwnFigures.
  core::Result<OwnFigure> add(FigureInfo info);
  // Ends the declarations: the columns of a run are the same in all of its frames.
  void close() { closed_ = true; }

  // The declarations. Valid until the next add().
  std::span<const FigureInfo> infos() const { return infos_; }
  // Ends a frame: replaces `values` by the value of each figure, NaN for a gauge without a value so
  // far, and begins the sums of the next frame. No allocation after the first call.
  void take(std::vector<double>& values);
  // Number of values that were not finite, of each figure.
  std::vector<std::uint64_t> invalid_counts() const;

 private:
  std::vector<FigureInfo> infos_;
  std::deque<detail::FigureSlot> slots_;  // addresses stay
  bool closed_ = false;
};

}  // namespace psygen::telemetry
