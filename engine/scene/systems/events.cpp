// Tells which nodes came into the picture and which left it.
#include <algorithm>
#include <iterator>

#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

template <class Event>
void emit_difference(std::span<const ShownNode> those, std::span<const ShownNode> others,
                     ecs::EventQueue<Event>& queue) {
  if (!queue.has_readers()) return;
  std::vector<ShownNode> gone;
  std::ranges::set_difference(those, others, std::back_inserter(gone), {}, &ShownNode::at,
                              &ShownNode::at);
  for (const ShownNode& node : gone)
    queue.emit(Event{node.entity, node.at});
}

}  // namespace

void events_system(const View& view, const DrawLists& draws, ShownNodes& shown,
                   ecs::EventQueue<NodeShown>& nodes_shown,
                   ecs::EventQueue<NodeHidden>& nodes_hidden) {
  if (!nodes_shown.has_readers() && !nodes_hidden.has_readers()) return shown.nodes.clear();
  std::vector<ShownNode> now;
  for (const std::uint32_t i : draws.shown)
    now.push_back({draws.entities[i], view.cut.nodes[i].node});
  std::ranges::sort(now, {}, &ShownNode::at);
  emit_difference(now, shown.nodes, nodes_shown);
  emit_difference(shown.nodes, now, nodes_hidden);
  shown.nodes = std::move(now);
}

}  // namespace psygen::scene
