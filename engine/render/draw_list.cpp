#include "engine/render/draw_list.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/assert.hpp"

namespace psygen::render {

namespace {

shaders::DrawData data_of(const TerrainDraw& draw) {
  return {.origin = {draw.origin.x, draw.origin.y + draw.height_min_m, draw.origin.z, draw.cell_m},
          .scale = {draw.height_range_m, draw.skirt_m, draw.morph, 0.0F}};
}

shaders::DrawData data_of(const MeshDraw& draw) {
  const glm::vec3 center = draw.origin + draw.box_center * draw.fade;
  const glm::vec3 extent = draw.box_half_extent * draw.fade;
  // A phase that belongs to the mesh, not to the camera: its box is unlike its neighbour's.
  const float phase = 7.31F * (draw.box_half_extent.x + draw.box_center.x + draw.box_center.z);
  return {.origin = {center, phase - std::floor(phase)}, .scale = {extent, draw.fade}};
}

template <class Draw>
std::uint64_t buffers_of(const Draw& draw) {
  return std::uint64_t{draw.range.pool_block} * 2 +
         (draw.shared_indices != kNoSharedIndices ? 1u : 0u);
}

}  // namespace

template <class Draw>
void DrawList::append(const Draw& draw, std::span<const IndexList> lists) {
  const core::GeometryRange& range = draw.range;
  const bool shared = draw.shared_indices != kNoSharedIndices;
  PSYGEN_ASSERT(!shared || draw.shared_indices <= lists.size(), "unknown shared index list");
  const IndexList list =
      shared ? lists[draw.shared_indices - 1] : IndexList{range.first_index, range.index_count};
  if (runs_.empty() || runs_.back().layout != range.layout || runs_.back().shared != shared ||
      runs_.back().pool_block != range.pool_block) {
    runs_.push_back(
        {range.layout, shared, range.pool_block, static_cast<std::uint32_t>(draws_.size()), 0});
  }
  ++runs_.back().count;
  draws_.push_back(
      {list.first_index, list.index_count, static_cast<std::int32_t>(range.first_vertex)});
  data_.push_back(data_of(draw));
  triangle_count_ += list.index_count / 3;
}

template <class Draw>
void DrawList::add(std::span<const Draw> input, std::span<const IndexList> lists) {
  for (std::size_t first = 0; first < input.size(); first += kWindow) {
    const std::span<const Draw> window =
        input.subspan(first, std::min(kWindow, input.size() - first));
    order_.clear();
    for (std::size_t i = 0; i < window.size(); ++i)
      order_.push_back(buffers_of(window[i]) << 32 | i);
    if (!std::is_sorted(order_.begin(), order_.end())) std::sort(order_.begin(), order_.end());
    for (const std::uint64_t entry : order_)
      append(window[entry & UINT32_MAX], lists);
  }
}

void DrawList::build(std::span<const TerrainDraw> terrain, std::span<const MeshDraw> models,
                     std::span<const IndexList> lists) {
  runs_.clear();
  draws_.clear();
  data_.clear();
  triangle_count_ = 0;
  add(terrain, lists);
  add(models, lists);
}

}  // namespace psygen::render
