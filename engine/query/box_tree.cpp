#include "engine/query/box_tree.hpp"

#include <algorithm>

namespace psygen::query {
namespace {

// A leaf extends this many moves ahead.
constexpr double kMovesAhead = 4;

WideBox united(const WideBox& a, const WideBox& b) {
  return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

// Returns half of the surface area.
double area(const WideBox& box) {
  const glm::dvec3 size = box.max - box.min;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

WideBox leaf_box(const WideBox& box, const glm::dvec3& way_m) {
  const glm::dvec3 ahead = kMovesAhead * way_m;
  return {box.min - BoxTree::kMarginM + glm::min(ahead, 0.0),
          box.max + BoxTree::kMarginM + glm::max(ahead, 0.0)};
}

}  // namespace

std::uint32_t BoxTree::new_node() {
  if (free_ == kNone) {
    nodes_.emplace_back();
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }
  const std::uint32_t node = free_;
  free_ = nodes_[node].parent;
  nodes_[node] = {};
  return node;
}

BoxTree::Leaf BoxTree::insert(const WideBox& box, std::uint32_t item) {
  const Leaf leaf = new_node();
  nodes_[leaf].box = leaf_box(box, glm::dvec3(0.0));
  nodes_[leaf].item = item;
  insert_leaf(leaf);
  ++size_;
  return leaf;
}

void BoxTree::remove(Leaf leaf) {
  remove_leaf(leaf);
  nodes_[leaf].parent = free_;
  free_ = leaf;
  --size_;
}

bool BoxTree::move(Leaf leaf, const WideBox& box, const glm::dvec3& way_m) {
  const WideBox wanted = leaf_box(box, way_m);
  // Also rebuilds a leaf that became far too large after a fast move.
  if (nodes_[leaf].box.contains(box) && area(nodes_[leaf].box) <= 2 * area(wanted)) return false;
  remove_leaf(leaf);
  nodes_[leaf].box = wanted;
  insert_leaf(leaf);
  return true;
}

// Returns the node as whose sibling a box adds the least surface area to the tree.
std::uint32_t BoxTree::best_sibling(const WideBox& box) const {
  std::uint32_t node = root_;
  while (nodes_[node].height > 0) {
    const double here = area(united(nodes_[node].box, box));
    const double grown = here - area(nodes_[node].box);  // added to all ancestors in any case
    std::uint32_t best = node;
    double best_cost = here;
    for (const std::uint32_t child : nodes_[node].child) {
      const double whole = area(united(nodes_[child].box, box));
      const double old = nodes_[child].height > 0 ? area(nodes_[child].box) : 0;
      const double cost = whole - old + grown;
      if (cost >= best_cost) continue;
      best_cost = cost;
      best = child;
    }
    if (best == node) break;
    node = best;
  }
  return node;
}

void BoxTree::replace_child(std::uint32_t parent, std::uint32_t old, std::uint32_t by) {
  nodes_[by].parent = parent;
  if (parent == kNone)
    root_ = by;
  else
    nodes_[parent].child[nodes_[parent].child[0] == old ? 0 : 1] = by;
}

void BoxTree::insert_leaf(Leaf leaf) {
  if (root_ == kNone) {
    root_ = leaf;
    nodes_[leaf].parent = kNone;
    return;
  }
  const std::uint32_t sibling = best_sibling(nodes_[leaf].box), joint = new_node();
  replace_child(nodes_[sibling].parent, sibling, joint);
  nodes_[joint].child = {sibling, leaf};
  nodes_[sibling].parent = nodes_[leaf].parent = joint;
  fit_upwards(joint);
}

void BoxTree::remove_leaf(Leaf leaf) {
  const std::uint32_t joint = nodes_[leaf].parent;
  if (joint == kNone) {
    root_ = kNone;
    return;
  }
  const std::uint32_t above = nodes_[joint].parent;
  replace_child(above, joint, nodes_[joint].child[nodes_[joint].child[0] == leaf ? 1 : 0]);
  nodes_[joint].parent = free_;
  free_ = joint;
  fit_upwards(above);
}

void BoxTree::fit(std::uint32_t node) {
  Node& n = nodes_[node];
  const Node &a = nodes_[n.child[0]], &b = nodes_[n.child[1]];
  n.box = united(a.box, b.box);
  n.height = 1 + std::max(a.height, b.height);
}

void BoxTree::fit_upwards(std::uint32_t node) {
  for (; node != kNone; node = nodes_[node].parent) {
    const auto& child = nodes_[node].child;
    const int lean = nodes_[child[1]].height - nodes_[child[0]].height;
    if (lean > 1 || lean < -1) node = rotate(node, lean > 0 ? 1 : 0);
    fit(node);
  }
}

// The taller child takes the position of its parent, which gets the child's shorter child.
std::uint32_t BoxTree::rotate(std::uint32_t node, int side) {
  const auto at = static_cast<std::size_t>(side);
  const std::uint32_t up = nodes_[node].child[at];
  const auto [a, b] = nodes_[up].child;
  const bool first_stays = nodes_[a].height > nodes_[b].height;
  const std::uint32_t stays = first_stays ? a : b, goes = first_stays ? b : a;
  replace_child(nodes_[node].parent, node, up);
  nodes_[up].child = {node, stays};
  nodes_[node].parent = up;
  nodes_[node].child[at] = goes;
  nodes_[goes].parent = node;
  fit(node);
  return up;
}

}  // namespace psygen::query
