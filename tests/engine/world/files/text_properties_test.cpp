// Properties that hold for every key of every world that comes with psygen, and for broken texts.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "engine/world/files/document.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_layout.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

// The value at a path of a document, or null.
Node* node_at(Node& root, const TextPath& path) {
  Node* node = &root;
  for (const TextStep& step : path.steps) {
    if (step.is_index) {
      if (step.index >= node->items.size()) return nullptr;
      node = &node->items[step.index];
    } else {
      const auto member = std::ranges::find(node->members, step.key, &Member::key);
      if (member == node->members.end()) return nullptr;
      node = &member->value;
    }
  }
  return node;
}

// Compares everything except lines.
std::string dump(const Node& node) {
  std::string out = std::to_string(static_cast<int>(node.kind)) + ":" +
                    std::to_string(node.integer) + ":" + std::to_string(node.real) + ":" +
                    std::to_string(node.boolean) + ":" + node.text + "(";
  for (const Node& item : node.items)
    out += dump(item) + ",";
  for (const Member& member : node.members)
    out += member.key + "=" + dump(member.value) + ",";
  return out + ")";
}

Node document_of(const std::string& text) {
  auto parsed = parse_document(text, "text");
  EXPECT_TRUE(parsed) << parsed.error().message << "\n" << text;
  return parsed.value_or(Node{});
}

// The comments of a text, whole lines and ends of lines, in order. Strings of the worlds have no #.
std::vector<std::string> comments_of(std::string_view text) {
  std::vector<std::string> comments;
  for (std::size_t at = text.find('#'); at != std::string_view::npos; at = text.find('#', at)) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    comments.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return comments;
}

std::vector<TextPlace> values_of(const std::string& text) {
  auto layout = lay_out(text, "text");
  EXPECT_TRUE(layout);
  std::erase_if(layout->places, [](const TextPlace& place) { return place.is_header(); });
  return layout->places;
}

std::string written(const std::string& text, const TextPlace& place) {
  return text.substr(place.value.begin, place.value.end - place.value.begin);
}

TEST(TextProperties, EveryValueOfEveryWorldIsFoundAndRewritesUnchanged) {
  std::size_t values = 0;
  for (const auto& [name, text] : testing::shipped_worlds()) {
    Node root = document_of(text);
    for (const TextPlace& place : values_of(text)) {
      ++values;
      const std::string value = written(text, place);
      Node* node = node_at(root, place.path);
      ASSERT_NE(node, nullptr) << name << ": " << place.path.text();
      EXPECT_EQ(dump(*node), dump(document_of("v = " + value).members.front().value));
      const auto changed = with_value(text, place.path, value);
      ASSERT_TRUE(changed) << changed.error().message;
      EXPECT_EQ(*changed, text) << name << ": " << place.path.text();
    }
  }
  EXPECT_GT(values, 500U);
}

TEST(TextProperties, AValueThatIsRemovedAndSetAgainGivesAnEqualDocumentWithAllComments) {
  for (const auto& [name, text] : testing::shipped_worlds()) {
    const std::string whole = dump(document_of(text));
    for (const TextPlace& place : values_of(text)) {
      if (place.nested) continue;
      const auto removed = without_value(text, place.path);
      ASSERT_TRUE(removed) << removed.error().message;
      const auto again = with_value(*removed, place.path, written(text, place));
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_EQ(dump(document_of(*again)), whole) << name << ": " << place.path.text();
      const bool had_comment =
          text.substr(place.lines.begin, place.lines.end - place.lines.begin).find('#') !=
          std::string::npos;
      EXPECT_EQ(comments_of(*again).size() + (had_comment ? 1 : 0), comments_of(text).size());
    }
  }
}

// The paths at which a random edit may write: all values, and missing keys.
TextPath random_path(const std::vector<TextPlace>& values, std::mt19937_64& random) {
  TextPath path = values[random() % values.size()].path;
  if (random() % 3 != 0 || path.back().is_index) return path;
  path.steps.back() = TextStep("new_" + std::to_string(random() % 4));
  if (random() % 4 == 0) path.steps.emplace_back("deeper");
  return path;
}

void set_node(Node& root, const TextPath& path, const Node& value) {
  if (Node* there = node_at(root, path); there != nullptr) {
    *there = value;
    return;
  }
  Node* parent = node_at(root, path.parent());
  if (parent == nullptr) {
    Node table;
    set_node(root, path.parent(), table);
    parent = node_at(root, path.parent());
  }
  const auto behind = std::ranges::lower_bound(parent->members, path.back().key, {}, &Member::key);
  parent->members.insert(behind, Member{path.back().key, 0, value});
}

TEST(TextProperties, RandomEditsMatchDirectChangesOfTheDocument) {
  const std::vector<std::string> values{
      "1",     "-2.5", "[1, 2]", "[0.5, 1, 0.25]", "\"ä#b\"", "true", "{ a = 1, b = [2] }",
      "1e+20", "[]",   "{}"};
  std::mt19937_64 random(3);
  for (const auto& [name, shipped] : testing::shipped_worlds()) {
    std::string text = shipped;
    Node root = document_of(text);
    const std::vector<std::string> comments = comments_of(text);
    std::size_t taken = 0;
    for (int i = 0; i < 60; ++i) {
      const TextPath path = random_path(values_of(text), random);
      const std::string& value = values[random() % values.size()];
      const auto changed = with_value(text, path, value);
      if (!changed) continue;  // a key below a value
      ++taken;
      text = *changed;
      set_node(root, path, document_of("v = " + value).members.front().value);
      ASSERT_EQ(dump(document_of(text)), dump(root)) << name << ": " << path.text();
    }
    EXPECT_GT(taken, 40U);
    for (const std::string& comment : comments)
      EXPECT_NE(text.find(comment), std::string::npos) << name << ": " << comment;
  }
}

TEST(TextProperties, TablesOfEveryWorldCanBeRemovedMovedAndCopied) {
  for (const auto& [name, text] : testing::shipped_worlds()) {
    for (const TextPath& array : {TextPath{"scatter"}, TextPath{"species"}}) {
      const std::size_t count = item_count(text, array);
      for (std::size_t i = 0; i < count; ++i) {
        Node root = document_of(text);
        std::vector<Node>& items = node_at(root, array)->items;
        const Node item = items[i];
        const auto moved = with_table_moved(text, array.with(i), (i + 2) % count);
        ASSERT_TRUE(moved) << moved.error().message;
        EXPECT_EQ(comments_of(*moved).size(), comments_of(text).size());
        items.erase(items.begin() + static_cast<std::ptrdiff_t>(i));
        const auto removed = without_table(text, array.with(i));
        ASSERT_TRUE(removed) << removed.error().message;
        if (count > 1) {
          EXPECT_EQ(dump(document_of(*removed)), dump(root)) << name << i;
        }
        items.insert(items.begin() + static_cast<std::ptrdiff_t>((i + 2) % count), item);
        EXPECT_EQ(dump(document_of(*moved)), dump(root)) << name << ": " << i;
        Node twice = document_of(text);
        auto& copies = node_at(twice, array)->items;
        copies.insert(copies.begin() + static_cast<std::ptrdiff_t>(i), item);
        EXPECT_EQ(dump(document_of(*with_table_duplicated(text, array.with(i)))), dump(twice));
      }
    }
  }
}

TEST(TextProperties, BrokenTextsAreRejectedOrStayWhole) {
  const std::string small = testing::shipped_text("worlds/silver_combe.toml").substr(0, 3000);
  constexpr std::string_view kMarks = "\"'[]{}=,.#\n\r\\ \t0ae-\xC3\xBC\0";
  std::mt19937_64 random(5);
  std::size_t taken = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = small.substr(random() % 1500, 100 + random() % 700);
    for (std::uint64_t changes = random() % 4; changes > 0; --changes)
      text.insert(random() % text.size(), 1, kMarks[random() % kMarks.size()]);
    const auto changed = with_value(text, {"species", 0, "flare"}, "0.125");
    if (changed) {
      ++taken;
      EXPECT_EQ(value_text(*changed, {"species", 0, "flare"}), "0.125");
      EXPECT_TRUE(without_value(*changed, {"species", 0, "flare"}));
    }
    (void)without_table(text, {"species", 0});
    (void)with_table_duplicated(text, {"species", 0});
    (void)with_value(text, {"sky", "exposure"}, "0.125");
    if (const auto layout = lay_out(text, "text")) {
      for (const TextPlace& place : layout->places)
        EXPECT_TRUE(place.is_header() || with_value(text, place.path, "1"));
    } else {
      EXPECT_EQ(layout.error().code, core::ErrorCode::kParse) << text;
    }
  }
  EXPECT_GT(taken, 20U);
}

}  // namespace
}  // namespace psygen::world
