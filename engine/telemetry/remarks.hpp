// Words about a run on a pull request: remarks at lines of files, as annotations of GitHub and
// GitLab, and Markdown. All texts are untrusted: they cannot end a line, a cell or a command, and
// mention nobody. Pure, except for PullRequestWords; any thread. Sources: "Workflow commands for
// GitHub Actions" and its toolkit (core/src/command.ts); "Code Quality report format" of GitLab.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

enum class RemarkLevel : std::uint8_t { kError, kWarning, kNotice };

struct Remark {
  RemarkLevel level = RemarkLevel::kError;
  std::string title = {};           // a few words; the same in every run that has this finding
  std::string message = {};         // sentences; may have several lines
  std::filesystem::path file = {};  // below the current folder it becomes relative; empty: none
  int line = 0;                     // from 1; 0: none
};

// Workflow commands, one per line, errors first: GitHub shows ten errors and ten warnings of a
// step.
std::string to_github(std::span<const Remark> remarks);
// A code quality report: a JSON list. Fingerprints are made of title and file, so GitLab knows a
// finding again although its values changed. A remark without a file stands at line 1 of "psygen".
std::string to_gitlab(std::span<const Remark> remarks);

// Where annotations go: "github", "gitlab", or either with ":FILE".
struct Annotations {
  enum class Format : std::uint8_t { kNone, kGithub, kGitlab } format = Format::kNone;
  std::filesystem::path file;  // empty: stdout

  bool to_stdout() const { return format != Format::kNone && file.empty(); }
};
// Fails with kInvalidArgument for another format and an empty file.
core::Result<Annotations> annotations_from(std::string_view text);
// The remarks in the format; empty for kNone.
std::string to_text(const Annotations& where, std::span<const Remark> remarks);

// The words of a command on a pull request: options --markdown and --annotations.
struct PullRequestWords {
  std::filesystem::path markdown;  // file; empty: none
  Annotations annotations;

  // Before a long job: creates the folders, and fails with kIo if a file cannot be written.
  core::Result<void> check() const;
  // Writes the files. Fails with kIo. Annotations for stdout are left to the caller.
  core::Result<void> write(std::string_view text, std::span<const Remark> remarks) const;
};

// One line of plain text in Markdown. Punctuation with a meaning is escaped; zero-width spaces
// after @ and # keep GitHub from naming people and issues.
std::string markdown_text(std::string_view text);
// A table of plain texts, with empty lines around it. Rows have as many cells as `header`.
using MarkdownRow = std::vector<std::string>;
std::string markdown_table(const MarkdownRow& header, std::span<const MarkdownRow> rows);

}  // namespace psygen::telemetry
