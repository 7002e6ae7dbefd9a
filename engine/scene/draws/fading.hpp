// How models come and go without popping: a mesh that replaces another takes its pixels over share
// by share (render::MeshDraw::fade), and so do the models of nodes that replace other nodes. What
// comes into view from the side or from behind a ridge is there at once. Knows no cache and no
// renderer. Values; main thread.
#pragma once

#include <span>
#include <vector>

#include "engine/scene/components.hpp"

namespace psygen::scene {

// What one tick does to everything that fades.
struct FadeStep {
  std::uint32_t tick = 0;
  float share = 1;  // of a whole fade, in (0, 1]; 1: everything comes and goes at once
};

// The phase of the pattern in which meshes share pixels (render::FrameInput::fade_phase), 0 to 1:
// it moves by half of what a fade does. Moved as far as a fade, pixels would change back.
float next_phase(float phase, FadeStep step);

// The model draws another mesh from now on than `before`, which is resident: its level of detail,
// and whether it is the quad of a picture. One that was coming itself gives its place to the new
// one. Returns whether `before` is what goes.
bool replace_mesh(Fading& fading, const Mesh& before, std::uint8_t level, bool pictured);

// A model is drawn in this tick: returns the share of it that is there, in (0, 1]. If it was not
// drawn in the last tick it begins to come where `fades_in`, else is there as a whole.
float come(Fading& fading, FadeStep step, bool fades_in);

// A model is drawn no more: returns the share of it that is left; 0 if it is gone.
float go(Fading& fading, FadeStep step);

// Which nodes take the place of others.
class NodeHandover {
 public:
  // The nodes drawn in this tick, in any order. `continues`: this is the tick after the last
  // call's; else nothing is known of what was drawn before, and nothing goes.
  void update(std::span<const visibility::NodeCoord> drawn, bool continues);

  // Draws those that were drawn and are no more: all that update() found, and those of the ticks
  // before that are still kept. `draw` says, once for each of them, whether anything of it is left.
  template <class Draw>
  void for_each_going(const Draw& draw) {
    std::erase_if(going_, [&](const visibility::NodeCoord& node) { return !draw(node); });
    find_replaced();
  }

  // Of a node drawn in this tick: whether it was not in the last one, and if so, whether it has
  // come in the place of what is left of going ones: its ancestor, or nodes below it.
  bool is_fresh(const visibility::NodeCoord& node) const;
  bool replaces(const visibility::NodeCoord& node) const;

 private:
  void find_replaced();

  // All sorted.
  std::vector<visibility::NodeCoord> drawn_, drawn_before_, fresh_, going_, above_going_, scratch_;
  std::uint8_t top_level_ = 0;  // of drawn and going ones
};

}  // namespace psygen::scene
