// Compares the tree of boxes with a list.
#include "engine/query/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace psygen::query {
namespace {

// A tree, and its boxes in a list.
struct Both {
  BoxTree tree;
  std::vector<std::optional<WideBox>> boxes;
  std::vector<BoxTree::Leaf> leaves;
  std::mt19937 random{7};

  double pick(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  WideBox some_box(double world_m) {
    const glm::dvec3 at(pick(0, world_m), pick(0, 50), pick(0, world_m));
    return {at, at + glm::dvec3(pick(0.1, 5), pick(0.1, 5), pick(0.1, 5))};
  }
  void insert(const WideBox& box) {
    leaves.push_back(tree.insert(box, static_cast<std::uint32_t>(boxes.size())));
    boxes.push_back(box);
  }
  void expect_same_as_list(const WideBox& wanted) {
    std::vector<char> seen(boxes.size(), 0);
    tree.each_in(wanted, [&](std::uint32_t item) { ++seen[item]; });
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      ASSERT_LE(seen[i], 1) << "an item twice";
      if (!boxes[i]) {
        ASSERT_EQ(seen[i], 0) << "a removed item";
      } else if (boxes[i]->overlaps(wanted)) {
        ASSERT_EQ(seen[i], 1) << "an item was missed";
      }
    }
  }
};

TEST(BoxTree, FindsTheSameAsAListWhileBoxesAreAddedMovedAndRemoved) {
  Both both;
  for (int i = 0; i < 600; ++i)
    both.insert(both.some_box(300));
  for (int round = 0; round < 40; ++round) {
    for (std::size_t i = 0; i < both.boxes.size(); ++i) {
      if (!both.boxes[i]) continue;
      const double what = both.pick(0, 1);
      if (what < 0.02) {
        both.tree.remove(both.leaves[i]);
        both.boxes[i].reset();
      } else if (what < 0.5) {
        const glm::dvec3 way(both.pick(-1, 1), 0, both.pick(-1, 1));
        *both.boxes[i] = {both.boxes[i]->min + way, both.boxes[i]->max + way};
        both.tree.move(both.leaves[i], *both.boxes[i], way);
      }
    }
    both.insert(both.some_box(300));
    for (int i = 0; i < 20; ++i)
      both.expect_same_as_list(both.some_box(300));
  }
  const auto alive = std::ranges::count_if(both.boxes, [](const auto& b) { return b.has_value(); });
  EXPECT_EQ(both.tree.size(), static_cast<std::size_t>(alive));
}

TEST(BoxTree, StaysShallowForAnyOrderOfItsBoxes) {
  BoxTree tree;
  std::vector<BoxTree::Leaf> leaves;
  for (int i = 0; i < 20'000; ++i)
    leaves.push_back(tree.insert({glm::dvec3(i), glm::dvec3(i + 0.5)}, 0));
  EXPECT_LE(tree.height(), 1.45 * std::log2(20'000.0));
  for (int i = 0; i < 19'900; ++i)
    tree.remove(leaves[static_cast<std::size_t>(i)]);
  EXPECT_LE(tree.height(), 1.45 * std::log2(100.0) + 1);
  for (int i = 19'900; i < 20'000; ++i)
    tree.remove(leaves[static_cast<std::size_t>(i)]);
  EXPECT_EQ(tree.size(), 0u);
  EXPECT_EQ(tree.height(), 0);
}

TEST(BoxTree, ARayVisitsEveryBoxThatItCrossesUntilItIsStopped) {
  Both both;
  for (int i = 0; i < 500; ++i)
    both.insert(both.some_box(200));
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 from(both.pick(0, 200), both.pick(0, 50), both.pick(0, 200));
    const glm::dvec3 way(both.pick(-1, 1), both.pick(-0.2, 0.2), both.pick(-1, 1));
    const Line line{from, way / std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z)};
    std::vector<char> seen(both.boxes.size(), 0);
    both.tree.each_on(BoxLine(line), 100, [&](std::uint32_t item, double longest) {
      ++seen[item];
      return longest;
    });
    for (std::size_t k = 0; k < both.boxes.size(); ++k) {
      const core::Bounds box{glm::vec3(both.boxes[k]->min), glm::vec3(both.boxes[k]->max)};
      if (cast(line, 100, models::Collider::Shape(box), {})) {
        ASSERT_EQ(seen[k], 1);
      }
    }
    int visits = 0;
    both.tree.each_on(BoxLine(line), 100, [&](std::uint32_t, double) {
      ++visits;
      return -1.0;
    });
    ASSERT_LE(visits, 1);
  }
}

TEST(BoxTree, SmallMovesChangeNothing) {
  BoxTree tree;
  const BoxTree::Leaf leaf = tree.insert({glm::dvec3(0), glm::dvec3(1)}, 3);
  EXPECT_FALSE(tree.move(leaf, {glm::dvec3(0.05), glm::dvec3(1.05)}, glm::dvec3(0.05)));
  EXPECT_TRUE(tree.move(leaf, {glm::dvec3(0.2), glm::dvec3(1.2)}, glm::dvec3(0.1)));
  EXPECT_FALSE(tree.move(leaf, {glm::dvec3(0.6), glm::dvec3(1.6)}, glm::dvec3(0.1)))
      << "its margin is for moves of that size";
}

}  // namespace
}  // namespace psygen::query
