#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "engine/render/meshes/layouts.hpp"

namespace psygen::render {

using core::Result;

namespace {

PipelineShape object_shape(MeshLook look, std::optional<Shader> frag) {
  return {.vert = mesh_shader(Shader::kModelObjectVert, look),
          .frag = frag,
          .vertices = core::VertexLayout::kObject,
          .depth = DepthUse::kWrite};
}

}  // namespace

shaders::DrawData data_of(const ObjectDraw& draw, bool coloured) {
  const glm::vec3 centre = draw.origin + object_axes(draw) * draw.box_centre;
  const auto number = static_cast<float>(std::min(draw.material, PSYGEN_MAX_MATERIALS - 1U));
  const float phase = 0.9375F * (draw.phase - std::floor(draw.phase));  // stays below the number
  return {.origin = {centre, coloured ? packed_colour(draw.debug_colour) : number + phase},
          .scale = {draw.scale * draw.box_half_extent, draw.fade},
          .light = {draw.sun, 1.0F / draw.scale.x, 1.0F / draw.scale.y, 1.0F / draw.scale.z},
          .turn = {draw.rotation[0], draw.rotation[1], draw.rotation[2], draw.rotation[3]}};
}

// Each half extent of the box around the turned box is the sum of the projections of its axes.
core::Bounds bounds_of(const ObjectDraw& draw) {
  const glm::mat3 axes = object_axes(draw);
  const glm::vec3 extent = glm::abs(axes[0]) * draw.box_half_extent.x +
                           glm::abs(axes[1]) * draw.box_half_extent.y +
                           glm::abs(axes[2]) * draw.box_half_extent.z;
  return core::Bounds::around(draw.origin + axes * draw.box_centre, extent + kSwayM);
}

glm::mat3 object_axes(const ObjectDraw& draw) {
  const auto [x, y, z, w] = draw.rotation;
  return {
      glm::vec3(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)) * draw.scale.x,
      glm::vec3(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)) * draw.scale.y,
      glm::vec3(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)) * draw.scale.z};
}

// With light per vertex, textured objects are lit per pixel.
Result<void> add_object_pipelines(const PassSetup& setup, bool lamps, MeshTables& tables) {
  Result<void> made;
  for (std::size_t i = 0; i < 4 && made; ++i) {
    const bool textured = (i & 1U) != 0, fading = (i & 2U) != 0;
    const bool lit = setup.traits.pixel_light || textured;
    const Shader frag =
        textured ? (fading ? Shader::kObjectTexturedFadingFrag : Shader::kObjectTexturedFrag)
        : lit    ? (fading ? Shader::kObjectFadingFrag : Shader::kObjectFrag)
                 : (fading ? Shader::kSurfaceFadingFrag : Shader::kSurfaceFrag);
    PipelineShape shape = object_shape(lit ? MeshLook::kLit : MeshLook::kColour, frag);
    shape.constants = {VK_FALSE, on(setup.traits.cascades > 0), on(lamps)};
    made = tables.add(setup, shape, MeshUse::kLandscape, [&](MeshVariant v) {
      return v.textured == textured && v.lamps == lamps &&
             (v.coverage != Coverage::kWhole) == fading;
    });
  }
  return made;
}

// Views for debugging show no textures; edges show all of an object.
Result<void> add_object_views(const PassSetup& setup, MeshTables& tables) {
  Result<void> made;
  const auto add = [&](MeshUse use, PipelineShape shape, auto&& fits) {
    if (!made) return;
    shape.constants = {VK_FALSE, on(setup.traits.cascades > 0)};
    made = tables.add(setup, shape, use, fits);
  };
  const auto whole = [](MeshVariant v) { return v.coverage == Coverage::kWhole; };
  const auto fading = [](MeshVariant v) { return v.coverage != Coverage::kWhole; };
  add(MeshUse::kDrawColour, object_shape(MeshLook::kDrawColour, Shader::kSurfaceFrag), whole);
  add(MeshUse::kDrawColour, object_shape(MeshLook::kDrawColour, Shader::kSurfaceFadingFrag),
      fading);
  if (setup.device.info.wireframe) {
    PipelineShape edges = object_shape(MeshLook::kColour, Shader::kSurfaceFrag);
    edges.wireframe = true;
    add(MeshUse::kWireframe, edges, [](MeshVariant) { return true; });
  }
  if (setup.traits.cascades == 0) return made;
  const auto add_shadow = [&](std::optional<Shader> frag, auto&& fits) {
    PipelineShape shadow = object_shape(MeshLook::kShadow, frag);
    shadow.target = DrawTarget::kShadowMap;
    add(MeshUse::kShadow, shadow, fits);
  };
  add_shadow(std::nullopt, whole);
  add_shadow(Shader::kShadowFadingFadingFrag,
             [&](MeshVariant v) { return fading(v) && !v.textured; });
  add_shadow(Shader::kObjectShadowFadingTexturedFrag,
             [&](MeshVariant v) { return fading(v) && v.textured; });
  return made;
}

}  // namespace psygen::render
