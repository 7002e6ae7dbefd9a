// Draws of the models of nodes: the models in view, with their fades (meshes/fading.hpp), and the
// visible parts of merged meshes. Main thread; linear in the models.
#pragma once

#include <vector>

#include "engine/core/geometry_memory.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/draws/draw_lists.hpp"
#include "engine/scene/meshes/fading.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/scene/view/debug_colours.hpp"
#include "engine/scene/view/view.hpp"

namespace psygen::scene {

// Draws of parts of one index list: tiles of ground, and runs of a merged mesh. Adjacent parts
// become one draw, so that few draws cover the visible parts. `Draw`: render::TerrainDraw or
// render::MeshDraw. The destructor adds the last draw.
template <class Draw>
class DrawParts {
 public:
  DrawParts(const Draw& draw, std::vector<Draw>& draws) : draw_(draw), draws_(draws) {
    draw_.part = {};
  }
  ~DrawParts() { flush(); }
  DrawParts(const DrawParts&) = delete;
  DrawParts& operator=(const DrawParts&) = delete;

  // Adds a part. Parts come in the order of the list.
  void add(core::IndexPart part) {
    if (part.first != draw_.part.first + draw_.part.count) {
      flush();
      draw_.part = {part.first, 0};
    }
    draw_.part.count += part.count;
  }
  // Sets a value of the parts that follow: the sunlight on models, or whether ground is near.
  template <class Value>
  void set(Value Draw::*member, Value value) {
    if (draw_.*member == value) return;
    flush();
    draw_.part = {};
    draw_.*member = value;
  }

 private:
  void flush() {
    if (draw_.part.count > 0) draws_.push_back(draw_);
  }

  Draw draw_;
  std::vector<Draw>& draws_;
};

// Adds draws for the parts of a merged mesh that may be visible, or for all parts if `view` is
// null. Each part gets the sunlight of the ground under it; `side_m` is the side of the node.
// `draw` is that of the whole mesh. Returns true if it added any.
bool add_parts(const MeshParts& parts, const View* view, const GroundSunlight& sun, float side_m,
               const render::MeshDraw& draw, std::vector<render::MeshDraw>& draws);

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

// Adds the surface of the rivers and lakes of a drawn node to DrawLists::water and meshes, and
// counts it.
void add_water(const ModelGround& ground, const RenderContext& context, const RenderQuery& entities,
               const ecs::Children& children, DrawLists& draws);

// Adds the models of a node that is no longer drawn. Returns true if any of them is left.
bool add_going_models(const ModelGround& ground, const View& view, const RenderQuery& entities,
                      const ecs::Children& children, DrawLists& draws);

}  // namespace psygen::scene
