#include "engine/scene/draws/draw_lists.hpp"

#include <algorithm>
#include <iterator>

namespace psygen::scene {

void NodeCrossFade::update(std::span<const visibility::NodeCoord> drawn, bool continues) {
  if (!continues) {
    drawn_.clear();
    going_.clear();
  }
  std::vector<visibility::NodeCoord>& before = scratch_;
  before.clear();
  std::ranges::set_union(drawn_, going_, std::back_inserter(before));
  drawn_before_.swap(drawn_);
  drawn_.assign(drawn.begin(), drawn.end());
  std::ranges::sort(drawn_);
  fresh_.clear();
  std::ranges::set_difference(drawn_, drawn_before_, std::back_inserter(fresh_));
  going_.clear();
  std::ranges::set_difference(before, drawn_, std::back_inserter(going_));
}

void NodeCrossFade::find_replaced() {
  above_going_.clear();
  if (going_.empty()) return;
  top_level_ = 0;
  for (const auto* nodes : {&drawn_, &going_}) {
    for (const visibility::NodeCoord& node : *nodes)
      top_level_ = std::max(top_level_, node.level);
  }
  for (visibility::NodeCoord node : going_) {
    while (node.level < top_level_) {
      node = visibility::parent_of(node);
      above_going_.push_back(node);
    }
  }
  std::ranges::sort(above_going_);
}

bool NodeCrossFade::is_new_node(const visibility::NodeCoord& node) const {
  return std::ranges::binary_search(fresh_, node);
}

bool NodeCrossFade::replaces(const visibility::NodeCoord& node) const {
  if (going_.empty() || !is_new_node(node)) return false;
  if (std::ranges::binary_search(above_going_, node)) return true;
  visibility::NodeCoord above = node;
  while (above.level < top_level_) {
    above = visibility::parent_of(above);
    if (std::ranges::binary_search(going_, above)) return true;
  }
  return false;
}

}  // namespace psygen::scene
