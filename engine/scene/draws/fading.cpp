#include "engine/scene/draws/fading.hpp"

#include <algorithm>
#include <iterator>

namespace psygen::scene {

bool replace_mesh(Fading& fading, const Mesh& before, std::uint8_t level, bool pictured) {
  const bool coming = fading.share < 1.0F;
  const bool mostly_old = fading.old_mesh && fading.share < 0.5F;
  if (coming && (!fading.old_mesh || mostly_old)) return false;
  fading.share = 0;
  fading.old_range = before.range;
  fading.old_mesh = before.handle;
  fading.old_shared_indices = before.shared_indices;
  fading.old_level = level;
  fading.old_pictured = pictured;
  return true;
}

float next_phase(float phase, FadeStep step) {
  const float moved = phase + 0.5F * step.share;
  return moved < 1.0F ? moved : moved - 1.0F;
}

float come(Fading& fading, FadeStep step, bool fades_in) {
  if (fading.tick + 1 != step.tick) {
    fading.share = fades_in ? 0.0F : 1.0F;
    fading.old_mesh = {};
  }
  fading.tick = step.tick;
  fading.share = std::min(fading.share + step.share, 1.0F);
  if (fading.share >= 1.0F) fading.old_mesh = {};
  return fading.share;
}

float go(Fading& fading, FadeStep step) {
  if (fading.tick + 1 != step.tick) return 0;
  if (fading.old_mesh) fading.share = 1.0F;  // with its old mesh it is there as a whole
  fading.old_mesh = {};
  fading.share = std::max(fading.share - step.share, 0.0F);
  if (fading.share > 0) fading.tick = step.tick;
  return fading.share;
}

void NodeHandover::update(std::span<const visibility::NodeCoord> drawn, bool continues) {
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

void NodeHandover::find_replaced() {
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

bool NodeHandover::is_fresh(const visibility::NodeCoord& node) const {
  return std::ranges::binary_search(fresh_, node);
}

bool NodeHandover::replaces(const visibility::NodeCoord& node) const {
  if (going_.empty() || !is_fresh(node)) return false;
  if (std::ranges::binary_search(above_going_, node)) return true;
  visibility::NodeCoord above = node;
  while (above.level < top_level_) {
    above = visibility::parent_of(above);
    if (std::ranges::binary_search(going_, above)) return true;
  }
  return false;
}

}  // namespace psygen::scene
