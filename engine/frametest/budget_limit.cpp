#include "engine/frametest/budget_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace psygen::frametest {
namespace {

using world::Node;

constexpr std::size_t kMaxWordBytes = 64;
constexpr double kMaxLimit = 1e300;

// Returns false if the value is no limit for the relation.
bool set_limit(const Node& value, Budget& budget) {
  const bool number = value.kind == Node::Kind::kInteger || value.kind == Node::Kind::kReal;
  if (number && std::abs(value.real) <= kMaxLimit) {
    budget.limit = value.real;
    return true;
  }
  if (value.kind != Node::Kind::kText) return false;
  if (budget.relation == Relation::kEqual) {
    budget.limit = value.text;
    return true;
  }
  budget.of_base = factor_of_base(value.text);
  return budget.of_base.has_value();
}

std::string needed(Relation relation) {
  if (relation == Relation::kEqual) return "the limit must be a finite number or a text";
  return fmt::format(
      "the limit must be a finite number, or a text like \"1.05 × base\" with a factor from {} to "
      "{}",
      kMinFactor, kMaxFactor);
}

}  // namespace

std::optional<double> factor_of_base(std::string_view text) {
  const auto skip_blanks = [&text] {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  };
  double factor = 0;
  skip_blanks();
  const auto read = std::from_chars(text.data(), text.data() + text.size(), factor);
  if (read.ec != std::errc() || !(factor >= kMinFactor && factor <= kMaxFactor))
    return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  skip_blanks();
  for (const std::string_view sign : {"×", "x", "*"}) {
    if (!text.starts_with(sign)) continue;
    text.remove_prefix(sign.size());
    skip_blanks();
    return text == "base" ? std::optional(factor) : std::nullopt;
  }
  return std::nullopt;
}

bool is_limit(const Node& node) {
  return node.kind != Node::Kind::kTable || node.find("limit") != nullptr;
}

bool read_limit(const Node& node, const std::string& where, world::Problems& problems,
                Budget& budget) {
  if (node.kind != Node::Kind::kTable) {
    if (set_limit(node, budget)) return true;
    problems.add(node.line, where, needed(budget.relation));
    return false;
  }
  world::TableReader reader(node, where, node.line, problems);
  const Node& limit = reader.find("limit")->value;
  const bool set = set_limit(limit, budget);
  if (!set) reader.problem(limit.line, "limit", needed(budget.relation));
  std::string witness = "processor";
  reader.read("witness", witness, kMaxWordBytes);
  if (witness != "processor" && witness != "none")
    reader.problem("witness", "it must be \"processor\" or \"none\"");
  budget.needs_witness = witness == "processor";
  reader.finish();
  return set;
}

}  // namespace psygen::frametest
