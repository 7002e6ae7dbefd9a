// A tree over moving boxes that finds the boxes which overlap a box or a ray. Its leaves are larger
// than their boxes, so that small moves cost nothing. It knows nothing of shapes. Balanced by
// rotations: insert, remove, and a move out of the leaf take O(log n). One thread. (The dynamic
// tree of Box2D and Bullet: insertion by surface area, heights as in AVL trees.)
#pragma once

#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "engine/query/solid.hpp"

namespace psygen::query {

// An axis-aligned box in metres.
struct WideBox {
  glm::dvec3 min{0.0}, max{0.0};
  // True if the boxes share a point.
  bool overlaps(const WideBox& other) const {
    return min.x <= other.max.x && other.min.x <= max.x && min.y <= other.max.y &&
           other.min.y <= max.y && min.z <= other.max.z && other.min.z <= max.z;
  }
  // True if this box contains all of `other`.
  bool contains(const WideBox& other) const {
    return min.x <= other.min.x && min.y <= other.min.y && min.z <= other.min.z &&
           max.x >= other.max.x && max.y >= other.max.y && max.z >= other.max.z;
  }
};

class BoxTree {
 public:
  using Leaf = std::uint32_t;
  // Leaves exceed their boxes by this margin on each side, in metres.
  static constexpr double kMarginM = 0.1;

  // Adds a box with the number that visitors receive. Its values must be finite. A leaf stays valid
  // until it is removed.
  Leaf insert(const WideBox& box, std::uint32_t item);
  void remove(Leaf leaf);
  // Replaces the box of a leaf, which moves by about `way_m` a call. Returns true if the tree
  // changed.
  bool move(Leaf leaf, const WideBox& box, const glm::dvec3& way_m);

  std::size_t size() const { return size_; }  // leaves
  // Steps from the root to the deepest leaf; 0 for up to one leaf.
  int height() const { return root_ == kNone ? 0 : nodes_[root_].height; }

  // Calls visit(item) for each leaf that overlaps `box`.
  template <class Visit>
  void each_in(const WideBox& box, const Visit& visit) const {
    Stack stack(root_);
    while (!stack.empty()) {
      const Node& node = nodes_[stack.pop()];
      if (!node.box.overlaps(box)) continue;
      if (node.height == 0) {
        visit(node.item);
      } else {
        stack.push(node.child[0]);
        stack.push(node.child[1]);
      }
    }
  }

  // Calls longest = visit(item, longest) for leaves on a ray up to parameter `longest`, roughly
  // nearest first. A visitor that returns less shortens the ray.
  template <class Visit>
  void each_on(const BoxLine& line, double longest, const Visit& visit) const {
    Stack stack(root_);
    while (!stack.empty()) {
      const Node& node = nodes_[stack.pop()];
      if (enters(line, node.box) > longest) continue;
      if (node.height == 0) {
        longest = visit(node.item, longest);
        continue;
      }
      const bool first =
          enters(line, nodes_[node.child[0]].box) <= enters(line, nodes_[node.child[1]].box);
      stack.push(node.child[first ? 1 : 0]);
      stack.push(node.child[first ? 0 : 1]);
    }
  }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Node {
    WideBox box;
    std::uint32_t parent = kNone;
    std::array<std::uint32_t, 2> child{kNone, kNone};
    std::uint32_t item = 0;
    int height = 0;  // 0: a leaf
  };
  // Nodes to visit: at most one a level, and balanced trees are not deep.
  class Stack {
   public:
    explicit Stack(std::uint32_t root) {
      if (root != kNone) push(root);
    }
    bool empty() const { return count_ == 0; }
    void push(std::uint32_t node) { nodes_[count_++] = node; }
    std::uint32_t pop() { return nodes_[--count_]; }

   private:
    std::array<std::uint32_t, 64> nodes_;
    std::size_t count_ = 0;
  };

  // Returns the parameter at which a ray enters a box; infinite if it misses.
  static double enters(const BoxLine& line, const WideBox& box) {
    const glm::dvec3 a = (box.min - line.origin) * line.inverse;
    const glm::dvec3 b = (box.max - line.origin) * line.inverse;
    const glm::dvec3 in = glm::min(a, b), out = glm::max(a, b);
    const double first = glm::max(glm::max(in.x, in.y), glm::max(in.z, 0.0));
    const double last = glm::min(glm::min(out.x, out.y), out.z);
    return first <= last ? first : std::numeric_limits<double>::infinity();
  }

  std::uint32_t new_node();
  void insert_leaf(Leaf leaf);
  void remove_leaf(Leaf leaf);
  std::uint32_t best_sibling(const WideBox& box) const;
  void replace_child(std::uint32_t parent, std::uint32_t old, std::uint32_t by);
  void fit(std::uint32_t node);
  void fit_upwards(std::uint32_t node);
  std::uint32_t rotate(std::uint32_t node, int side);

  std::vector<Node> nodes_;
  std::uint32_t root_ = kNone, free_ = kNone;  // free nodes form a list by `parent`
  std::size_t size_ = 0;
};

}  // namespace psygen::query
