#include "engine/scene/draws/models.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/scene/draws/draw_lists.hpp"
#include "engine/scene/view/visibility.hpp"

namespace psygen::scene {
namespace {

// A row of the columns of a model.
struct ModelRow {
  const MeshPlacement& placed;
  const MeshDemand& demand;
  const Mesh& mesh;
  Fading& fading;
  const MeshParts* parts;      // of a merged mesh; null for an individual model
  const MeshParts* old_parts;  // of the mesh that it replaces
};

// Calls visit(row) for all models of a node. Its water is none.
template <class Visit>
void each_model(const RenderQuery& entities, const ecs::Children& children, bool merged,
                const Visit& visit) {
  entities.each_of<const MeshPlacement, const MeshDemand, const Mesh, Fading>(
      entities.children(children),
      [&](auto rows, auto placed, auto demands, auto meshes, auto fading) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          if (placed[i].surface == core::SurfaceKind::kWater) continue;
          const bool replaces = merged && fading[i].old_mesh;
          visit(ModelRow{placed[i], demands[i], meshes[i], fading[i],
                         merged ? entities.get<MeshParts>(rows[i]) : nullptr,
                         replaces ? &entities.get<ReplacedParts>(rows[i])->parts : nullptr});
        }
      });
}

// Adds `draw`, whose mesh, fade and colour are set. Returns true if any part may be visible.
bool add_mesh(const ModelGround& ground, const View& view, const MeshPlacement& placed,
              const MeshParts* parts, render::MeshDraw draw, std::vector<render::MeshDraw>& draws) {
  draw.origin = ground.corner + placed.position;
  draw.box_centre = placed.box_centre;
  draw.box_half_extent = placed.box_half_extent;
  draw.surface = placed.surface;
  if (parts == nullptr) {
    draw.near = ground.near_detail && !draw.pictured &&
                placed.surface != core::SurfaceKind::kPlain &&
                glm::length(draw.origin + placed.middle) < render::kNearModelsM + placed.radius_m;
    draw.sun = sun_at(*ground.sun, glm::vec2(placed.position.x, placed.position.z) / ground.side_m);
    draws.push_back(draw);
    return true;
  }
  // A model out of view may cast a shadow into the frame.
  return add_parts(*parts, ground.shadows ? nullptr : &view, *ground.sun, ground.side_m, draw,
                   draws);
}

// Individual models show their own LOD.
std::uint32_t colour_at(const ModelGround& ground, const MeshDemand& demand, std::uint8_t level) {
  DrawFacts facts = ground.node;
  if (facts.level == 0) {
    facts.level = level;
    facts.coarser = static_cast<std::uint32_t>(std::max(level - demand.wanted_level, 0));
  }
  return colour_of(ground.shown, facts);
}

// Adds the present mesh of a model. Returns true if any part may be visible.
bool add_present(const ModelGround& ground, const View& view, const ModelRow& model, float fade,
                 DrawLists& draws) {
  render::MeshDraw draw;
  draw.range = model.mesh.range;
  draw.shared_indices = model.mesh.shared_indices;
  draw.fade = fade;
  draw.pictured = ground.pictures || model.demand.pictured;
  draw.debug_colour = colour_at(ground, model.demand, model.demand.drawn_level);
  if (!add_mesh(ground, view, model.placed, model.parts, draw, draws.models)) return false;
  draws.meshes.push_back(model.mesh.handle);
  return true;
}

// Adds the replaced mesh, in the pixels that the present one leaves out.
void add_replaced(const ModelGround& ground, const View& view, const ModelRow& model,
                  DrawLists& draws) {
  const Fading& fading = model.fading;
  render::MeshDraw draw;
  draw.range = fading.old_range;
  draw.shared_indices = fading.old_shared_indices;
  draw.fade = -fading.share;
  draw.pictured = ground.pictures || fading.old_pictured;
  draw.debug_colour = colour_at(ground, model.demand, fading.old_level);
  if (add_mesh(ground, view, model.placed, model.old_parts, draw, draws.models))
    draws.meshes.push_back(fading.old_mesh);
}

// Adds a model that is drawn. Returns true if any part may be visible.
bool add_coming(const ModelGround& ground, const View& view, const ModelRow& model, bool fades_in,
                DrawLists& draws) {
  const float share = advance_fade_in(model.fading, ground.step, fades_in);
  if (!add_present(ground, view, model, share, draws)) return false;
  if (model.fading.old_mesh) add_replaced(ground, view, model, draws);
  return true;
}

// Adds a model that fades out. Returns true if any pixel is left.
bool add_going(const ModelGround& ground, const View& view, const ModelRow& model,
               DrawLists& draws) {
  const bool there = model.demand.drawn_level != kNoLevel;
  const glm::vec3 foot = ground.corner + model.placed.position;
  if (!there || !mesh_may_be_visible(model.mesh.tight, foot, view)) return false;
  const float share = advance_fade_out(model.fading, ground.step);
  return share > 0 && add_present(ground, view, model, share - 1.0F, draws);
}

glm::vec2 flat(glm::vec3 v) {
  return {v.x, v.z};
}

// Rounds in steps so large that neighbours can often share a draw.
float in_steps(float share) {
  constexpr float kSteps = 6;
  return std::round(share * kSteps) / kSteps;
}

}  // namespace

void add_models(const ModelGround& ground, NodeEntry entry, bool twice,
                const RenderContext& context, const RenderQuery& entities,
                const ecs::Children& children, DrawLists& draws) {
  const View& view = context.view;
  const bool merged = ground.node.level > 0;
  each_model(entities, children, merged, [&](const ModelRow& model) {
    const MeshDemand& demand = model.demand;
    if (demand.in_view_tick != ground.step.tick) return;
    if (demand.wanted_level == kNoLevel) {  // too small by now
      add_going(ground, view, model, draws);
      return;
    }
    const bool hole = demand.drawn_level == kNoLevel;
    const bool appears = entry == NodeEntry::kStays && demand.entered_tick != ground.step.tick;
    const bool fades_in = appears || entry == NodeEntry::kReplaces;
    if (!hole && !add_coming(ground, view, model, fades_in, draws)) return;
    count_visible(context.camera,
                  {.centre = ground.corner + model.placed.position + model.placed.middle,
                   .radius_m = model.placed.radius_m,
                   .hole = hole,
                   .coarse = !hole && demand.drawn_level > demand.wanted_level + 1,
                   .twice = twice && merged,
                   .awaits = demand.failed_levels == 0},
                  draws.counts);
  });
}

bool add_going_models(const ModelGround& ground, const View& view, const RenderQuery& entities,
                      const ecs::Children& children, DrawLists& draws) {
  bool any = false;
  each_model(entities, children, ground.node.level > 0, [&](const ModelRow& model) {
    if (add_going(ground, view, model, draws)) any = true;
  });
  return any;
}

void add_water(const ModelGround& ground, const RenderContext& context, const RenderQuery& entities,
               const ecs::Children& children, DrawLists& draws) {
  entities.each_of<const MeshPlacement, const MeshDemand, const Mesh>(
      entities.children(children), [&](auto rows, auto placed, auto demands, auto meshes) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          if (placed[i].surface != core::SurfaceKind::kWater) continue;
          if (demands[i].in_view_tick != ground.step.tick) continue;
          const bool hole = demands[i].drawn_level == kNoLevel;
          count_visible(context.camera,
                        {.centre = ground.corner + placed[i].middle,
                         .radius_m = placed[i].radius_m,
                         .hole = hole,
                         .awaits = demands[i].failed_levels == 0},
                        draws.counts);
          if (hole || !mesh_may_be_visible(meshes[i].tight, ground.corner, context.view)) continue;
          render::MeshDraw draw;
          draw.range = meshes[i].range;
          draw.origin = ground.corner;
          draw.box_centre = placed[i].box_centre;
          draw.box_half_extent = placed[i].box_half_extent;
          draws.water.push_back(draw);
          draws.meshes.push_back(meshes[i].handle);
        }
      });
}

bool add_parts(const MeshParts& parts, const View* view, const GroundSunlight& sun, float side_m,
               const render::MeshDraw& draw, std::vector<render::MeshDraw>& draws) {
  bool any = false;
  DrawParts run(draw, draws);
  for (std::uint32_t i = 0; i < parts.count; ++i) {
    if (view != nullptr && !mesh_may_be_visible(parts.boxes[i], draw.origin, *view)) continue;
    run.set(&render::MeshDraw::sun, in_steps(sun_over(sun, flat(parts.boxes[i].min) / side_m,
                                                      flat(parts.boxes[i].max) / side_m)));
    const std::uint32_t first = i * parts.indices_each;
    run.add({first, std::min(parts.indices_each, parts.index_count - first)});
    any = true;
  }
  return any;
}

}  // namespace psygen::scene
