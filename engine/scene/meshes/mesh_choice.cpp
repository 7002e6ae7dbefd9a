#include "engine/scene/meshes/mesh_choice.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {
namespace {

using synthesis::Rank;
using synthesis::RankGroup;

// Time for which a hole waits for its request.
constexpr double kHolePatienceSeconds = 0.02;
// An impostor stays up to this multiple of kMaxPicturePixels.
constexpr float kKept = 1.1F;

// The allowed error of an individual model at this distance. For near trees it falls towards
// ChoiceRules::near_leaves_m, just so that no tree gets coarser as the camera approaches.
float model_error_pixels(const ChoiceRules& rules, const LodErrors& detail, float distance_m) {
  if (!detail.leaves || distance_m >= rules.near_leaves_m) return rules.model_error_pixels;
  return rules.model_error_pixels *
         std::min(rules.near_leaves_m / std::max(distance_m, 1e-3F), kNearLeaves);
}

// Returns the LOD that is coarser than the wanted one by this many levels; an impostor only if that
// is wanted.
int coarser_level(const LodErrors& detail, std::uint8_t wanted_level, int by) {
  const int levels = static_cast<int>(detail.level_count);
  const int coarsest = detail.picture_level == levels - 1 ? levels - 2 : levels - 1;
  return std::max(std::min(wanted_level + by, coarsest), int{wanted_level});
}

// The LOD that a draft shows in place of the wanted one.
int draft_level(const LodErrors& detail, std::uint8_t wanted_level) {
  return coarser_level(detail, wanted_level, kDraftLevels);
}

// True if the drawn mesh is fine enough for a draft.
bool is_drafted(const ChoiceRules& rules, const LodErrors& detail, const MeshDemand& demand) {
  return rules.draft && !demand.stale && demand.drawn_level != kNoLevel &&
         demand.drawn_level >= demand.wanted_level &&
         int{demand.drawn_level} <= draft_level(detail, demand.wanted_level);
}

// Returns the LOD to request: the wanted one; the coarsest one for a hole in view whose wanted LOD
// is not cached; or the nearest one that can be synthesised. kNoLevel if none is better than the
// drawn one.
std::uint8_t level_to_request(const ChoiceRules& rules, const LodErrors& detail,
                              const MeshDemand& demand, bool uncached_hole) {
  const auto levels = static_cast<int>(detail.level_count);
  const bool coarse_first = uncached_hole && rules.coarse_first;
  // The modeler of the coarsest level may get no processor for a while. Then the next level is
  // requested, unless the request waits for memory.
  const bool stuck = !rules.settle && !rules.short_of_memory && !rules.awaits_memory &&
                     demand.seen_s >= 0 &&
                     rules.real_s - double{demand.seen_s} > kHolePatienceSeconds;
  const int coarsest = stuck && levels > 1 ? levels - 2 : levels - 1;
  const bool draft = rules.draft && demand.drawn_level != kNoLevel &&
                     (demand.stale || demand.drawn_level > demand.wanted_level);
  const int wanted = draft ? draft_level(detail, demand.wanted_level) : demand.wanted_level;
  const int first = coarse_first ? coarsest : wanted;
  for (int distance = 0; distance < levels; ++distance) {
    for (const int level : {first + distance, first - distance}) {
      if (level < 0 || level >= levels || (demand.failed_levels >> level & 1) != 0) continue;
      const bool there = level == demand.drawn_level && !demand.stale;
      return there ? kNoLevel : static_cast<std::uint8_t>(level);
    }
  }
  return kNoLevel;
}

}  // namespace

ChoiceRules choice_of_picture(const StreamingContext& context) {
  const SceneSettings& settings = context.frame.settings;
  ChoiceRules rules;
  rules.pixels_per_radian = context.camera.pixels_per_radian;
  rules.min_size_pixels = static_cast<float>(settings.min_size_pixels);
  rules.error_pixels = static_cast<float>(context.quality.error_pixels);
  rules.model_error_pixels = static_cast<float>(context.quality.model_error_pixels);
  rules.levels_of_detail = settings.levels_of_detail;
  // Gaps between leaves are whole up to half of that distance (shaders/model.vert).
  rules.near_leaves_m = context.facts.near_detail ? 0.5F * render::kNearModelsM : 0.0F;
  return rules;
}

std::uint8_t ground_level(const NodeView& node, const LodErrors& detail, std::uint8_t drawn_level) {
  if (node.fine) return 0;
  if (!node.wanted && drawn_level != kNoLevel) return drawn_level;
  return static_cast<std::uint8_t>(detail.level_count - 1);
}

std::uint8_t model_level(const ChoiceRules& rules, const NodeView& node, const LodErrors& detail,
                         float size_pixels, float distance_m, std::uint8_t drawn_level) {
  if (node.level == 0 && size_pixels < rules.min_size_pixels) return kNoLevel;
  if (!rules.levels_of_detail) return 0;
  const std::span<const float> errors(detail.error_m.data(), detail.level_count);
  const bool keep = drawn_level != kNoLevel && !rules.settle;
  const auto level_with = [&](float error_pixels) {
    return static_cast<std::uint8_t>(
        visibility::choose_level(errors, distance_m, rules.pixels_per_radian,
                                 node.error_factor * error_pixels, keep ? drawn_level : -1));
  };
  if (node.level > 0) return level_with(rules.error_pixels);
  const std::uint8_t level = level_with(model_error_pixels(rules, detail, distance_m));
  if (level != detail.picture_level || level == 0) return level;
  // Impostors have no gaps that could hide a larger error.
  const float most = kMaxPicturePixels * (keep && drawn_level == level ? kKept : 1.0F);
  const bool fits = size_pixels <= most && level_with(rules.model_error_pixels) == level;
  return fits ? level : static_cast<std::uint8_t>(level - 1);
}

std::uint8_t level_out_of_view(const LodErrors& detail, std::uint8_t level, bool expected,
                               std::uint8_t drawn_level) {
  if (level == kNoLevel) return level;
  const auto enough =
      static_cast<std::uint8_t>(expected ? int{level} : coarser_level(detail, level, 1));
  return drawn_level != kNoLevel && drawn_level <= enough ? drawn_level : enough;
}

bool is_hole(const NodeView& node, const MeshDemand& demand, bool in_view) {
  return demand.drawn_level == kNoLevel && in_view && !node.covered;
}

MeshChoice choose_mesh(const ChoiceRules& rules, const NodeView& node, const LodErrors& detail,
                       const MeshDemand& demand, const MeshUse& use) {
  const bool wanted = use.in_view || (node.wanted && !node.in_view);
  const bool nothing = demand.drawn_level == kNoLevel;
  const bool hole = is_hole(node, demand, use.in_view);
  MeshChoice choice;
  choice.there = demand.drawn_level == demand.wanted_level && !demand.stale;
  if (!choice.there && !is_drafted(rules, detail, demand))
    choice.request = level_to_request(rules, detail, demand, hole && !use.cached);
  const bool too_fine = !use.is_ground && !nothing && choice.request != kNoLevel &&
                        choice.request > demand.drawn_level;
  const RankGroup drawn = too_fine ? RankGroup::kVisibleFine : RankGroup::kDrawn;
  choice.drawn = wanted ? drawn : RankGroup::kPrefetch;
  if (hole) {
    choice.requested = RankGroup::kVisibleHole;
  } else if (wanted && choice.request == demand.drawn_level && !rules.draft) {
    // New light on ground waits for missing detail: a fast sun changes the light of all ground.
    choice.requested = RankGroup::kDrawn;
  } else if (wanted) {  // evictions are urgent only while memory is short
    choice.requested =
        too_fine && rules.short_of_memory ? RankGroup::kVisibleFine : RankGroup::kVisibleCoarse;
  }
  // The coarsest nodes are few, and each fills much of the frame.
  choice.at_once = hole && use.is_ground && node.level + std::size_t{1} == rules.node_levels;
  return choice;
}

Rank rank_on(const NodeView& node, RankGroup group, float distance_m) {
  const Visibility& visibility = node.visibility;
  if (group == RankGroup::kUnwanted) return Rank::unwanted();
  // Coarse nodes fill holes first: they cover most with least.
  if (group == RankGroup::kVisibleHole)
    return Rank::hole(visibility::kMaxNodeLevel - node.level, visibility.layer, distance_m);
  if (synthesis::is_visible(group)) return Rank::by_layer(group, visibility.layer, distance_m);
  if (std::isfinite(visibility.deadline_s))
    return Rank::by_deadline(visibility.deadline_s, distance_m);
  return Rank::by_layer(RankGroup::kPrefetch, visibility.layer, distance_m);
}

}  // namespace psygen::scene
