#include "engine/render/meshes/terrain.hpp"

namespace psygen::render {

using core::Result;

namespace {

constexpr float kLargestGrid = 127.0F;  // cells (core::TerrainVertex)

PipelineShape terrain_shape(Shader vert, std::optional<Shader> frag) {
  return {.vert = vert,
          .frag = frag,
          .vertices = core::VertexLayout::kTerrain,
          .depth = DepthUse::kWrite};
}

}  // namespace

shaders::DrawData data_of(const TerrainDraw& draw) {
  return {.origin = {draw.origin.x, draw.origin.y + draw.height_min_m, draw.origin.z, draw.cell_m},
          .scale = {draw.height_range_m, draw.skirt_m, draw.morph, draw.cover},
          .light = {},
          .turn = {}};
}

void set_colour(shaders::DrawData& data, const TerrainDraw& draw) {
  data.scale.w = static_cast<float>(draw.debug_colour & 0xFFFFFF);
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
  const MeshLook look = lit ? MeshLook::kLit : MeshLook::kColour;
  const Shader far = !lit                ? Shader::kSurfaceFrag
                     : traits.fine_grain ? Shader::kGroundLitNearGroundFrag
                                         : Shader::kGroundLitFrag;
  Result<void> made;
  for (const bool pushed : {false, true}) {
    PipelineShape shape = terrain_shape(mesh_shader(Shader::kTerrainVert, look, pushed), far);
    shape.constants = {on(traits.fine_grain), on(traits.cascades > 0), on(lamps)};
    if (made) {
      made = tables.add(setup, shape, MeshUse::kLandscape,
                        [&](MeshVariant v) { return v.pushed == pushed && v.lamps == lamps; });
    }
    // Where light is per vertex, near ground has a texture. Where it is per pixel and not rich,
    // only near ground has the textures of its kinds.
    if (!made || traits.fine_grain) continue;
    shape.frag = lit ? Shader::kGroundLitNearGroundFrag : Shader::kGroundDetailFrag;
    if (!lit) {
      shape.vert =
          pushed ? Shader::kTerrainGroundDetailDrawPushedVert : Shader::kTerrainGroundDetailVert;
    }
    made = tables.add(setup, shape, MeshUse::kLandscape, [&](MeshVariant v) {
      return v.pushed == pushed && v.lamps == lamps && v.coverage == Coverage::kPart;
    });
  }
  return made;
}

Result<void> add_terrain_views(const PassSetup& setup, MeshTables& tables) {
  Result<void> made;
  for (const bool pushed : {false, true}) {
    const auto add = [&](MeshUse use, const PipelineShape& shape) {
      if (made)
        made = tables.add(setup, shape, use, [&](MeshVariant v) { return v.pushed == pushed; });
    };
    const auto vert = [&](MeshLook look) {
      return mesh_shader(Shader::kTerrainVert, look, pushed);
    };
    add(MeshUse::kDrawColour, terrain_shape(vert(MeshLook::kDrawColour), Shader::kSurfaceFrag));
    if (setup.device.info.wireframe) {
      PipelineShape edges = terrain_shape(vert(MeshLook::kColour), Shader::kSurfaceFrag);
      edges.wireframe = true;
      add(MeshUse::kWireframe, edges);
    }
    if (setup.traits.cascades > 0) {
      PipelineShape shadow = terrain_shape(vert(MeshLook::kShadow), std::nullopt);
      shadow.target = DrawTarget::kShadowMap;
      add(MeshUse::kShadow, shadow);
    }
  }
  return made;
}

}  // namespace psygen::render
