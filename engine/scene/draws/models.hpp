// Draws of the models of nodes: the models in view, with their fades (meshes/fading.hpp), and the
// visible parts of merged meshes. Main thread; linear in the models.
#pragma once

#include "engine/scene/draws/draw_lists.hpp"
#include "engine/scene/meshes/fading.hpp"
#include "engine/scene/view/debug_colours.hpp"

namespace psygen::scene {

// The node under the models, in one tick.
struct ModelGround {
  glm::vec3 corner{0.0F};               // of the node, metres from the camera
  float side_m = 1;                     // of the node
  const GroundSunlight* sun = nullptr;  // of the node; must live during the call
  DrawFacts node;                       // for debug views
  render::View shown = render::View::kNormal;
  FadeStep step;
  bool shadows = false;      // WorldFacts::shadows
  bool near_detail = false;  // WorldFacts::near_detail
  bool pictures = false;     // it has a merged mesh, which may contain impostors
};

// The reason why a node is drawn in this tick.
enum class NodeEntry : std::uint8_t {
  kStays,     // it was drawn in the last tick
  kReplaces,  // it replaces other nodes
  kEnters,    // no node was drawn there
};

// Adds the models of a drawn node to DrawLists::models and meshes, and counts them. `twice`: the
// node has more than twice its allowed error.
void add_models(const ModelGround& ground, NodeEntry entry, bool twice,
                const RenderContext& context, const RenderQuery& entities,
                const ecs::Children& children, DrawLists& draws);

// Adds the models of a node that is no longer drawn. Returns true if any of them is left.
bool add_going_models(const ModelGround& ground, const View& view, const RenderQuery& entities,
                      const ecs::Children& children, DrawLists& draws);

}  // namespace psygen::scene
