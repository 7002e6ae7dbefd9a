#include "engine/render/meshes/layouts.hpp"

namespace psygen::render {

using core::Result;

namespace {

constexpr float kLargestGrid = 127.0F;  // cells (core::TerrainVertex)

PipelineShape terrain_shape(MeshLook look, std::optional<Shader> frag) {
  return {.vert = mesh_shader(Shader::kTerrainVert, look),
          .frag = frag,
          .vertices = core::VertexLayout::kTerrain,
          .depth = DepthUse::kWrite};
}

}  // namespace

shaders::DrawData data_of(const TerrainDraw& draw, bool coloured) {
  return {.origin = {draw.origin.x, draw.origin.y + draw.height_min_m, draw.origin.z, draw.cell_m},
          .scale = {draw.height_range_m, draw.skirt_m, draw.morph,
                    coloured ? packed_colour(draw.debug_colour) : draw.cover},
          .light = {},
          .turn = {}};
}

core::Bounds bounds_of(const TerrainDraw& draw) {
  const float side = draw.side_m > 0 ? draw.side_m : kLargestGrid * draw.cell_m;
  const float bottom = draw.origin.y + draw.height_min_m;
  return {{draw.origin.x, bottom - draw.skirt_m, draw.origin.z},
          {draw.origin.x + side, bottom + draw.height_range_m, draw.origin.z + side}};
}

Result<void> add_terrain_pipelines(const PassSetup& setup, bool lamps, MeshTables& tables) {
  const PresetTraits& traits = setup.traits;
  const bool lit = traits.pixel_light;
  const Shader far = !lit                ? Shader::kSurfaceFrag
                     : traits.fine_grain ? Shader::kGroundLitNearGroundFrag
                                         : Shader::kGroundLitFrag;
  PipelineShape shape = terrain_shape(lit ? MeshLook::kLit : MeshLook::kColour, far);
  shape.constants = {on(traits.fine_grain), on(traits.cascades > 0), on(lamps)};
  Result<void> made = tables.add(setup, shape, MeshUse::kLandscape,
                                 [&](MeshVariant v) { return v.lamps == lamps; });
  // Where light is per vertex, near ground has a texture. Where it is per pixel and not rich, only
  // near ground has the textures of its kinds.
  if (!made || traits.fine_grain) return made;
  shape.frag = lit ? Shader::kGroundLitNearGroundFrag : Shader::kGroundDetailFrag;
  if (!lit) shape.vert = Shader::kTerrainGroundDetailVert;
  return tables.add(setup, shape, MeshUse::kLandscape, [&](MeshVariant v) {
    return v.lamps == lamps && v.coverage == Coverage::kPart;
  });
}

Result<void> add_terrain_views(const PassSetup& setup, MeshTables& tables) {
  const auto all = [](MeshVariant) { return true; };
  Result<void> made = tables.add(setup, terrain_shape(MeshLook::kDrawColour, Shader::kSurfaceFrag),
                                 MeshUse::kDrawColour, all);
  if (made && setup.device.info.wireframe) {
    PipelineShape edges = terrain_shape(MeshLook::kColour, Shader::kSurfaceFrag);
    edges.wireframe = true;
    made = tables.add(setup, edges, MeshUse::kWireframe, all);
  }
  if (made && setup.traits.cascades > 0) {
    PipelineShape shadow = terrain_shape(MeshLook::kShadow, std::nullopt);
    shadow.target = DrawTarget::kShadowMap;
    made = tables.add(setup, shadow, MeshUse::kShadow, all);
  }
  return made;
}

}  // namespace psygen::render
