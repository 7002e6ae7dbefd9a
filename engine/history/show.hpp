// `psygen history show`: all series of a history with their changes, as a table and as a page with
// a plot of each. The page needs no script, no network and no other files. Pure.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/history/check.hpp"

namespace psygen::history {

// A series with its changes.
struct ShownSeries {
  Series series;
  std::vector<ChangePoint> changes;
};

struct Shown {
  std::vector<ShownSeries> series;
  std::vector<std::string> notes;  // sentences
};

// Analyses a history. `tests` and `figures` choose series; empty: all. The entries must outlive the
// result. Fails with kInvalidArgument for unknown names and an empty history.
core::Result<Shown> analyse(std::span<const Entry> entries, const std::vector<std::string>& tests,
                            const std::vector<std::string>& figures);

// A table for the terminal.
std::string to_text(const Shown& shown);

// The page. `name` is the history's file. Relative paths of reports follow `base`, a path from the
// page's folder or empty. At most two megabytes for common histories: series of over 400 entries
// are condensed to medians with the range of their values, and beyond 100 plots there are tables.
std::string to_html(const Shown& shown, const std::string& name, const std::string& base = {});

}  // namespace psygen::history
