// The vertex layouts: the data of their draws, their boxes and their pipelines. Private to
// engine/render.
#pragma once

#include <glm/mat3x3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/render/meshes/mesh_tables.hpp"
#include "engine/render/textures/materials.hpp"
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// The data of a draw for the shaders; `coloured`: with its debug colour, for the views that show
// it. Pure.
shaders::DrawData data_of(const TerrainDraw& draw, bool coloured = false);
shaders::DrawData data_of(const MeshDraw& draw, bool coloured = false);
shaders::DrawData data_of(const ObjectDraw& draw, bool coloured = false);
constexpr Coverage coverage_of(const TerrainDraw& draw) {
  return draw.near ? Coverage::kPart : Coverage::kWhole;
}
constexpr Coverage coverage_of(const MeshDraw& draw) {
  return draw.pictured      ? Coverage::kPictured
         : draw.near        ? Coverage::kNear
         : draw.fade < 1.0F ? Coverage::kPart
                            : Coverage::kWhole;
}
inline Coverage coverage_of(const ObjectDraw& draw, MaterialKind kind) {
  return kind.holes || draw.fade < 1.0F ? Coverage::kPart : Coverage::kWhole;
}
// The box around all vertices as the shaders move them, with skirts and wind, in metres from the
// camera.
core::Bounds bounds_of(const TerrainDraw& draw);
core::Bounds bounds_of(const MeshDraw& draw);
core::Bounds bounds_of(const ObjectDraw& draw);
// The axes of an object's mesh in the world, each as long as its scale.
glm::mat3 object_axes(const ObjectDraw& draw);

// Create the pipelines of the landscape, with or without point lights.
core::Result<void> add_terrain_pipelines(const PassSetup& setup, bool lamps, MeshTables& tables);
core::Result<void> add_model_pipelines(const PassSetup& setup, bool lamps, MeshTables& tables);
core::Result<void> add_object_pipelines(const PassSetup& setup, bool lamps, MeshTables& tables);
// Create those of all other uses.
core::Result<void> add_terrain_views(const PassSetup& setup, MeshTables& tables);
core::Result<void> add_model_views(const PassSetup& setup, MeshTables& tables);
core::Result<void> add_object_views(const PassSetup& setup, MeshTables& tables);

}  // namespace psygen::render
