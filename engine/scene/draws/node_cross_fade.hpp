// Tells which nodes replace others, so that their models can cross-fade. Values; main thread only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

class NodeCrossFade {
 public:
  // `drawn`: the nodes of this tick, in any order. `continues`: this is the tick after the last
  // call's. Otherwise the nodes drawn before are unknown, and no node fades out.
  void update(std::span<const visibility::NodeCoord> drawn, bool continues);

  // Calls draw(node) once for each node that is no longer drawn: those that update() found, and
  // those of earlier ticks that still fade out. `draw` returns true if any of its models is left.
  template <class Draw>
  void for_each_going(const Draw& draw) {
    std::erase_if(going_, [&](const visibility::NodeCoord& node) { return !draw(node); });
    find_replaced();
  }

  // True if a drawn node was not drawn in the last tick.
  bool is_new_node(const visibility::NodeCoord& node) const;
  // True if such a node replaces nodes that still fade out: an ancestor, or nodes below it.
  bool replaces(const visibility::NodeCoord& node) const;

 private:
  void find_replaced();

  // All sorted.
  std::vector<visibility::NodeCoord> drawn_, drawn_before_, fresh_, going_, above_going_, scratch_;
  std::uint8_t top_level_ = 0;  // of drawn and going nodes
};

}  // namespace psygen::scene
