#include "engine/render/pipelines.hpp"

#include <utility>

#include "engine/render/progress.hpp"

namespace psygen::render {

using core::Result;

namespace {

// Largest number of pipelines of a preset, for the progress.
constexpr double kMaxPipelines = 34;

constexpr VkBool32 on(bool yes) {
  return yes ? VK_TRUE : VK_FALSE;
}

}  // namespace

Result<void> Pipelines::create(const Device& device, VkFormat colour_format,
                               const PresetTraits& traits, const Overlay& overlay,
                               std::uint32_t sets, const MaterialTable& materials,
                               const ModelPictures& pictures,
                               std::span<const GroundPicture> ground) {
  traits_ = traits;
  samples_ = device.samples_for(traits.samples);
  colour_format_ = colour_format;
  return bindings_.create(device, traits, overlay, sets, materials, pictures, ground).and_then([&] {
    const Progress nobody;
    Making alone{device, nobody};
    PipelineShape shape = usual_shape();
    shape.kind = PipelineKind::kOverlay;
    shape.vert = other_code().overlay_vert;
    shape.frag = other_code().overlay_frag;
    if (Result<void> made = make(alone, shape, overlay_); !made) return made;
    shape.flat = true;
    if (Result<void> made = make(alone, shape, overlay_over_coarse_); !made) return made;
    shape.kind = PipelineKind::kScaleUp;
    shape.vert = other_code().scale_up_vert;
    shape.frag = other_code().scale_up_frag;
    return make(alone, shape, scale_up_);
  });
}

PipelineShape Pipelines::usual_shape() const {
  PipelineShape shape;
  shape.colour_format = colour_format_;
  shape.samples = samples_;
  return shape;
}

Result<void> Pipelines::make(Making& making, const PipelineShape& shape, UniquePipeline& out) {
  Result<UniquePipeline> made = make_pipeline(making.device, layout(), shape);
  if (!made) return tl::unexpected(made.error());
  out = std::move(*made);
  const double fraction = static_cast<double>(++making.count) / kMaxPipelines;
  return go_on(making.progress, fraction);
}

Result<void> Pipelines::create_meshes(Making& making, PipelineShape shape, MeshLook look,
                                      MeshPipelines& out) {
  for (const auto layout : {core::VertexLayout::kTerrain, core::VertexLayout::kModel}) {
    const bool terrain = layout == core::VertexLayout::kTerrain;
    shape.kind = terrain ? PipelineKind::kTerrain : PipelineKind::kModel;
    if (look == MeshLook::kLit) shape.frag = lit_frag(terrain);
    for (const bool pushed : {false, true}) {
      shape.vert = mesh_vertex_code(layout, look, pushed);
      const Result<void> made = make(making, shape, out.whole[terrain ? 0 : 1][pushed ? 1 : 0]);
      if (!made) return made;
    }
  }
  return {};
}

// Where light is per vertex, near ground has a texture. Where it is per pixel and not rich, only
// near ground has the textures of its kinds.
Result<void> Pipelines::create_near_ground(Making& making, PipelineShape shape,
                                           MeshPipelines& out) {
  if (traits_.fine_grain) return {};
  const OtherCode& code = other_code();
  const bool lit = traits_.pixel_light;
  shape.kind = PipelineKind::kTerrain;
  shape.frag = lit ? code.ground_lit_near_frag : code.ground_detail_frag;
  for (const bool pushed : {false, true}) {
    shape.vert = lit      ? mesh_vertex_code(core::VertexLayout::kTerrain, MeshLook::kLit, pushed)
                 : pushed ? code.terrain_detail_pushed_vert
                          : code.terrain_detail_vert;
    const Result<void> made = make(making, shape, out.near_ground[pushed ? 1 : 0]);
    if (!made) return made;
  }
  return {};
}

// Where light is per vertex, near models have textures. Where it is per pixel all models have.
Result<void> Pipelines::create_near_models(Making& making, PipelineShape shape,
                                           MeshPipelines& out) {
  if (traits_.pixel_light) return {};
  const OtherCode& code = other_code();
  shape.kind = PipelineKind::kModel;
  shape.frag = code.model_detail_frag;
  for (const bool pushed : {false, true}) {
    shape.vert = pushed ? code.model_detail_pushed_vert : code.model_detail_vert;
    const Result<void> made = make(making, shape, out.near_models[pushed ? 1 : 0]);
    if (!made) return made;
  }
  return {};
}

// The fragment shader of meshes whose light is per pixel.
ShaderCode Pipelines::lit_frag(bool terrain) const {
  const OtherCode& code = other_code();
  if (!terrain) return code.surface_lit_frag;
  return traits_.fine_grain ? code.ground_lit_near_frag : code.ground_lit_frag;
}

// Pipelines for models that cover only some of their pixels: that fade, or that have pictures.
// `shape` is that of the same models without either.
Result<void> Pipelines::create_fading(Making& making, PipelineShape shape, MeshLook look,
                                      MeshPipelines& out) {
  const OtherCode& code = other_code();
  shape.kind = PipelineKind::kModel;
  shape.frag = look == MeshLook::kLit      ? code.surface_lit_fading_frag
               : look == MeshLook::kShadow ? code.shadow_fading_frag
                                           : code.surface_fading_frag;
  for (const bool pushed : {false, true}) {
    shape.vert = fading_vertex_code(look, pushed);
    if (Result<void> made = make(making, shape, out.fading[pushed ? 1 : 0]); !made) return made;
  }
  shape.frag = look == MeshLook::kLit          ? code.surface_lit_picture_frag
               : look == MeshLook::kDrawColour ? code.surface_coloured_picture_frag
               : look == MeshLook::kShadow     ? code.shadow_picture_frag
                                               : code.surface_picture_frag;
  for (const bool pushed : {false, true}) {
    shape.vert = picture_vertex_code(look, pushed);
    if (Result<void> made = make(making, shape, out.pictured[pushed ? 1 : 0]); !made) return made;
  }
  return {};
}

Result<void> Pipelines::create_others(const Device& device, const Progress& progress) {
  Making making{device, progress};
  return create_landscape(making, false, landscape_, water_)
      .and_then([&] { return create_views(making); })
      .and_then([&]() -> Result<void> {
        if (traits_.cascades == 0) return {};
        PipelineShape shadow = usual_shape();
        shadow.shadow = true;
        return create_meshes(making, shadow, MeshLook::kShadow, shadow_).and_then([&] {
          return create_fading(making, shadow, MeshLook::kShadow, shadow_);
        });
      })
      .and_then([&] { return create_sky(making); });
}

// Pipelines for ground, models and water.
Result<void> Pipelines::create_landscape(Making& making, bool lamps, MeshPipelines& out,
                                         UniquePipeline& water_out) {
  const OtherCode& code = other_code();
  const bool lit = traits_.pixel_light;
  PipelineShape meshes = usual_shape();
  meshes.frag = lit ? code.surface_lit_frag : code.surface_frag;
  meshes.constants = {on(traits_.fine_grain), on(traits_.cascades > 0), on(lamps)};
  const MeshLook look = lit ? MeshLook::kLit : MeshLook::kColour;
  PipelineShape water = usual_shape();
  water.kind = PipelineKind::kWater;
  water.vert = lit ? code.water_lit_vert : code.water_vert;
  water.frag = !lit ? code.water_colour_frag : mirrors() ? code.water_mirror_frag : code.water_frag;
  water.constants = {on(traits_.waves), VK_FALSE, on(lamps)};
  return create_meshes(making, meshes, look, out)
      .and_then([&] { return create_near_ground(making, meshes, out); })
      .and_then([&] { return create_near_models(making, meshes, out); })
      .and_then([&] { return create_fading(making, meshes, look, out); })
      .and_then([&] { return make(making, water, water_out); });
}

Result<void> Pipelines::create_sky(Making& making) {
  const OtherCode& code = other_code();
  const bool dome = !traits_.pixel_light;
  PipelineShape shape = usual_shape();
  shape.kind = dome ? PipelineKind::kDome : PipelineKind::kSky;
  shape.vert = dome ? code.sky_dome_vert : code.sky_vert;
  shape.frag = dome ? code.sky_dome_frag : code.sky_frag;
  shape.constants = {VK_FALSE, on(traits_.fine_grain)};
  if (Result<void> made = make(making, shape, sky_); !made || !dome) return made;
  shape.vert = code.sky_below_vert;
  shape.frag = code.sky_frag;
  if (Result<void> made = make(making, shape, sky_below_); !made) return made;
  shape.kind = PipelineKind::kSun;
  shape.vert = code.sun_vert;
  shape.constants = {VK_TRUE, VK_FALSE};
  return make(making, shape, sun_);
}

// Pipelines for debugging views: draws in their debug colour, edges, lines.
Result<void> Pipelines::create_views(Making& making) {
  PipelineShape shape = usual_shape();
  shape.frag = other_code().surface_frag;
  return create_meshes(making, shape, MeshLook::kDrawColour, coloured_)
      .and_then([&] { return create_fading(making, shape, MeshLook::kDrawColour, coloured_); })
      .and_then([&] {
        PipelineShape lines = shape;
        lines.kind = PipelineKind::kLines;
        lines.vert = other_code().line_vert;
        return make(making, lines, lines_);
      })
      .and_then([&]() -> Result<void> {
        if (!making.device.info.wireframe) return {};
        shape.wireframe = true;
        return create_meshes(making, shape, MeshLook::kColour, wireframe_);
      });
}

VkPipeline Pipelines::mesh(core::VertexLayout layout, bool pushed, Coverage coverage, bool lamps,
                           View view) const {
  const bool edges = view == View::kWireframe && wireframe_.whole[0][0].get() != VK_NULL_HANDLE;
  const MeshPipelines& all = edges                 ? wireframe_
                             : colours_draws(view) ? coloured_
                             : lamps               ? lamplit_
                                                   : landscape_;
  return all.of(layout, pushed, edges ? Coverage::kWhole : coverage);
}

// The eight pipelines of a look. Those of kColour light textured objects per pixel.
Result<void> Pipelines::create_objects(Making& making, MeshLook look, bool wireframe, bool lamps,
                                       std::vector<UniquePipeline>& out) {
  const OtherCode& code = other_code();
  const bool views = wireframe || look == MeshLook::kDrawColour;
  for (std::size_t i = 0; i < 8; ++i) {
    const bool pushed = (i & 1U) != 0, textured = (i & 2U) != 0, fading = (i & 4U) != 0;
    out.emplace_back();
    if (textured && views) continue;
    PipelineShape shape = usual_shape();
    shape.kind = PipelineKind::kObject;
    shape.wireframe = wireframe;
    shape.shadow = look == MeshLook::kShadow;
    shape.constants = {VK_FALSE, on(traits_.cascades > 0), on(lamps)};
    const bool lit = look == MeshLook::kLit || (look == MeshLook::kColour && textured);
    if (shape.shadow) {
      shape.frag = !fading    ? ShaderCode{}
                   : textured ? code.object_shadow_frag
                              : code.shadow_fading_frag;
    } else if (lit) {
      shape.frag = textured
                       ? (fading ? code.object_textured_fading_frag : code.object_textured_frag)
                       : (fading ? code.object_fading_frag : code.object_frag);
    } else {
      shape.frag = fading ? code.surface_fading_frag : code.surface_frag;
    }
    shape.vert = object_vertex_code(lit ? MeshLook::kLit : look, pushed);
    if (Result<void> made = make(making, shape, out.back()); !made) return made;
  }
  return {};
}

Result<void> Pipelines::create_objects(const Device& device) {
  if (has_objects()) return {};
  const Progress nobody;
  Making making{device, nobody};
  ObjectPipelines made;
  const MeshLook look = traits_.pixel_light ? MeshLook::kLit : MeshLook::kColour;
  return create_objects(making, look, false, false, made.whole)
      .and_then([&] {
        return create_objects(making, MeshLook::kDrawColour, false, false, made.coloured);
      })
      .and_then([&]() -> Result<void> {
        if (!device.info.wireframe) return {};
        return create_objects(making, MeshLook::kColour, true, false, made.wireframe);
      })
      .and_then([&]() -> Result<void> {
        if (traits_.cascades == 0) return {};
        return create_objects(making, MeshLook::kShadow, false, false, made.shadow);
      })
      .and_then([&]() -> Result<void> {
        objects_ = std::move(made);
        return has_lamps() ? create_lamplit_objects(device) : Result<void>{};
      });
}

Result<void> Pipelines::create_lamplit_objects(const Device& device) {
  const Progress nobody;
  Making making{device, nobody};
  objects_.lamplit.clear();
  return create_objects(making, traits_.pixel_light ? MeshLook::kLit : MeshLook::kColour, false,
                        true, objects_.lamplit);
}

Result<void> Pipelines::create_lamps(const Device& device) {
  if (has_lamps()) return {};
  const Progress nobody;
  Making making{device, nobody};
  MeshPipelines made;
  UniquePipeline water;
  return create_landscape(making, true, made, water).and_then([&]() -> Result<void> {
    lamplit_ = std::move(made);
    if (has_objects()) {
      if (Result<void> objects = create_lamplit_objects(device); !objects) return objects;
    }
    lamplit_water_ = std::move(water);
    return {};
  });
}

Result<void> Pipelines::create_particles(const Device& device) {
  if (has_particles()) return {};
  const Progress nobody;
  Making making{device, nobody};
  PipelineShape shape = usual_shape();
  shape.kind = PipelineKind::kParticles;
  shape.vert = other_code().particle_vert;
  shape.constants[2] = VK_TRUE;
  shape.frag = other_code().particle_textured_frag;
  if (Result<void> made = make(making, shape, particles_[1]); !made) return made;
  shape.frag = other_code().particle_frag;
  return make(making, shape, particles_[0]);
}

VkPipeline Pipelines::object(bool pushed, bool textured, bool fading, bool lamps, View view) const {
  if (colours_draws(view)) return objects_.coloured[index_of_object(pushed, false, fading)].get();
  if (view == View::kWireframe && !objects_.wireframe.empty())
    return objects_.wireframe[index_of_object(pushed, false, false)].get();
  return (lamps ? objects_.lamplit : objects_.whole)[index_of_object(pushed, textured, fading)]
      .get();
}

}  // namespace psygen::render
