#include "engine/history/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/history/scan.hpp"

namespace psygen::history {
namespace {

using Observations = std::span<const Observation>;

// The step that 95 of 100 checks find, in spreads of a run (docs/frame-tests.md, "History").
double spreads_seen(std::size_t before) {
  return before >= 35 ? 2.7 : before >= 20 ? 2.9 : before >= 10 ? 3.1 : 4.0;
}

std::optional<double> median_work(Observations runs) {
  std::vector<double> models;
  for (const Observation& run : runs)
    if (run.work) models.push_back(*run.work);
  if (models.empty()) return std::nullopt;
  return median(models);
}

// Cuts the runs before to the last ones without a change in them.
Observations recent(const FigureRule& rule, Observations before, RankTails& tails) {
  before = before.last(std::min(before.size(), kMaxBefore));
  const auto changes = change_points(scaled(rule, before, false), rule.floor, tails);
  if (changes.empty()) return before;
  return before.subspan(changes.back().at);
}

struct Look {
  Witness figure;
  std::optional<Witness> ratio;
  int found() const {  // 1: both witnesses rise, −1: both fall
    return !ratio || ratio->found == figure.found ? figure.found : 0;
  }
};

Look look_at(const FigureRule& rule, Observations before, Observations after, double significant,
             RankTails& tails) {
  Look look;
  look.figure = test_step(scaled(rule, before, false), scaled(rule, after, false), rule.floor,
                          significant, tails);
  if (!rule.has_reference) return look;
  const auto ratio_before = scaled(rule, before, true), ratio_after = scaled(rule, after, true);
  if (ratio_before.empty() && ratio_after.empty()) return look;
  if (std::min(ratio_before.size(), ratio_after.size()) < kFewestRuns)
    look.ratio = Witness{};  // some runs have one: too few to confirm anything
  else
    look.ratio = test_step(ratio_before, ratio_after, rule.floor, significant, tails);
  return look;
}

std::string found_sentence(const FigureRule& rule, const Look& look, int looks) {
  std::string text =
      fmt::format("{} (p {:.2g}", change_text(rule, look.figure.effect), look.figure.p);
  if (look.ratio)
    text += fmt::format("; as ratio to the reference load {}, p {:.2g}",
                        change_text(rule, look.ratio->effect), look.ratio->p);
  else if (rule.has_reference)
    text += "; no reference load was recorded, so a slower machine looks the same";
  return text + (looks == 2 ? "), confirmed by a second look" : "), one look");
}

std::string undecided_sentence(const FigureRule& rule, const Look& look, double unseen) {
  if (look.ratio && look.figure.found != 0 && look.ratio->found == 0)
    return fmt::format("{}, but not as ratio to the reference load ({}): the machine may differ",
                       change_text(rule, look.figure.effect),
                       change_text(rule, look.ratio->effect));
  if (look.ratio && look.figure.found == 0 && look.ratio->found != 0)
    return fmt::format("only the ratio to the reference load changed ({}; the figure {})",
                       change_text(rule, look.ratio->effect),
                       change_text(rule, look.figure.effect));
  if (look.ratio && look.figure.found != look.ratio->found)
    return "the figure and its ratio to the reference load changed in opposite directions";
  return rule.logarithms
             ? fmt::format("changes under {:.0f} % would stay unseen", 100 * std::expm1(unseen))
             : fmt::format("changes under {:.2g} would stay unseen", unseen);
}

// Concludes from one look, or from two at the halves of the runs after.
void conclude(const FigureRule& rule, std::span<const Look> looks, GateVerdict& verdict) {
  const Look& first = looks.front();
  verdict.figure = first.figure;
  verdict.ratio = first.ratio;
  verdict.looks = static_cast<int>(looks.size());
  verdict.unseen = std::max(spreads_seen(verdict.before) * first.figure.spread, rule.floor);
  const int found = first.found();
  const bool confirmed =
      std::ranges::all_of(looks, [found](const Look& look) { return look.found() == found; });
  if (found != 0 && confirmed) {
    verdict.outcome = (found > 0) == rule.more_is_worse ? Outcome::kWorse : Outcome::kBetter;
    verdict.reason = found_sentence(rule, first, verdict.looks);
    return;
  }
  verdict.outcome = Outcome::kUndecided;
  if (!confirmed) {
    verdict.reason = fmt::format("the first {} runs and the later ones do not agree: {} and {}",
                                 verdict.after / 2, change_text(rule, first.figure.effect),
                                 change_text(rule, looks.back().figure.effect));
    return;
  }
  const bool nothing = first.figure.found == 0 && (!first.ratio || first.ratio->found == 0);
  if (nothing && verdict.unseen <= rule.wanted) {
    verdict.outcome = Outcome::kSame;
    verdict.reason =
        fmt::format("{} (p {:.2g})", change_text(rule, first.figure.effect), first.figure.p);
    return;
  }
  verdict.reason = undecided_sentence(rule, first, verdict.unseen);
}

// A sentence if the runs made different numbers of models.
std::string different_work(Observations before, Observations after) {
  const auto old_work = median_work(before), new_work = median_work(after);
  if (!old_work || !new_work) return "";
  if (std::abs(*new_work - *old_work) <= kSameWork * std::max(*old_work, *new_work)) return "";
  return fmt::format("different work: {:.0f} models, {:.0f} before; a history needs fixed work",
                     *new_work, *old_work);
}

}  // namespace

std::vector<double> scaled(const FigureRule& rule, Observations runs, bool ratio) {
  std::vector<double> values;
  for (const Observation& run : runs) {
    if (ratio && !run.reference) continue;
    const double value = rule.logarithms ? std::log(run.value) : run.value;
    const double speed = rule.more_is_worse ? 1.0 : -1.0;  // a rate falls on a slower machine
    values.push_back(ratio ? value - speed * std::log(*run.reference) : value);
  }
  return values;
}

std::string_view name_of(Outcome outcome) {
  constexpr std::array<std::string_view, 6> kNames = {"same",      "worse",          "better",
                                                      "undecided", "different work", "too few"};
  return kNames[static_cast<std::size_t>(outcome)];
}

Witness test_step(std::span<const double> before, std::span<const double> after, double floor,
                  double significant, RankTails& tails) {
  Witness witness;
  const double old_median = median(before), new_median = median(after);
  witness.effect = new_median - old_median;
  std::vector<double> residuals;
  for (const double value : before)
    residuals.push_back(value - old_median);
  for (const double value : after)
    residuals.push_back(value - new_median);
  const double correlation = rank_correlation(residuals, 0);
  for (double& each : residuals)
    each = std::abs(each);
  witness.spread = kRobust * median(residuals);
  witness.p = tails.p(before.size(), after.size(), pairs_above(before, after));
  if (correlation > 0) witness.p = p_of(corrected(z_of(witness.p), correlation));
  // Rounding must not hide a change of exactly the floor.
  const double least = std::max(floor, kMinSpreads * witness.spread) * (1 - 1e-9);
  if (witness.p <= significant && std::abs(witness.effect) >= least)
    witness.found = witness.effect > 0 ? 1 : -1;
  return witness;
}

GateVerdict judge(const FigureRule& rule, Observations before, Observations after,
                  std::size_t figures, RankTails& tails) {
  GateVerdict verdict;
  // More runs add little, and the distribution of U would cost more.
  after = after.first(std::min(after.size(), kMaxBefore));
  before = recent(rule, before, tails);
  verdict.before = before.size();
  verdict.after = after.size();
  if (std::min(before.size(), after.size()) < kFewestRuns) {
    verdict.reason = fmt::format("{} before and {} of this revision; each side needs {}",
                                 before.size(), after.size(), kFewestRuns);
    return verdict;
  }
  const bool measures_work = rule.kind != FigureKind::kCount && rule.kind != FigureKind::kBytes;
  if (const std::string why = different_work(before, after); measures_work && !why.empty()) {
    verdict.outcome = Outcome::kDifferentWork;
    verdict.reason = why;
    return verdict;
  }
  constexpr std::size_t kRunsForManyFigures = 20;
  const double significant =
      before.size() >= kRunsForManyFigures
          ? kSignificant / static_cast<double>(std::max<std::size_t>(figures, 1))
          : kSignificant;
  if (after.size() < kSecondLook) {
    const std::array looks = {look_at(rule, before, after, significant, tails)};
    conclude(rule, looks, verdict);
    return verdict;
  }
  const std::size_t half = after.size() / 2;
  const std::array looks = {look_at(rule, before, after.first(half), significant, tails),
                            look_at(rule, before, after.subspan(half), significant, tails)};
  conclude(rule, looks, verdict);
  return verdict;
}

}  // namespace psygen::history
