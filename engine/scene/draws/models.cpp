#include "engine/scene/draws/models.hpp"

#include <algorithm>

#include "engine/scene/draws/mesh_parts.hpp"
#include "engine/scene/draws/missing.hpp"
#include "engine/scene/draws/seen.hpp"

namespace psygen::scene {
namespace {

// A row of the columns of a model.
struct ModelRow {
  const Placed& placed;
  const Demand& demand;
  const Mesh& mesh;
  Fading& fading;
  const MeshParts* parts;      // of a merged mesh; null for a single model
  const MeshParts* old_parts;  // … of what it takes the place of
};

// visit(row) for all models of a node.
template <class Visit>
void each_model(const RenderQuery& entities, const ecs::Children& children, bool merged,
                const Visit& visit) {
  entities.each_of<const Placed, const Demand, const Mesh, Fading>(
      entities.children(children),
      [&](auto rows, auto placed, auto demands, auto meshes, auto fading) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const bool replaces = merged && fading[i].old_mesh;
          visit(ModelRow{placed[i], demands[i], meshes[i], fading[i],
                         merged ? entities.get<MeshParts>(rows[i]) : nullptr,
                         replaces ? &entities.get<OldParts>(rows[i])->parts : nullptr});
        }
      });
}

// Adds `draw`, of which mesh, share and colour are set. Returns whether anything can be seen.
bool add_mesh(const ModelGround& ground, const View& view, const Placed& placed,
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
  // What is not in the picture may cast a shadow into it.
  return add_parts(*parts, ground.shadows ? nullptr : &view, *ground.sun, ground.side_m, draw,
                   draws);
}

// Single models have levels of their own.
std::uint32_t colour_at(const ModelGround& ground, const Demand& demand, std::uint8_t level) {
  DrawFacts facts = ground.node;
  if (facts.level == 0) {
    facts.level = level;
    facts.coarser = static_cast<std::uint32_t>(std::max(level - demand.wanted_level, 0));
  }
  return colour_of(ground.shown, facts);
}

// The mesh that the model has. Returns whether anything of it can be seen.
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

// What the mesh replaces, in the pixels that it leaves out.
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

// Returns whether anything of it can be seen.
bool add_coming(const ModelGround& ground, const View& view, const ModelRow& model, bool fades_in,
                DrawLists& draws) {
  const float share = come(model.fading, ground.step, fades_in);
  if (!add_present(ground, view, model, share, draws)) return false;
  if (model.fading.old_mesh) add_replaced(ground, view, model, draws);
  return true;
}

// Returns whether anything of it is left.
bool add_going(const ModelGround& ground, const View& view, const ModelRow& model,
               DrawLists& draws) {
  const bool there = model.demand.drawn_level != kNoLevel;
  const glm::vec3 foot = ground.corner + model.placed.position;
  if (!there || !mesh_can_be_seen(model.mesh.tight, foot, view)) return false;
  const float share = go(model.fading, ground.step);
  return share > 0 && add_present(ground, view, model, share - 1.0F, draws);
}

}  // namespace

void add_models(const ModelGround& ground, NodeEntry entry, bool twice, const Camera& camera,
                const View& view, const RenderQuery& entities, const ecs::Children& children,
                DrawLists& draws, Counters& counters) {
  const bool merged = ground.node.level > 0;
  each_model(entities, children, merged, [&](const ModelRow& model) {
    const Demand& demand = model.demand;
    if (demand.in_view_tick != ground.step.tick) return;
    if (demand.wanted_level == kNoLevel) {  // too small by now
      add_going(ground, view, model, draws);
      return;
    }
    const bool hole = demand.drawn_level == kNoLevel;
    const bool appears = entry == NodeEntry::kStays && demand.entered_tick != ground.step.tick;
    const bool fades_in = appears || entry == NodeEntry::kReplaces;
    if (!hole && !add_coming(ground, view, model, fades_in, draws)) return;
    count_seen(camera,
               {.centre = ground.corner + model.placed.position + model.placed.middle,
                .radius_m = model.placed.radius_m,
                .hole = hole,
                .coarse = !hole && demand.drawn_level > demand.wanted_level + 1,
                .twice = twice && merged,
                .awaits = demand.failed_levels == 0},
               counters);
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

}  // namespace psygen::scene
