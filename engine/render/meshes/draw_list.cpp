#include "engine/render/meshes/draw_list.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "engine/core/assert.hpp"
#include "engine/render/meshes/view_volume.hpp"

namespace psygen::render {

IndexList indices_of(const core::GeometryRange& range, std::uint32_t shared_indices,
                     core::IndexPart part, std::span<const IndexList> lists) {
  PSYGEN_ASSERT(shared_indices <= lists.size(), "unknown shared index list");
  const IndexList all = shared_indices == kNoSharedIndices
                            ? IndexList{range.first_index, range.index_count}
                            : lists[shared_indices - 1];
  if (part.count == 0) return all;
  PSYGEN_ASSERT(part.first + part.count <= all.index_count, "a part is in its list");
  return {all.first_index + part.first, part.count};
}

// Of one draw, without its place.
template <class Draw>
DrawRun DrawList::run_of(const Draw& draw) const {
  DrawRun run;
  run.layout = draw.range.layout;
  run.pushed = indices_of(draw, facts_.shared).index_count >= facts_.pushed_from;
  run.pool_block = draw.range.pool_block;
  run.lamps = !facts_.lights.empty() && any_reaches(facts_.lights, bounds_of(draw));
  if constexpr (requires { draw.material; }) {
    const MaterialKind kind = kind_of(facts_.materials, draw.material);
    run.coverage = coverage_of(draw, kind);
    run.textures = kind.textured ? draw.material : kPlainMaterial;
  } else {
    run.coverage = coverage_of(draw);
    run.shared = draw.shared_indices != kNoSharedIndices;
  }
  return run;
}

template <class Draw>
void DrawList::append(const Draw& draw) {
  const IndexList indices = indices_of(draw, facts_.shared);
  DrawRun run = run_of(draw);
  run.first = static_cast<std::uint32_t>(draws_.size());
  if (runs_.empty() || !run.continues(runs_.back())) runs_.push_back(run);
  ++runs_.back().count;
  draws_.push_back({indices.first_index, indices.index_count,
                    static_cast<std::int32_t>(draw.range.first_vertex)});
  data_.push_back(data_of(draw, facts_.coloured));
  triangle_count_ += indices.index_count / 3;
}

template <class Draw>
void DrawList::add(std::span<const Draw> input) {
  // The properties that separate runs, as a sort key.
  const auto key = [&](const Draw& draw) {
    const DrawRun run = run_of(draw);
    const bool terrain = std::is_same_v<Draw, TerrainDraw>;
    // Near draws come first: they hide most.
    const bool near = run.coverage == (terrain ? Coverage::kPart : Coverage::kNear);
    const std::uint64_t order = near ? 0 : 1 + static_cast<std::uint64_t>(run.coverage);
    return (run.lamps ? 0ULL : 1ULL) << 47 | std::uint64_t{run.textures} << 35 | order << 33 |
           (run.pushed ? 0ULL : 2ULL) << 31 | std::uint64_t{run.pool_block} * 2 |
           (run.shared ? 1u : 0u);
  };
  for (std::size_t first = 0; first < input.size(); first += kWindow) {
    const std::span<const Draw> window =
        input.subspan(first, std::min(kWindow, input.size() - first));
    order_.clear();
    for (std::size_t i = 0; i < window.size(); ++i)
      order_.push_back({key(window[i]), i});
    if (!std::is_sorted(order_.begin(), order_.end())) std::sort(order_.begin(), order_.end());
    for (const auto& [buffers, position] : order_)
      append(window[position]);
  }
}

void DrawList::build(const ListFacts& facts, std::span<const TerrainDraw> terrain,
                     std::span<const MeshDraw> models, std::span<const ObjectDraw> objects) {
  runs_.clear();
  draws_.clear();
  data_.clear();
  triangle_count_ = 0;
  facts_ = facts;
  add(terrain);
  add(models);
  add(objects);
  facts_ = {};
}

}  // namespace psygen::render
