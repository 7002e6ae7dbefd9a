#include "engine/render/meshes/mesh_tables.hpp"

#include <utility>

#include "engine/render/meshes/models.hpp"
#include "engine/render/meshes/objects.hpp"
#include "engine/render/meshes/terrain.hpp"

namespace psygen::render {

using core::Result;

static_assert(static_cast<int>(core::VertexLayout::kObject) < 3);

Result<void> MeshTables::make(const PassSetup& setup, const PipelineShape& shape) {
  UniquePipeline pipeline;
  Result<void> made = setup.pipelines.make(setup.sets.layout(), shape, pipeline);
  if (made) pipelines_.push_back(std::move(pipeline));
  return made;
}

Result<void> MeshTables::create(const PassSetup& setup) {
  const auto add_lit = [&](bool lamps) {
    return add_terrain_pipelines(setup, lamps, *this).and_then([&] {
      return add_model_pipelines(setup, lamps, *this);
    });
  };
  const bool lamps = setup.features.has(Feature::kPointLights),
             new_lamps = lamps && !made_.has(Feature::kPointLights),
             objects = setup.features.has(Feature::kObjects),
             new_objects = objects && !made_.has(Feature::kObjects);
  Result<void> made;
  if (!made_.has(Feature::kLandscape)) {
    made = add_lit(false).and_then([&] { return add_terrain_views(setup, *this); }).and_then([&] {
      return add_model_views(setup, *this);
    });
    if (!made) return made;
    made_.add(Feature::kLandscape);
  }
  if (new_lamps) made = add_lit(true);
  if (made && new_objects) {
    made = add_object_pipelines(setup, false, *this).and_then([&] {
      return add_object_views(setup, *this);
    });
  }
  if (made && objects && lamps && (new_objects || new_lamps))
    made = add_object_pipelines(setup, true, *this);
  // Devices without wireframes show the landscape instead.
  for (std::size_t i = 0; i < tables_.size() && !setup.device.info.wireframe; ++i) {
    const auto layout = static_cast<core::VertexLayout>(i);
    table_of(layout, MeshUse::kWireframe) = table_of(layout, MeshUse::kLandscape);
  }
  if (made && new_lamps) made_.add(Feature::kPointLights);
  if (made && new_objects) made_.add(Feature::kObjects);
  return made;
}

}  // namespace psygen::render
