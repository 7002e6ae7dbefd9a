// What is drawn of the models of nodes: those in view, as much of them as is there while they come
// and go (fading.hpp), and of merged meshes the parts that can be seen.
#pragma once

#include "engine/scene/draws/fading.hpp"
#include "engine/scene/draws/views.hpp"
#include "engine/scene/state.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {

// One tick's; adds to its draw lists and counts.
class ModelDraws {
 public:
  ModelDraws(render::View shown, FadeStep step, const Camera& camera, const WorldFacts& facts,
             const View& view, const RenderQuery& entities, DrawLists& draws, Counters& counters)
      : shown_(shown),
        step_(step),
        camera_(camera),
        facts_(facts),
        view_(view),
        entities_(entities),
        draws_(draws),
        counters_(counters) {}

  // How a node came to be drawn in this tick.
  enum class Node : std::uint8_t {
    kStays,     // it was drawn in the last one
    kReplaces,  // it takes the place of others
    kEnters,    // nothing was seen there
  };
  // What they stand on: the node's corner, its size and light.
  struct Ground {
    glm::vec3 corner;
    float side_m;
    const GroundSun& sun;
  };
  // The models of a node that is drawn; `twice`: it has more than twice the error that it might.
  void add(const ecs::Children& children, Node how, const DrawFacts& node, const Ground& ground,
           bool twice);
  // Those of a node that is drawn no more. Returns whether anything of them is left.
  bool add_going(const ecs::Children& children, const DrawFacts& node, const Ground& ground);

 private:
  struct Model {
    ecs::Entity entity;
    bool merged;  // everything that stands on a node, in parts
    const Placed& placed;
    const Mesh& mesh;
    glm::vec3 foot;
    const Ground& ground;
  };
  template <class Visit>
  void each_model(const ecs::Children& children, const DrawFacts& node, const Ground& ground,
                  const Visit& visit) const;
  bool add_mesh(const Model& model, const MeshParts* parts, render::MeshDraw draw);
  bool add_model(const Model& model, float fade, std::uint32_t debug_colour);
  void add_old(const Model& model, const Fading& fading, std::uint32_t debug_colour);
  std::uint32_t colour_at(DrawFacts node, const Demand& demand, std::uint8_t level) const;
  bool add_coming(const Model& model, const Demand& demand, Fading& fading, bool fades_in,
                  const DrawFacts& node);
  bool add_going(const Model& model, const Demand& demand, Fading& fading, const DrawFacts& node);

  render::View shown_;
  FadeStep step_;
  const Camera& camera_;
  const WorldFacts& facts_;
  const View& view_;
  const RenderQuery& entities_;
  DrawLists& draws_;
  Counters& counters_;
};

}  // namespace psygen::scene
