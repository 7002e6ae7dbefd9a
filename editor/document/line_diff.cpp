#include "editor/document/line_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace psygen::editor {
namespace {

using Lines = std::vector<std::string_view>;

Lines lines_of(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// Appends the differences of a[from, a_end) and b[from, b_end), whose first and last lines differ.
void add_middle(const Lines& a, const Lines& b, std::size_t from, std::size_t a_end,
                std::size_t b_end, std::vector<DiffLine>& out) {
  using enum DiffLine::Kind;
  const std::size_t n = a_end - from, m = b_end - from;
  // Lengths of the longest common subsequences of the ends of both.
  const bool small = n * m <= kMaxPairs;
  std::vector<std::uint32_t> length(small ? (n + 1) * (m + 1) : 0);
  const auto at = [&](std::size_t i, std::size_t j) -> std::uint32_t& {
    return length[i * (m + 1) + j];
  };
  for (std::size_t i = n; small && i-- > 0;) {
    for (std::size_t j = m; j-- > 0;)
      at(i, j) =
          a[from + i] == b[from + j] ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
  }
  std::size_t i = 0, j = 0;
  while (i < n || j < m) {
    if (small && i < n && j < m && a[from + i] == b[from + j]) {
      out.push_back({kSame, a[from + i]});
      ++i, ++j;
    } else if (i < n && (j == m || !small || at(i + 1, j) >= at(i, j + 1))) {
      out.push_back({kRemoved, a[from + i++]});
    } else {
      out.push_back({kAdded, b[from + j++]});
    }
  }
}

void write_hunk(const std::vector<DiffLine>& lines, std::size_t begin, std::size_t end,
                std::size_t a_line, std::size_t b_line, std::string& out) {
  std::size_t a_count = 0, b_count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    a_count += lines[i].kind != DiffLine::Kind::kAdded ? 1 : 0;
    b_count += lines[i].kind != DiffLine::Kind::kRemoved ? 1 : 0;
  }
  fmt::format_to(std::back_inserter(out), "@@ -{},{} +{},{} @@\n", a_line + (a_count > 0 ? 1 : 0),
                 a_count, b_line + (b_count > 0 ? 1 : 0), b_count);
  for (std::size_t i = begin; i < end; ++i) {
    constexpr std::string_view kMarks = " -+";
    fmt::format_to(std::back_inserter(out), "{}{}\n",
                   kMarks[static_cast<std::size_t>(lines[i].kind)], lines[i].text);
  }
}

}  // namespace

std::vector<DiffLine> line_diff(std::string_view before, std::string_view after) {
  const Lines a = lines_of(before), b = lines_of(after);
  const std::size_t shorter = std::min(a.size(), b.size());
  std::size_t first = 0, last = 0;
  while (first < shorter && a[first] == b[first])
    ++first;
  while (last < shorter - first && a[a.size() - 1 - last] == b[b.size() - 1 - last])
    ++last;
  std::vector<DiffLine> out;
  for (std::size_t i = 0; i < first; ++i)
    out.push_back({DiffLine::Kind::kSame, a[i]});
  add_middle(a, b, first, a.size() - last, b.size() - last, out);
  for (std::size_t i = a.size() - last; i < a.size(); ++i)
    out.push_back({DiffLine::Kind::kSame, a[i]});
  return out;
}

std::size_t changed_lines(std::string_view before, std::string_view after) {
  std::size_t total = 0, removed = 0, added = 0;
  for (const DiffLine& line : line_diff(before, after)) {
    if (line.kind == DiffLine::Kind::kSame) {
      total += std::max(removed, added);
      removed = added = 0;
    }
    removed += line.kind == DiffLine::Kind::kRemoved;
    added += line.kind == DiffLine::Kind::kAdded;
  }
  return total + std::max(removed, added);
}

std::string unified_diff(std::string_view before, std::string_view after,
                         std::string_view before_name, std::string_view after_name,
                         std::size_t context) {
  const std::vector<DiffLine> lines = line_diff(before, after);
  const auto changed = [&](std::size_t i) { return lines[i].kind != DiffLine::Kind::kSame; };
  std::string out;
  std::size_t a_line = 0, b_line = 0, at = 0;  // lines before `at`
  const auto go_to = [&](std::size_t to) {
    for (; at < to; ++at) {
      a_line += lines[at].kind != DiffLine::Kind::kAdded ? 1 : 0;
      b_line += lines[at].kind != DiffLine::Kind::kRemoved ? 1 : 0;
    }
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!changed(i)) continue;
    if (out.empty()) out = fmt::format("--- {}\n+++ {}\n", before_name, after_name);
    const std::size_t begin = std::max(at, i - std::min(i, context));
    std::size_t last = i;  // the last change of the hunk
    for (std::size_t k = i; k < lines.size() && k <= last + 2 * context + 1; ++k)
      if (changed(k)) last = k;
    const std::size_t end = std::min(lines.size(), last + 1 + context);
    go_to(begin);
    write_hunk(lines, begin, end, a_line, b_line, out);
    go_to(end);
    i = end - 1;
  }
  return out;
}

}  // namespace psygen::editor
