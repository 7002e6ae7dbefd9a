// Verdict on two sets of runs: B is slower, faster or the same as A, and shows less or as much.
// Exact criteria come first: speed never outweighs a worse image. Statistics are in statistics.hpp,
// runs in recorded_run.hpp. Pure.
#pragma once

#include <array>
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
// For rare slow frames, judged once over all pairs.
inline constexpr double kSignificantRare = 0.001, kTailRatio = 1.2, kRareRatio = 1.1;
// Invisible differences: additional missing geometry in percent of the image, and ratio of the
// errors. "Better" requires that, except with probability kLikely, the noise hides no larger
// difference.
inline constexpr double kUnseenPercent = 0.25, kUnseenErrorRatio = 1.02, kLikely = 0.05;
inline constexpr std::size_t kFewestFrames = 50;

// A quantity of both sides, and the probability of the difference by chance.
template <class T>
struct Compared {
  T a{}, b{};
  double p = 1;
};

// Result of one batch of pairs.
struct Batch {
  std::size_t pairs = 0, frames = 0;
  MinimaTest minima;
  std::optional<MinimaTest> cpu;   // of the main thread's processor time; none on the virtual clock
  Compared<std::uint64_t> hitchy;  // runs with a hitch
  Compared<double> missing;        // percent of the image, missing or coarse
  Compared<double> error;          // pixels, of LODs
};

struct Comparison {
  Verdict verdict = Verdict::kInconclusive;
  std::vector<std::string> reasons;  // sentences
  // Conditions in which the runs differ although they were compared: "different CPU: X and Y".
  std::vector<std::string> differences;
  // Conditions that are only shown, of each side: revision, compiler, load.
  std::array<std::vector<NamedText>, 2> shown;
  // Half of the ratio's confidence interval in the last batch, for frame time or processor time,
  // whichever is wider.
  double noise_percent = 0;
  bool exact = false;  // on the virtual clock: no statistics
  // Over all pairs of two batches: the frames that changed most, and the ratio of rare slow frames
  // to their typical time (rare_frames(), mean over the runs).
  TailTest tail;
  Compared<double> rare{1, 1, 1};
  bool shows_as_much = true;  // no visible loss of B is hidden by noise
  std::vector<Batch> batches;
  std::vector<ComparedFigure> figures;  // of the game, over all runs; they decide nothing
};

// Judges runs a[i] and b[i], which are pairs in the order of recording. The second half confirms
// the first; with fewer than twice kFewestPairs pairs a difference is unconfirmed, and the verdict
// inconclusive. Runs of one set on the virtual clock must be equal; one of each is enough. Fails
// with kInvalidArgument for sets that are not comparable: other worlds, sizes, steps or lengths,
// too few pairs or frames. Also fails for runs under other conditions (RecordedRun::required),
// which the message names, unless others are accepted; then `differences` has them.
enum class Conditions : std::uint8_t { kMustBeEqual, kAcceptOthers };
core::Result<Comparison> compare(std::span<const RecordedRun> a, std::span<const RecordedRun> b,
                                 Conditions conditions = Conditions::kMustBeEqual);

// Why figures of `other` say nothing beside those of `first`, by the rule of compare(): another
// path, clock or step, another number of frames of fixed steps, or other conditions
// (RecordedRun::required). Phrases; none if they can be compared. Uses no frames.
std::vector<std::string> differences_of(const RecordedRun& first, const RecordedRun& other);

// False alarm rate: verdicts "worse" and "better" of comparisons of a set with itself.
struct FalseAlarms {
  std::size_t comparisons = 0, worse = 0, better = 0, inconclusive = 0;
};
// Draws `count` comparisons of `runs` with themselves: two batches of kFewestPairs + 1 random
// pairs, each run at most once in a batch. Deterministic for a `seed`. Fails like compare(), and
// below 2 (kFewestPairs + 1) runs.
core::Result<FalseAlarms> measure_false_alarms(std::span<const RecordedRun> runs, std::size_t count,
                                               std::uint64_t seed);

// Text for the terminal, and compare.json ("psygen.compare/1"). `alarms` may be null.
std::string to_text(const Comparison& comparison, const FalseAlarms* alarms);
std::string to_json(const Comparison& comparison, const FalseAlarms* alarms);

}  // namespace psygen::compare
