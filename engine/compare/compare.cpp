#include "engine/compare/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "engine/telemetry/statistics.hpp"

namespace psygen::compare {
namespace {

using Runs = std::span<const RecordedRun>;

// The path, clock or step in which two runs differ: "different paths: X and Y"; empty if in none.
std::string work_difference(const RecordedRun& first, const RecordedRun& other) {
  const auto differ = [](const char* what, const auto& one, const auto& two) {
    return fmt::format("different {}: {} and {}", what, one, two);
  };
  if (first.path_hash != other.path_hash && !first.path_hash.empty() && !other.path_hash.empty())
    return differ("paths", first.path_hash, other.path_hash);
  const auto clock = [](const RecordedRun& run) { return run.virtual_clock ? "virtual" : "wall"; };
  if (first.virtual_clock != other.virtual_clock)
    return differ("clocks", clock(first), clock(other));
  if (first.fixed_step != other.fixed_step)
    return differ("steps", first.fixed_step.value_or(0), other.fixed_step.value_or(0));
  return {};
}

// Returns the reason why two runs cannot be compared; empty if they can.
std::string difference(const RecordedRun& first, const RecordedRun& other) {
  const auto differ = [&](const char* what, const auto& one, const auto& two) {
    return fmt::format("{} and {} have different {}: {} and {}", first.folder, other.folder, what,
                       one, two);
  };
  if (const std::string work = work_difference(first, other); !work.empty())
    return fmt::format("{} and {} have {}", first.folder, other.folder, work);
  // On the virtual clock without a fixed step, times depend on the compared measurements.
  if (first.virtual_clock && !first.fixed_step) return {};
  if (first.frame_ms.size() != other.frame_ms.size())
    return differ("numbers of frames", first.frame_ms.size(), other.frame_ms.size());
  if (first.time_s != other.time_s)
    return fmt::format("{} and {} have frames at different times: other paths or warm-ups",
                       first.folder, other.folder);
  return {};
}

// The conditions in which two runs differ.
std::vector<std::string> differences(const RecordedRun& first, const RecordedRun& other) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < std::min(first.required.size(), other.required.size()); ++i) {
    const NamedText &one = first.required[i], &two = other.required[i];
    if (one != two)
      sentences.push_back(fmt::format("different {}: {} and {}", one.name, one.text, two.text));
  }
  return sentences;
}

// Adds a side's conditions that are only shown: each with all its values.
std::vector<NamedText> shown_of(Runs runs) {
  std::vector<NamedText> shown = runs.front().shown;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::vector<std::string> values;
    for (const RecordedRun& run : runs)
      if (i < run.shown.size()) values.push_back(run.shown[i].text);
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
    shown[i].text = values.size() > 2 ? fmt::format("{} … {}", values.front(), values.back())
                                      : fmt::format("{}", fmt::join(values, ", "));
  }
  return shown;
}

core::Result<void> check(Runs a, Runs b, Conditions conditions) {
  if (a.empty() || a.size() != b.size())
    return core::invalid_argument(
        fmt::format("a comparison needs pairs of runs; A has {} and B has {}", a.size(), b.size()));
  const RecordedRun& first = a.front();
  for (const Runs runs : {a, b}) {
    for (const RecordedRun& run : runs)
      if (std::string why = difference(first, run); !why.empty())
        return core::invalid_argument(std::move(why));
  }
  for (const Runs runs : {a, b}) {
    for (const RecordedRun& run : runs)
      if (const auto differ = differences(first, run);
          !differ.empty() && conditions == Conditions::kMustBeEqual)
        return core::invalid_argument(
            fmt::format("{} and {} are not comparable: {}; --anyway compares them", first.folder,
                        run.folder, fmt::join(differ, ", ")));
  }
  if (first.frame_ms.size() < kFewestFrames)
    return core::invalid_argument(
        fmt::format("{} has {} frames after the warm-up; a comparison needs {}", first.folder,
                    first.frame_ms.size(), kFewestFrames));
  if (first.virtual_clock) return {};
  if (!first.fixed_step)
    return core::invalid_argument(
        fmt::format("{} followed the wall clock, so its frame k does not match frame k of "
                    "another run; it needs fixed_step",
                    first.folder));
  if (a.size() < kFewestPairs)
    return core::invalid_argument(
        fmt::format("{} pairs of runs are too few; with fewer than {}, chance cannot be "
                    "ruled out",
                    a.size(), kFewestPairs));
  return {};
}

// Times of frames that no run excludes. Times below a microsecond count as one microsecond.
Times times_of(Runs runs, const std::vector<bool>& left_out,
               std::vector<double> RecordedRun::*column) {
  constexpr double kMinMs = 1e-3;
  Times times;
  for (const RecordedRun& run : runs) {
    times.emplace_back();
    for (std::size_t k = 0; k < left_out.size(); ++k)
      if (!left_out[k]) times.back().push_back(std::max((run.*column)[k], kMinMs));
  }
  return times;
}

// Compares the processor time of the main thread, if all runs have it.
std::optional<MinimaTest> cpu_test(Runs a, Runs b, const std::vector<bool>& left_out) {
  for (const Runs runs : {a, b})
    for (const RecordedRun& run : runs)
      if (run.cpu_ms.size() != left_out.size()) return std::nullopt;
  return minima_test(times_of(a, left_out, &RecordedRun::cpu_ms),
                     times_of(b, left_out, &RecordedRun::cpu_ms));
}

template <class Field>
std::vector<double> figures(Runs runs, const Field& field) {
  std::vector<double> values;
  for (const RecordedRun& run : runs)
    values.push_back(field(run));
  return values;
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::uint64_t hitchy(const Times& runs) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(runs, [](const auto& run) { return *telemetry::hitches(run) > 0; }));
}

double missing_of(const RecordedRun& run) {
  return run.missing_percent + run.coarse_percent;
}

double error_of(const RecordedRun& run) {
  return run.error_pixels;
}

Compared<double> compared(Runs a, Runs b, double (*field)(const RecordedRun&)) {
  const auto of_a = figures(a, field), of_b = figures(b, field);
  return {mean(of_a), mean(of_b), swap_test(of_a, of_b)};
}

core::Result<Batch> judge_batch(Runs a, Runs b) {
  const std::vector<bool> left_out = left_out_of(a, b);
  const Times times_a = times_of(a, left_out, &RecordedRun::frame_ms),
              times_b = times_of(b, left_out, &RecordedRun::frame_ms);
  Batch batch;
  batch.pairs = a.size();
  batch.frames = times_a.front().size();
  if (batch.frames < kFewestFrames)
    return core::invalid_argument(
        fmt::format("only {} frames are valid in all runs; a comparison needs {}", batch.frames,
                    kFewestFrames));
  batch.minima = minima_test(times_a, times_b);
  batch.cpu = cpu_test(a, b, left_out);
  batch.hitchy = {hitchy(times_a), hitchy(times_b)};
  batch.hitchy.p = fisher_more(batch.hitchy.a, a.size(), batch.hitchy.b, b.size());
  batch.missing = compared(a, b, missing_of);
  batch.error = compared(a, b, error_of);
  return batch;
}

// Findings of a batch. A finding of both batches becomes a verdict.
enum Finding {
  kMissing,
  kError,
  kSlower,
  kMoreCpu,
  kHitches,
  kFaster,  // the last two are improvements
  kLessCpu,
  kFindings
};

std::array<bool, kFindings> findings_of(const Batch& batch) {
  std::array<bool, kFindings> found{};
  constexpr double kPercent = 0.01;  // of the image: a smaller difference is invisible
  found[kMissing] = batch.missing.p <= kSignificant && batch.missing.b > batch.missing.a + kPercent;
  found[kError] = batch.error.p <= kSignificant && batch.error.b > 1.01 * batch.error.a;
  found[kSlower] = batch.minima.p_slower <= kSignificant && batch.minima.ratio > kSlowerRatio;
  found[kHitches] = batch.hitchy.p <= kSignificant;
  found[kFaster] = batch.minima.p_faster <= kSignificant && batch.minima.ratio < 1 / kSlowerRatio;
  if (batch.cpu) {
    found[kMoreCpu] = batch.cpu->p_slower <= kSignificant && batch.cpu->ratio > kSlowerRatio;
    found[kLessCpu] = batch.cpu->p_faster <= kSignificant && batch.cpu->ratio < 1 / kSlowerRatio;
  }
  return found;
}

std::string sentence_of(Finding finding, const Batch& b) {
  const double percent = 100 * std::abs(b.minima.ratio - 1);
  switch (finding) {
    case kMissing:
      return fmt::format(
          "more geometry is missing or too coarse: {:.3g} % of the image, before "
          "{:.3g} %",
          b.missing.b, b.missing.a);
    case kError:
      return fmt::format("levels of detail have a larger error: {:.3g} pixels, before {:.3g}",
                         b.error.b, b.error.a);
    case kSlower:
      return fmt::format("frames take {:.1f} % more (p {:.3f})", percent, b.minima.p_slower);
    case kHitches:
      return fmt::format("{} of {} runs have a hitch, before {} (p {:.3f})", b.hitchy.b, b.pairs,
                         b.hitchy.a, b.hitchy.p);
    case kMoreCpu:
      return fmt::format("the main thread takes {:.1f} % more processor time (p {:.3f})",
                         100 * (b.cpu->ratio - 1), b.cpu->p_slower);
    case kLessCpu:
      return fmt::format("the main thread takes {:.1f} % less processor time (p {:.3f})",
                         100 * (1 - b.cpu->ratio), b.cpu->p_faster);
    default:
      return fmt::format("frames take {:.1f} % less (p {:.3f})", percent, b.minima.p_faster);
  }
}

// The values of B, if it were better by `share` of them and `amount`.
std::vector<double> less(std::vector<double> figures, double share, double amount) {
  for (double& figure : figures)
    figure -= share * figure + amount;
  return figures;
}

// Judges all pairs together: rare slow frames, and whether B certainly shows as much as A.
void judge_all(Runs a, Runs b, Comparison& comparison) {
  const std::vector<bool> left_out = left_out_of(a, b);
  Times times = times_of(a, left_out, &RecordedRun::frame_ms);
  const Times times_b = times_of(b, left_out, &RecordedRun::frame_ms);
  comparison.tail = tail_test(times, times_b);
  times.insert(times.end(), times_b.begin(), times_b.end());
  const std::vector<double> rare = rare_frames(times);
  const auto rare_a = std::span(rare).first(a.size()), rare_b = std::span(rare).subspan(a.size());
  comparison.rare = {std::exp(mean(rare_a)), std::exp(mean(rare_b)), swap_test(rare_a, rare_b)};
  const double p_missing =
      swap_test(less(figures(b, missing_of), 0, kUnseenPercent), figures(a, missing_of));
  const double p_error =
      swap_test(less(figures(b, error_of), 1 - 1 / kUnseenErrorRatio, 0), figures(a, error_of));
  comparison.shows_as_much = std::max(p_missing, p_error) <= kLikely;
}

// Adds the reasons of a verdict and returns true if there are any.
bool judge_rare_frames(Comparison& comparison) {
  const bool tail = comparison.tail.p <= kSignificantRare && comparison.tail.ratio > kTailRatio;
  if (tail)
    comparison.reasons.push_back(
        fmt::format("the 1 % of frames that changed most take {:.2f} times as long (p {:.4f})",
                    comparison.tail.ratio, comparison.tail.p));
  const bool rare =
      comparison.rare.p <= kSignificantRare && comparison.rare.b > kRareRatio * comparison.rare.a;
  if (rare)
    comparison.reasons.push_back(fmt::format(
        "the slowest frames of a run take {:.2f} times their typical time, before {:.2f} "
        "(p {:.4f})",
        comparison.rare.b, comparison.rare.a, comparison.rare.p));
  return tail || rare;
}

bool is_narrow(const MinimaTest& test) {
  return test.low > 1 / kSlowerRatio && test.high < kSlowerRatio;
}

void conclude(Comparison& comparison) {
  const Batch& last = comparison.batches.back();
  std::array<bool, kFindings> found = findings_of(last);
  const bool confirmed = comparison.batches.size() > 1;
  std::array<bool, kFindings> first = findings_of(comparison.batches.front());
  bool worse = false, once = false;
  for (int f = 0; f < kFindings; ++f) {
    once = once || (found[static_cast<std::size_t>(f)] || first[static_cast<std::size_t>(f)]);
    found[static_cast<std::size_t>(f)] &= first[static_cast<std::size_t>(f)];
    if (!found[static_cast<std::size_t>(f)]) continue;
    comparison.reasons.push_back(sentence_of(static_cast<Finding>(f), last));
    worse = worse || f < kFaster;
  }
  worse = judge_rare_frames(comparison) || worse;
  const bool faster = found[kFaster] || found[kLessCpu];
  if (worse && faster)
    comparison.reasons.push_back("B is faster, but worse in another respect, which is not better");
  if (!confirmed && (worse || faster)) {
    comparison.reasons.push_back(fmt::format(
        "no second batch confirms the difference: record {} pairs or more", 2 * kFewestPairs));
    return;
  }
  const bool narrow = is_narrow(last.minima) && (!last.cpu || is_narrow(*last.cpu));
  const bool same = narrow && !once;
  if (worse) {
    comparison.verdict = Verdict::kWorse;
  } else if ((faster || same) && !comparison.shows_as_much) {
    comparison.reasons.push_back(fmt::format(
        "missing geometry and its error vary too much from run to run to tell whether B "
        "shows as much: {:.3g} and {:.3g} % of the image, error {:.3g} and {:.3g} pixels",
        last.missing.a, last.missing.b, last.error.a, last.error.b));
  } else if (faster || same) {
    comparison.verdict = faster ? Verdict::kBetter : Verdict::kSame;
  } else {
    comparison.reasons.push_back(
        once ? "one batch found a difference that the other did not confirm"
             : fmt::format("noise hides changes below {:.1f} %", comparison.noise_percent));
  }
}

// Exact comparison without noise: every difference is a change.
core::Result<Comparison> compare_exactly(Runs a, Runs b) {
  for (const Runs runs : {a, b}) {
    for (const RecordedRun& run : runs)
      if (run.frame_ms != runs.front().frame_ms || run.time_s != runs.front().time_s)
        return core::invalid_argument(
            fmt::format("{} and {} belong to one set on the virtual clock, but differ",
                        runs.front().folder, run.folder));
  }
  Comparison comparison;
  comparison.exact = true;
  const RecordedRun &x = a.front(), &y = b.front();
  Batch batch;
  batch.pairs = 1;
  batch.frames = x.frame_ms.size();
  batch.missing = compared(a.first(1), b.first(1), missing_of);
  batch.error = compared(a.first(1), b.first(1), error_of);
  batch.minima.ratio = batch.minima.low = batch.minima.high = mean(y.frame_ms) / mean(x.frame_ms);
  batch.missing.p = batch.error.p = batch.minima.p_slower = batch.minima.p_faster = 0;
  comparison.batches.push_back(batch);
  const bool less = batch.missing.b > batch.missing.a || y.holes > x.holes;
  const bool coarser = batch.error.b > batch.error.a;
  if (less) comparison.reasons.push_back(sentence_of(kMissing, batch));
  if (coarser) comparison.reasons.push_back(sentence_of(kError, batch));
  const bool slower = batch.minima.ratio > 1, faster = batch.minima.ratio < 1;
  if (slower)
    comparison.reasons.push_back(
        fmt::format("frames take {:.2f} % more", 100 * (batch.minima.ratio - 1)));
  if (faster)
    comparison.reasons.push_back(
        fmt::format("frames take {:.2f} % less", 100 * (1 - batch.minima.ratio)));
  if (faster && (less || coarser))
    comparison.reasons.push_back("B is faster, but its image is worse, which is not better");
  const bool differ =
      x.frame_ms != y.frame_ms || x.time_s != y.time_s || batch.missing.a != batch.missing.b;
  comparison.verdict = less || coarser || slower ? Verdict::kWorse
                       : faster                  ? Verdict::kBetter
                       : differ                  ? Verdict::kInconclusive
                                                 : Verdict::kSame;
  if (comparison.verdict == Verdict::kInconclusive)
    comparison.reasons.push_back(
        "the runs differ, but neither the mean time nor the image is worse");
  return comparison;
}

bool pictures_differ(Runs a, Runs b) {
  const auto constant = [](Runs runs) {
    return std::ranges::all_of(runs, [&](const RecordedRun& run) {
      return !run.images_hash.empty() && run.images_hash == runs.front().images_hash;
    });
  };
  return constant(a) && constant(b) && a.front().images_hash != b.front().images_hash;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"same", "worse", "better", "inconclusive"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::vector<std::string> differences_of(const RecordedRun& first, const RecordedRun& other) {
  std::vector<std::string> found;
  if (std::string work = work_difference(first, other); !work.empty())
    found.push_back(std::move(work));
  const bool fixed = first.fixed_step && first.fixed_step == other.fixed_step;
  if (fixed && first.measured_frames != other.measured_frames)
    found.push_back(fmt::format("different numbers of frames: {} and {}", first.measured_frames,
                                other.measured_frames));
  for (std::string& sentence : differences(first, other))
    found.push_back(std::move(sentence));
  return found;
}

core::Result<Comparison> compare(Runs a, Runs b, Conditions conditions) {
  if (auto ok = check(a, b, conditions); !ok) return tl::unexpected(ok.error());
  core::Result<Comparison> result = Comparison{};
  if (a.front().virtual_clock) {
    result = compare_exactly(a, b);
  } else {
    const bool two = a.size() >= 2 * kFewestPairs;
    const std::size_t half = std::min(two ? a.size() / 2 : a.size(), kMaxPairs);
    for (std::size_t from = 0; from == 0 || (two && from == half); from += half) {
      auto batch = judge_batch(a.subspan(from, half), b.subspan(from, half));
      if (!batch) return tl::unexpected(batch.error());
      result->batches.push_back(std::move(*batch));
    }
    if (two) judge_all(a.first(2 * half), b.first(2 * half), *result);
    const Batch& last = result->batches.back();
    result->noise_percent = 50 * (last.minima.high - last.minima.low);
    if (last.cpu)
      result->noise_percent =
          std::max(result->noise_percent, 50 * (last.cpu->high - last.cpu->low));
    conclude(*result);
  }
  if (result) {
    for (const Runs runs : {a, b})
      for (const RecordedRun& run : runs)
        for (std::string& sentence : differences(a.front(), run))
          if (std::ranges::find(result->differences, sentence) == result->differences.end())
            result->differences.push_back(std::move(sentence));
    result->shown = {shown_of(a), shown_of(b)};
    constexpr std::size_t kMaxRuns = 100;  // of mann_whitney()
    result->figures = compare_figures(a.first(std::min(a.size(), kMaxRuns)),
                                      b.first(std::min(b.size(), kMaxRuns)));
  }
  if (!result || !pictures_differ(a, b)) return result;
  result->reasons.push_back("the images differ: inspect them");
  if (result->verdict != Verdict::kWorse) result->verdict = Verdict::kInconclusive;
  return result;
}

core::Result<FalseAlarms> measure_false_alarms(Runs runs, std::size_t count, std::uint64_t seed) {
  constexpr std::size_t kPairs = kFewestPairs + 1;
  if (runs.size() < 2 * kPairs)
    return core::invalid_argument(
        fmt::format("measuring false alarms needs {1} runs, not {0}", runs.size(), 2 * kPairs));
  std::mt19937_64 random(seed);
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  FalseAlarms alarms;
  for (; alarms.comparisons < count; ++alarms.comparisons) {
    std::vector<RecordedRun> a, b;
    for (int batch = 0; batch < 2; ++batch) {
      for (std::size_t i = order.size() - 1; i > 0; --i)  // the same order on every machine
        std::swap(order[i], order[random() % (i + 1)]);
      for (std::size_t i = 0; i < kPairs; ++i) {
        a.push_back(runs[order[2 * i]]);
        b.push_back(runs[order[2 * i + 1]]);
      }
    }
    const auto result = compare(a, b);
    if (!result) return tl::unexpected(result.error());
    alarms.worse += result->verdict == Verdict::kWorse ? 1U : 0U;
    alarms.better += result->verdict == Verdict::kBetter ? 1U : 0U;
    alarms.inconclusive += result->verdict == Verdict::kInconclusive ? 1U : 0U;
  }
  return alarms;
}

}  // namespace psygen::compare
