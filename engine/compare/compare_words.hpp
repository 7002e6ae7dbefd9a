// Words about a comparison on a pull request: Markdown, and remarks for annotations. Pure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/compare/compare.hpp"
#include "engine/compare/instructions.hpp"
#include "engine/compare/times.hpp"
#include "engine/telemetry/remarks.hpp"

namespace psygen::compare {

// `worse` is an error, `inconclusive` a warning, and the others notices. Differences of conditions
// and warnings are warnings.
struct Words {
  std::string markdown;
  std::vector<telemetry::Remark> remarks;
};

// `test` is the frame test that both sides ran, at whose first line the remarks stand; empty: none.
Words words_of(const Comparison& comparison, const std::filesystem::path& test);
Words words_of(const TimesComparison& comparison);
Words words_of(const Instructions& counted);

}  // namespace psygen::compare
