// What is drawn of the models of nodes: those in view, as much of them as is there while they come
// and go (fading.hpp), and of merged meshes the parts that can be seen. Main thread; linear in the
// models.
#pragma once

#include "engine/scene/draws/fading.hpp"
#include "engine/scene/draws/views.hpp"
#include "engine/scene/state.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {

// The node that models stand on, as far as it matters to them, in one tick.
struct ModelGround {
  glm::vec3 corner{0.0F};          // of the node, metres from the camera
  float side_m = 1;                // of the node
  const GroundSun* sun = nullptr;  // of the node; must live during the call
  DrawFacts node;                  // what the views for understanding say about it
  render::View shown = render::View::kNormal;
  FadeStep step;
  bool shadows = false;      // WorldFacts::shadows
  bool near_detail = false;  // WorldFacts::near_detail
  bool pictures = false;     // it has a merged mesh, which may have pictures
};

// How a node came to be drawn in this tick.
enum class NodeEntry : std::uint8_t {
  kStays,     // it was drawn in the last one
  kReplaces,  // it takes the place of others
  kEnters,    // nothing was seen there
};

// Adds to DrawLists::models and meshes what is drawn of the models of a node that is drawn, and
// counts it. `twice`: the node has more than twice the error that it might have.
void add_models(const ModelGround& ground, NodeEntry entry, bool twice, const Camera& camera,
                const View& view, const RenderQuery& entities, const ecs::Children& children,
                DrawLists& draws, Counters& counters);

// The same for a node that is drawn no more. Returns whether anything of its models is left.
bool add_going_models(const ModelGround& ground, const View& view, const RenderQuery& entities,
                      const ecs::Children& children, DrawLists& draws);

}  // namespace psygen::scene
