// `psygen history check` and the analysis behind `show`: groups entries into series that may be
// compared, and judges the last revision of each test. Series never join fingerprints or units.
// Pure.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/history/entry.hpp"
#include "engine/history/gate.hpp"
#include "engine/history/scan.hpp"
#include "engine/telemetry/remarks.hpp"

namespace psygen::history {

// The entries of one test, figure, unit and fingerprint that have a usable value, in the order of
// adding. They point into the entries that were given.
struct Series {
  const Entry* first = nullptr;  // for the names
  FigureRule rule;
  std::vector<const Entry*> entries;
  std::size_t left_out = 0;  // without a value, or 0 and below on a scale of logarithms
};

// True if series use the entry: it has a value, above 0 on a scale of logarithms.
bool is_usable(const Entry& entry, const FigureRule& rule);
// The gate compares these values of usable entries. It ignores a reference of 0 and below.
std::vector<Observation> observations_of(std::span<const Entry* const> entries);

// Fails with kInvalidArgument if no entry has one of the words in its field, which messages call
// `what`, and suggests the nearest.
core::Result<void> check_words(std::span<const Entry> entries,
                               const std::vector<std::string>& words, std::string Entry::*field,
                               const char* what);
// True if a name is one of these, or there are none.
bool is_chosen(const std::vector<std::string>& names, const std::string& name);

// All series, by test, figure, fingerprint and unit. O(n log n).
std::vector<Series> series_of(std::span<const Entry> entries);

// The changes of a series: of its ratio to the reference load if all entries have one.
std::vector<ChangePoint> changes_of(const Series& series, RankTails& tails);

// Sentences about a history as a whole: values left out, units that change, clocks that go back,
// and tests without a run in the last ten revisions, which may have been renamed.
std::vector<std::string> remarks_on(std::span<const Entry> entries, std::span<const Series> series);

struct CheckOptions {
  std::vector<std::string> tests = {};    // empty: all
  std::vector<std::string> figures = {};  // that take part in the verdict; empty: the usual ones
  std::string revision = {};              // to be judged; empty: the last one of each test
  std::size_t last = 0;  // judges so many last entries instead; 0: those of a revision
  bool confirm = false;  // a change for the worse needs a second look
};

struct JudgedFigure {
  std::string test, figure, unit, revision, fingerprint;
  bool gates = false;
  FigureRule rule;
  GateVerdict verdict;
  double before = 0, after = 0;  // medians of the values; 0: none
};

struct CheckResult {
  // kWorse if a figure that gates is worse; then the outcome that says least.
  Outcome outcome = Outcome::kTooFew;
  std::vector<JudgedFigure> figures;
  std::vector<std::string> notes;  // sentences
};

// Judges a history. Fails with kInvalidArgument for unknown tests, figures and revisions, and for
// an empty history.
core::Result<CheckResult> check(std::span<const Entry> entries, const CheckOptions& options);

// Text for the terminal, and JSON ("psygen.history-check/1").
std::string to_text(const CheckResult& result);
std::string to_json(const CheckResult& result);

// The result on a pull request: Markdown, and a remark for each figure that decides and each note.
std::string to_markdown(const CheckResult& result);
std::vector<telemetry::Remark> remarks_of(const CheckResult& result);

}  // namespace psygen::history
