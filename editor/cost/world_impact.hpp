// The impact of a world's change on a cache: the number of meshes to rebuild, the time, and the
// memory used afterwards. Estimated from sample blocks of both worlds and the cost model, without
// synthesis. Pure; any thread, with its own parsed worlds and cost model.
#pragma once

#include <QString>
#include <cstdint>
#include <string>
#include <vector>

#include "editor/document/parsed_world.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::editor {

// The cached meshes of one model type.
struct HeldMeshes {
  enum class Kind : std::uint8_t { kGround, kModel, kDerived };
  std::string type;
  Kind kind = Kind::kModel;  // kDerived: types of the scene, such as merged vegetation
  std::uint64_t meshes = 0;
  double bytes = 0;
  double seconds = 0;  // predicted synthesis time of all of them on one core
};
struct CacheContents {
  std::vector<HeldMeshes> held;
  double budget_bytes = 0;
  unsigned modelers = 1;
};

struct WorldImpact {
  double held = 0, changed = 0;        // cached meshes, and those to rebuild
  double seconds = 0;                  // with all modelers in parallel
  double bytes = 0, budget_bytes = 0;  // used afterwards, and of the cache
  // The worlds differ, but not in the sample blocks: a road, a placed model, a spot of a mask.
  bool is_elsewhere = false;
};

// The impact of replacing `before`, of which the cache has `contents`, by `after`. The sample
// blocks are around a block. `learnt` as in block_cost(). Takes some milliseconds.
WorldImpact impact_of(const ParsedWorld& before, const ParsedWorld& after, core::BlockCoord around,
                      const CacheContents& contents, const synthesis::CostModel* learnt);

// Returns a text such as "Rebuilds about 3,412 of 8,120 meshes (0.7 s). Memory afterwards: …".
QString impact_text(const WorldImpact& impact);

}  // namespace psygen::editor
