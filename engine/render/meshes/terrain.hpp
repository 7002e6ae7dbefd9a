// The vertex layout of terrain: the data of its draws, their boxes and their pipelines. Private to
// engine/render.
#pragma once

#include "engine/core/coordinates.hpp"
#include "engine/render/meshes/mesh_tables.hpp"
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// The data of a draw for the shaders; `coloured`: with its debug colour, for the views that show
// it. Pure.
shaders::DrawData data_of(const TerrainDraw& draw, bool coloured = false);
constexpr Coverage coverage_of(const TerrainDraw& draw) {
  return draw.near ? Coverage::kPart : Coverage::kWhole;
}
// The box around all vertices as the shaders move them, with skirts, in metres from the camera.
core::Bounds bounds_of(const TerrainDraw& draw);

// Create the pipelines of the landscape, with or without point lights, and those of all other uses.
core::Result<void> add_terrain_pipelines(const PassSetup& setup, bool lamps, MeshTables& tables);
core::Result<void> add_terrain_views(const PassSetup& setup, MeshTables& tables);

}  // namespace psygen::render
