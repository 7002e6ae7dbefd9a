#include "engine/render/meshes/mesh_tables.hpp"

#include <utility>

#include "engine/render/meshes/layouts.hpp"

namespace psygen::render {

using core::Result;

static_assert(static_cast<int>(core::VertexLayout::kObject) < 3);

Result<void> MeshTables::make(const PassSetup& setup, PipelineShape shape, bool pushed) {
  if (pushed) shape.vert = pushed_shader(shape.vert);
  UniquePipeline pipeline;
  return setup.pipelines.make(setup.sets.layout(), shape, pipeline).map([&] {
    pipelines_.push_back(std::move(pipeline));
  });
}

Result<void> MeshTables::create(const PassSetup& setup) {
  Features wanted = setup.features;
  wanted.add(made_);
  const std::size_t pipelines_before = pipelines_.size();
  const auto tables_before = tables_;
  Result<void> made = create_missing(setup, wanted);
  if (made) {
    made_ = wanted;
  } else {
    pipelines_.resize(pipelines_before);
    tables_ = tables_before;
  }
  return made;
}

Result<void> MeshTables::create_missing(const PassSetup& setup, Features wanted) {
  const auto is_new = [&](Feature f) { return wanted.has(f) && !made_.has(f); };
  const auto add_lit = [&](bool lamps) {
    return add_terrain_pipelines(setup, lamps, *this).and_then([&] {
      return add_model_pipelines(setup, lamps, *this);
    });
  };
  const bool new_lamps = is_new(Feature::kPointLights), new_objects = is_new(Feature::kObjects);
  Result<void> made;
  if (is_new(Feature::kLandscape)) {
    made = add_lit(false).and_then([&] { return add_terrain_views(setup, *this); }).and_then([&] {
      return add_model_views(setup, *this);
    });
  }
  if (made && new_lamps) made = add_lit(true);
  if (made && new_objects) {
    made = add_object_pipelines(setup, false, *this).and_then([&] {
      return add_object_views(setup, *this);
    });
  }
  // Objects and point lights together have pipelines of their own.
  const bool both = wanted.has(Feature::kObjects) && wanted.has(Feature::kPointLights);
  if (made && both && (new_objects || new_lamps)) made = add_object_pipelines(setup, true, *this);
  // Devices without wireframes show the landscape instead.
  for (std::size_t i = 0; i < tables_.size() && !setup.device.info.wireframe; ++i) {
    const auto layout = static_cast<core::VertexLayout>(i);
    table_of(layout, MeshUse::kWireframe) = table_of(layout, MeshUse::kLandscape);
  }
  return made;
}

}  // namespace psygen::render
