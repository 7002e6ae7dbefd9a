#include <cmath>

#include "engine/render/meshes/layouts.hpp"

namespace psygen::render {

using core::Result;

namespace {

static_assert(static_cast<int>(core::SurfaceKind::kStone) == PSYGEN_SURFACE_STONE);
static_assert(static_cast<int>(core::SurfaceKind::kBark) == PSYGEN_SURFACE_BARK);

// The fragment shaders of a use: of whole models, of fading ones, of those with pictures, and of
// near ones, which look like fading ones without.
struct ModelShaders {
  std::optional<Shader> whole;
  Shader fading, pictured;
  std::optional<Shader> near = {};
};

// Adds the pipelines of a look: of whole models, then of those that cover only some of their
// pixels. `shape` has what all share; `fits` says which variants they may be used for.
template <class Fits>
Result<void> add_models(const PassSetup& setup, PipelineShape shape, const ModelShaders& shaders,
                        MeshLook look, MeshUse use, const Fits& fits, MeshTables& tables) {
  shape.vertices = core::VertexLayout::kModel;
  shape.depth = DepthUse::kWrite;
  Result<void> made;
  const auto add = [&](Shader vert, std::optional<Shader> frag, auto&& covers) {
    shape.vert = vert;
    shape.frag = frag;
    if (!made) return;
    made =
        tables.add(setup, shape, use, [&](MeshVariant v) { return fits(v) && covers(v.coverage); });
  };
  add(mesh_shader(Shader::kModelVert, look), shaders.whole,
      [](Coverage c) { return c == Coverage::kWhole; });
  add(mesh_shader(Shader::kModelFadingVert, look), shaders.fading,
      [&](Coverage c) { return c == Coverage::kPart || (c == Coverage::kNear && !shaders.near); });
  add(mesh_shader(Shader::kModelFadingPictureVert, look), shaders.pictured,
      [](Coverage c) { return c == Coverage::kPictured; });
  if (shaders.near)
    add(Shader::kModelFadingModelDetailVert, shaders.near,
        [](Coverage c) { return c == Coverage::kNear; });
  return made;
}

}  // namespace

shaders::DrawData data_of(const MeshDraw& draw, bool coloured) {
  // The phase depends on the mesh, not on the camera. Neighbours differ because their boxes do.
  const float phase = 7.31F * (draw.box_half_extent.x + draw.box_centre.x + draw.box_centre.z);
  return {.origin = {draw.origin + draw.box_centre,
                     coloured ? packed_colour(draw.debug_colour) : phase - std::floor(phase)},
          .scale = {draw.box_half_extent, draw.fade},
          .light = {draw.sun, static_cast<float>(draw.surface), 0, 0},
          .turn = {}};
}

core::Bounds bounds_of(const MeshDraw& draw) {
  return core::Bounds::around(draw.origin + draw.box_centre, draw.box_half_extent + kSwayM);
}

Result<void> add_model_pipelines(const PassSetup& setup, bool lamps, MeshTables& tables) {
  const PresetTraits& traits = setup.traits;
  const bool lit = traits.pixel_light;
  const auto fits = [&](MeshVariant v) { return v.lamps == lamps; };
  PipelineShape shape;
  shape.constants = {on(traits.fine_grain), on(traits.cascades > 0), on(lamps)};
  // With light per vertex, near models have textures. With light per pixel, all models have.
  const ModelShaders shaders = lit ? ModelShaders{.whole = Shader::kSurfaceLitFrag,
                                                  .fading = Shader::kSurfaceLitFadingFrag,
                                                  .pictured = Shader::kSurfaceLitFadingPictureFrag}
                                   : ModelShaders{.whole = Shader::kSurfaceFrag,
                                                  .fading = Shader::kSurfaceFadingFrag,
                                                  .pictured = Shader::kSurfaceFadingPictureFrag,
                                                  .near = Shader::kModelDetailFadingFrag};
  return add_models(setup, shape, shaders, lit ? MeshLook::kLit : MeshLook::kColour,
                    MeshUse::kLandscape, fits, tables);
}

Result<void> add_model_views(const PassSetup& setup, MeshTables& tables) {
  const auto all = [](MeshVariant) { return true; };
  Result<void> made = add_models(setup, {},
                                 {.whole = Shader::kSurfaceFrag,
                                  .fading = Shader::kSurfaceFadingFrag,
                                  .pictured = Shader::kSurfaceFadingPictureDrawColourFrag},
                                 MeshLook::kDrawColour, MeshUse::kDrawColour, all, tables);
  if (made && setup.traits.cascades > 0) {
    PipelineShape shadow;
    shadow.target = DrawTarget::kShadowMap;
    made = add_models(setup, shadow,
                      {.whole = std::nullopt,
                       .fading = Shader::kShadowFadingFadingFrag,
                       .pictured = Shader::kShadowFadingFadingPictureFrag},
                      MeshLook::kShadow, MeshUse::kShadow, all, tables);
  }
  if (!made || !setup.device.info.wireframe) return made;
  // Edges show all of a model.
  const PipelineShape edges{.vert = Shader::kModelVert,
                            .frag = Shader::kSurfaceFrag,
                            .vertices = core::VertexLayout::kModel,
                            .depth = DepthUse::kWrite,
                            .wireframe = true};
  return tables.add(setup, edges, MeshUse::kWireframe, all);
}

}  // namespace psygen::render
