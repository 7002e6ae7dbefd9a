#include "engine/scene/draws/shown_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace psygen::scene {
namespace {

template <class Event>
void emit_difference(std::span<const NodeShown> those, std::span<const NodeShown> others,
                     ecs::EventQueue<Event>& queue) {
  if (!queue.has_readers()) return;
  std::vector<NodeShown> gone;
  std::ranges::set_difference(those, others, std::back_inserter(gone), {}, &NodeShown::at,
                              &NodeShown::at);
  for (const NodeShown& node : gone)
    queue.emit(Event{node.node, node.at});
}

}  // namespace

void find_ready(const View& view, const RenderQuery& entities, DrawLists& draws) {
  const std::vector<visibility::CutNode>& cut = view.cut.nodes;
  draws.ready.assign(cut.size(), 0);
  std::vector<std::uint8_t>& covered = draws.scratch;  // by the node itself or an ancestor
  covered.assign(cut.size(), 0);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const bool above = cut[i].parent != visibility::kNoNode && covered[cut[i].parent] != 0;
    const MeshDemand* demand = entities.get<MeshDemand>(draws.entities[i]);
    const bool ground = demand != nullptr && demand->drawn_level != kNoLevel;
    draws.ready[i] = ground && (view.ready[i] != 0 || !above) ? 1 : 0;
    covered[i] = above || draws.ready[i] != 0 ? 1 : 0;
  }
}

void list_shown(const View& view, DrawLists& draws) {
  const std::vector<visibility::CutNode>& cut = view.cut.nodes;
  draws.shown.clear();
  draws.shown_nodes.clear();
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < cut.size();) {
    const bool drawn = next < draws.nodes.size() && draws.nodes[next] == i;
    if ((drawn || cut[i].leaf) && view.in_view[i] != 0) {
      draws.shown.push_back(i);
      draws.shown_nodes.push_back(cut[i].node);
    }
    next += drawn ? 1 : 0;
    i = drawn ? cut[i].end : i + 1;
  }
}

std::uint32_t coarser_by(const View& view, std::uint32_t index) {
  const std::vector<visibility::CutNode>& cut = view.cut.nodes;
  std::uint32_t finest = cut[index].node.level;
  for (std::uint32_t i = index + 1; i < cut[index].end; ++i) {
    if (view.in_view[i] != 0) finest = std::min<std::uint32_t>(finest, cut[i].node.level);
  }
  return cut[index].node.level - finest;
}

float min_distance_m(const visibility::CutNode& node, std::uint8_t drawn_level, double split_m) {
  const bool as_wanted = node.leaf && (!node.fine || drawn_level == 0);
  return as_wanted ? 0.0F : static_cast<float>(split_m / 2);
}

float nearest_m(const View& view, std::uint32_t index, float highest_m) {
  const std::vector<visibility::CutNode>& cut = view.cut.nodes;
  float nearest = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = index; i < cut[index].end; ++i) {
    if (cut[i].leaf && view.in_view[i] != 0) nearest = std::min(nearest, cut[i].distance_m);
  }
  return std::hypot(nearest, std::max(-highest_m, 0.0F));
}

void events_system(const View& view, const DrawLists& draws, ShownNodes& shown,
                   ecs::EventQueue<NodeShown>& nodes_shown,
                   ecs::EventQueue<NodeHidden>& nodes_hidden) {
  if (!nodes_shown.has_readers() && !nodes_hidden.has_readers()) return shown.nodes.clear();
  std::vector<NodeShown> now;
  for (const std::uint32_t i : draws.shown)
    now.push_back({draws.entities[i], view.cut.nodes[i].node});
  std::ranges::sort(now, {}, &NodeShown::at);
  emit_difference(now, shown.nodes, nodes_shown);
  emit_difference(shown.nodes, now, nodes_hidden);
  shown.nodes = std::move(now);
}

}  // namespace psygen::scene
