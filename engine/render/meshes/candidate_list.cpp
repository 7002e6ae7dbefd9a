#include "engine/render/meshes/candidate_list.hpp"

#include <algorithm>
#include <bit>

#include "engine/render/meshes/view_volume.hpp"

namespace psygen::render {
namespace {

// Objects whose names differ by a multiple of it share a bit.
constexpr std::uint32_t kMaxNames = 1 << 20;

}  // namespace

std::uint32_t CandidateList::group_for(const core::GeometryRange& range, bool shared,
                                       Coverage coverage) {
  const std::size_t key =
      std::size_t{range.pool_block} << 4 | static_cast<std::size_t>(coverage) << 2 |
      (shared ? 2u : 0u) |
      static_cast<std::size_t>(range.layout == core::VertexLayout::kTerrain ? 1 : 0);
  if (key >= open_.size()) open_.resize(key + 1);
  if (open_[key] == 0 || groups_[open_[key] - 1].capacity == kGroupCapacity) {
    groups_.push_back({.layout = range.layout,
                       .shared = shared,
                       .coverage = coverage,
                       .pool_block = range.pool_block});
    open_[key] = static_cast<std::uint32_t>(groups_.size());
  }
  ++groups_[open_[key] - 1].capacity;
  return open_[key] - 1;
}

template <class Draw>
void CandidateList::add(const Draw& draw, std::uint32_t group, std::uint32_t name) {
  const core::Bounds box = bounds_of(draw);
  const IndexList indices = indices_of(draw, facts_.shared);
  name_count_ = std::max(name_count_, name + 1);
  candidates_.push_back({{box.min, 0.0F},
                         {box.max, 0.0F},
                         data_of(draw, facts_.coloured),
                         {indices.first_index, indices.index_count, draw.range.first_vertex, group},
                         {name, 0, 0, 0}});
}

template <class Draw>
void CandidateList::add_meshes(std::span<const Draw> draws) {
  for (const Draw& draw : draws) {
    const bool shared = draw.shared_indices != kNoSharedIndices;
    // Meshes without an id share bit 0.
    const std::uint32_t name = draw.range.id == core::kNoGeometry ? 0 : draw.range.id + 1;
    add(draw, group_for(draw.range, shared, coverage_of(draw)), name);
  }
}

void CandidateList::build(const ListFacts& facts, std::span<const TerrainDraw> terrain,
                          std::span<const MeshDraw> models, std::span<const ObjectDraw> objects) {
  candidates_.clear();
  groups_.clear();
  std::fill(open_.begin(), open_.end(), 0u);
  open_objects_.clear();
  name_count_ = 1;
  facts_ = facts;
  add_meshes(terrain);
  add_meshes(models);
  // Objects come above the bits of other meshes. Their number may change from frame to frame. Then
  // a bit names another object for a frame, which costs a test and leaves nothing out
  // (gpu_culling.hpp).
  const std::uint32_t first_name = std::bit_ceil(name_count_);
  for (const ObjectDraw& draw : objects)
    add(draw, group_for(draw, kind_of(facts_.materials, draw.material)),
        first_name + draw.name % kMaxNames);
  facts_ = {};
  place_groups();
}

void CandidateList::place_groups() {
  first_commands_.clear();
  std::uint32_t first = 0;
  for (DrawGroup& group : groups_) {
    group.first_command = first;
    first_commands_.push_back(first);
    first += group.capacity;
  }
}

std::uint32_t CandidateList::group_for(const ObjectDraw& draw, MaterialKind kind) {
  const Coverage coverage = coverage_of(draw, kind);
  const MaterialId textures = kind.textured ? draw.material : kPlainMaterial;
  const auto fits = [&](const DrawGroup& group) {
    return group.layout == core::VertexLayout::kObject && group.coverage == coverage &&
           group.pool_block == draw.range.pool_block && group.textures == textures &&
           group.capacity < kGroupCapacity;
  };
  // Neighbours in the list usually look alike.
  if (!candidates_.empty() && fits(groups_[candidates_.back().draw.w])) {
    ++groups_[candidates_.back().draw.w].capacity;
    return candidates_.back().draw.w;
  }
  const std::uint64_t key = std::uint64_t{textures} << 33 |
                            std::uint64_t{draw.range.pool_block} << 1 |
                            static_cast<std::uint64_t>(coverage);
  const auto [open, is_new] = open_objects_.try_emplace(key, 0u);
  if (is_new || !fits(groups_[open->second])) {
    open->second = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back({.layout = core::VertexLayout::kObject,
                       .coverage = coverage,
                       .pool_block = draw.range.pool_block,
                       .textures = textures});
  }
  ++groups_[open->second].capacity;
  return open->second;
}

}  // namespace psygen::render
