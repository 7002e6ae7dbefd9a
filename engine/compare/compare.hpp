// The verdict on two sets of runs: is B slower, faster or the same, and does it show less? Exact
// gates come first: what is wrong with the picture is never outweighed by speed. Statistics are
// statistics.hpp's; runs are recorded_run.hpp's. Pure.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/compare/recorded_run.hpp"
#include "engine/compare/statistics.hpp"
#include "engine/core/error.hpp"

namespace psygen::compare {

enum class Verdict : std::uint8_t { kSame, kWorse, kBetter, kInconclusive };
std::string_view name_of(Verdict verdict);  // "same", "worse", …

// Limits of the verdict.
inline constexpr double kSignificant = 0.01;
inline constexpr double kSlowerRatio = 1.03;
// Of few frames, which are judged once, over all pairs.
inline constexpr double kSignificantRare = 0.001, kTailRatio = 1.2, kRareRatio = 1.1;
// So much more may be missing, in percent of the picture, and so much larger may the error be,
// without being seen. "Better" needs that chance alone hides no more.
inline constexpr double kUnseenPercent = 0.25, kUnseenErrorRatio = 1.02, kLikely = 0.05;
inline constexpr std::size_t kFewestFrames = 50;

// What one batch of pairs says.
struct Batch {
  std::size_t pairs = 0, frames = 0;
  MinimaTest minima;
  std::optional<MinimaTest> cpu;  // of the main thread's processor time; none on the virtual clock
  std::uint64_t hitchy_a = 0, hitchy_b = 0;  // runs with a hitch
  double p_hitchy = 1;
  double missing_a = 0, missing_b = 0, p_missing = 1;  // percent of the picture, holes and coarse
  double error_a = 0, error_b = 0, p_error = 1;        // pixels, of levels of detail
};

struct Comparison {
  Verdict verdict = Verdict::kInconclusive;
  std::vector<std::string> reasons;  // sentences
  // Half of the interval of the ratio, of the last batch; the wider of frame and processor time.
  double noise_percent = 0;
  bool exact = false;  // by the virtual clock: no statistics
  // Over all pairs of two batches: the frames that changed most, and how many times their usual
  // time rare frames take (rare_frames()), mean of the runs.
  TailTest tail;
  double rare_a = 1, rare_b = 1, p_rare = 1;
  bool shows_as_much = true;  // the noise hides no picture of B that lacks more than is unseen
  std::vector<Batch> batches;
};

// Judges runs a[i] and b[i], which are pairs in the order of recording. The second half confirms
// what the first half says; fewer than twice kFewestPairs leave a difference unconfirmed, and the
// verdict inconclusive. Runs on the virtual clock must be the same in each set; one of each is
// enough. Fails with kInvalidArgument for sets that cannot be compared: other worlds, sizes, steps
// or lengths, too few pairs or frames.
core::Result<Comparison> compare(std::span<const RecordedRun> a, std::span<const RecordedRun> b);

// How often the procedure says that a set is worse, or better, than itself.
struct FalseAlarms {
  std::size_t comparisons = 0, worse = 0, better = 0, inconclusive = 0;
};
// Draws `count` comparisons of `runs` with themselves: two batches of kFewestPairs + 1 pairs of
// runs at random, each run at most once in a batch. The same `seed` draws the same. Fails as
// compare(), and below 2 (kFewestPairs + 1) runs.
core::Result<FalseAlarms> measure_false_alarms(std::span<const RecordedRun> runs, std::size_t count,
                                               std::uint64_t seed);

// For people, and compare.json ("psygen.compare/1"). `alarms` may be null.
std::string to_text(const Comparison& comparison, const FalseAlarms* alarms);
std::string to_json(const Comparison& comparison, const FalseAlarms* alarms);

}  // namespace psygen::compare
