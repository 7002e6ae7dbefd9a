#include "engine/scene/draws/models.hpp"

#include <algorithm>

#include "engine/scene/draws/mesh_parts.hpp"
#include "engine/scene/draws/missing.hpp"
#include "engine/scene/draws/seen.hpp"

namespace psygen::scene {

// What is the same of what comes and what goes; without parts, of a single model.
bool ModelDraws::add_mesh(const Model& model, const MeshParts* parts, render::MeshDraw draw) {
  const auto& [corner, side_m, sun] = model.ground;
  draw.origin = model.foot;
  draw.box_center = model.placed.box_center;
  draw.box_half_extent = model.placed.box_half_extent;
  if (parts == nullptr) {
    draw.sun = sun_at(sun, glm::vec2(model.placed.position.x, model.placed.position.z) / side_m);
    draws_.models.push_back(draw);
    return true;
  }
  // What is not in the picture may cast a shadow into it.
  return add_parts(*parts, facts_.shadows ? nullptr : &view_, sun, side_m, draw, draws_.models);
}

// Returns whether anything of it can be seen.
bool ModelDraws::add_model(const Model& model, float fade, std::uint32_t debug_colour) {
  render::MeshDraw draw;
  draw.range = model.mesh.range;
  draw.shared_indices = model.mesh.shared_indices;
  draw.fade = fade;
  draw.debug_colour = debug_colour;
  if (!add_mesh(model, model.merged ? entities_.get<MeshParts>(model.entity) : nullptr, draw))
    return false;
  draws_.meshes.push_back(model.mesh.handle);
  return true;
}

// What the mesh replaces, in the pixels that it leaves out.
void ModelDraws::add_old(const Model& model, const Fading& fading, std::uint32_t debug_colour) {
  render::MeshDraw draw;
  draw.range = fading.old_range;
  draw.shared_indices = fading.old_shared_indices;
  draw.fade = -fading.share;
  draw.debug_colour = debug_colour;
  const MeshParts* parts = model.merged ? &entities_.get<OldParts>(model.entity)->parts : nullptr;
  if (add_mesh(model, parts, draw)) draws_.meshes.push_back(fading.old_mesh);
}

// Single models have levels of their own.
std::uint32_t ModelDraws::colour_at(DrawFacts node, const Demand& demand,
                                    std::uint8_t level) const {
  if (node.level == 0) {
    node.level = level;
    node.coarser = static_cast<std::uint32_t>(std::max(level - demand.wanted_level, 0));
  }
  return colour_of(shown_, node);
}

// Returns whether anything of it can be seen.
bool ModelDraws::add_coming(const Model& model, const Demand& demand, Fading& fading, bool fades_in,
                            const DrawFacts& node) {
  const float share = come(fading, step_, fades_in);
  if (!add_model(model, share, colour_at(node, demand, demand.drawn_level))) return false;
  if (fading.old_mesh) add_old(model, fading, colour_at(node, demand, fading.old_level));
  return true;
}

bool ModelDraws::add_going(const Model& model, const Demand& demand, Fading& fading,
                           const DrawFacts& node) {
  const bool there = demand.drawn_level != kNoLevel;
  if (!there || !mesh_can_be_seen(model.mesh.tight, model.foot, view_)) return false;
  const float share = go(fading, step_);
  return share > 0 && add_model(model, share - 1.0F, colour_at(node, demand, demand.drawn_level));
}

// visit(model, demand, fading) for all models of a node.
template <class Visit>
void ModelDraws::each_model(const ecs::Children& children, const DrawFacts& node,
                            const Ground& ground, const Visit& visit) const {
  entities_.each_of<const Placed, const Demand, const Mesh, Fading>(
      entities_.children(children),
      [&](auto rows, auto placed, auto demands, auto meshes, auto fading) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          visit(Model{rows[i], node.level > 0, placed[i], meshes[i],
                      ground.corner + placed[i].position, ground},
                demands[i], fading[i]);
        }
      });
}

void ModelDraws::add(const ecs::Children& children, Node how, const DrawFacts& node,
                     const Ground& ground, bool twice) {
  each_model(children, node, ground, [&](const Model& model, const Demand& demand, Fading& fading) {
    if (demand.in_view_tick != step_.tick) return;
    if (demand.wanted_level == kNoLevel) {  // too small by now
      add_going(model, demand, fading, node);
      return;
    }
    const bool hole = demand.drawn_level == kNoLevel;
    const bool appears = how == Node::kStays && demand.entered_tick != step_.tick;
    const bool fades_in = appears || how == Node::kReplaces;
    if (!hole && !add_coming(model, demand, fading, fades_in, node)) return;
    count_seen(camera_,
               {.center = model.foot + model.placed.middle,
                .radius_m = model.placed.radius_m,
                .hole = hole,
                .coarse = !hole && demand.drawn_level > demand.wanted_level + 1,
                .twice = twice && model.merged,
                .awaits = demand.failed_levels == 0},
               counters_);
  });
}

bool ModelDraws::add_going(const ecs::Children& children, const DrawFacts& node,
                           const Ground& ground) {
  bool any = false;
  each_model(children, node, ground, [&](const Model& model, const Demand& demand, Fading& fading) {
    if (add_going(model, demand, fading, node)) any = true;
  });
  return any;
}

}  // namespace psygen::scene
