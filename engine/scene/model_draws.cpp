#include "engine/scene/model_draws.hpp"

#include <algorithm>

#include "engine/scene/mesh_parts.hpp"
#include "engine/scene/missing.hpp"
#include "engine/scene/seen.hpp"

namespace psygen::scene {
namespace {

render::MeshDraw draw_of(const Placed& placed, glm::vec3 foot, float fade,
                         std::uint32_t debug_colour) {
  render::MeshDraw draw;
  draw.origin = foot;
  draw.box_center = placed.box_center;
  draw.box_half_extent = placed.box_half_extent;
  draw.fade = fade;
  draw.debug_colour = debug_colour;
  return draw;
}

}  // namespace

const MeshParts* ModelDraws::parts_of(ecs::Entity entity, const DrawFacts& node) const {
  return node.level == 0 || facts_.shadows ? nullptr : entities_.get<MeshParts>(entity);
}

// Where its parts are known only those that can be seen. Returns whether any can.
bool ModelDraws::add_model(const Model& model, float fade, std::uint32_t debug_colour) {
  render::MeshDraw draw = draw_of(model.placed, model.foot, fade, debug_colour);
  draw.range = model.mesh.range;
  draw.shared_indices = model.mesh.shared_indices;
  if (model.parts == nullptr || model.parts->indices_each == 0) {
    draws_.models.push_back(draw);
  } else if (!add_parts(*model.parts, view_, draw, draws_.models)) {
    return false;
  }
  draws_.meshes.push_back(model.mesh.handle);
  return true;
}

// What the mesh replaces, in the pixels that it leaves out.
void ModelDraws::add_old(const Model& model, const Fading& fading, std::uint32_t debug_colour) {
  render::MeshDraw draw = draw_of(model.placed, model.foot, -fading.share, debug_colour);
  draw.range = fading.old_range;
  draw.shared_indices = fading.old_shared_indices;
  draws_.models.push_back(draw);
  draws_.meshes.push_back(fading.old_mesh);
}

bool ModelDraws::add_one_going(const Model& model, const Demand& demand, Fading& fading,
                               std::uint32_t debug_colour) {
  const bool there = demand.drawn_level != kNoLevel;
  if (!there || !mesh_can_be_seen(model.mesh.tight, model.foot, view_)) return false;
  const float share = go(fading, step_);
  if (share <= 0) return false;
  add_model(model, share - 1.0F, debug_colour);
  return true;
}

void ModelDraws::add(const ecs::Children& children, Node node, DrawFacts facts, glm::vec3 corner) {
  const bool single = facts.level == 0;
  const DrawFacts node_facts = facts;
  entities_.each_of<const Placed, const Demand, const Mesh, Fading>(
      entities_.children(children),
      [&](std::span<const ecs::Entity> rows, std::span<const Placed> placed,
          std::span<const Demand> demands, std::span<const Mesh> meshes, std::span<Fading> fading) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const Demand& demand = demands[i];
          if (demand.in_view_tick != step_.tick) continue;
          const Model model{parts_of(rows[i], node_facts), placed[i], meshes[i],
                            corner + placed[i].position};
          const bool hole = demand.drawn_level == kNoLevel;
          if (single && !hole) {
            facts.level = demand.drawn_level;
            facts.coarser =
                static_cast<std::uint32_t>(std::max(demand.drawn_level - demand.wanted_level, 0));
          }
          const std::uint32_t colour = colour_of(shown_, facts);
          if (demand.wanted_level == kNoLevel) {  // too small by now
            add_one_going(model, demand, fading[i], colour);
            continue;
          }
          if (!hole) {
            const bool fades_in = node == Node::kReplaces ||
                                  (node == Node::kStays && demand.entered_tick != step_.tick);
            const float share = come(fading[i], step_, fades_in);
            if (!add_model(model, share, colour)) continue;
            if (fading[i].old_mesh) add_old(model, fading[i], colour);
          }
          count_seen(camera_, model.foot + placed[i].middle, placed[i].radius_m, hole,
                     !hole && demand.drawn_level > demand.wanted_level + 1, counters_);
        }
      });
}

bool ModelDraws::add_going(const ecs::Children& children, DrawFacts facts, glm::vec3 corner) {
  bool any = false;
  entities_.each_of<const Placed, const Demand, const Mesh, Fading>(
      entities_.children(children),
      [&](std::span<const ecs::Entity> rows, std::span<const Placed> placed,
          std::span<const Demand> demands, std::span<const Mesh> meshes, std::span<Fading> fading) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const Model model{parts_of(rows[i], facts), placed[i], meshes[i],
                            corner + placed[i].position};
          if (add_one_going(model, demands[i], fading[i], colour_of(shown_, facts))) any = true;
        }
      });
  return any;
}

}  // namespace psygen::scene
