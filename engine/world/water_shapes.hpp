// Makes the edits of the ground that rivers and lakes are: beds that never rise downstream,
// surfaces, flow, banks and shores. The ground below decides how high the water lies. Deterministic
// on every machine. Pure functions; the world and its layers stay as they are.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/edits.hpp"
#include "engine/world/shaped_ground.hpp"
#include "engine/world/water_bodies.hpp"

namespace psygen::world {

struct World;

// The name of a body of water: its number in its world, and its name in messages ("river 2").
struct BodyName {
  std::uint32_t body = 0;
  std::string text;
  bool flows_on = false;  // a river that ends in another one, which may be made later
};

// The edits of one river or lake, without ids and not sealed; and sentences about it that name
// doubtful input.
struct WaterEdits {
  std::vector<models::GroundEdit> edits;
  std::vector<std::string> warnings;
};
// An error in one key of a river or lake.
struct WaterError {
  std::string_view key;
  core::Error error;
};
inline tl::unexpected<WaterError> water_error(
    std::string_view key, std::string sentence,
    core::ErrorCode code = core::ErrorCode::kInvalidArgument) {
  return tl::unexpected(WaterError{key, {code, std::move(sentence)}});
}

// Makes a river over the ground of `below`. It may begin and end in other rivers and in lakes of
// `below`, and pass through lakes. The surface lies below the lowest ground across the river, by
// 0.15 m and a tenth of the depth; it takes the running minimum downstream, and is smoothed. Linear
// in length times width. Fails with kInvalidArgument for a river outside the world, one that
// crosses itself or another one, and one that is narrower than two cells of the ground; with
// kOverBudget for one that is too long or too dense.
tl::expected<WaterEdits, WaterError> river_edits(const World& world, const models::EditLayer& below,
                                                 const River& river, const BodyName& name);

// Makes a lake over the ground of `below`. Fails with kInvalidArgument for an outline that crosses
// itself, another lake or the border of the world, and for a surface beyond the height range or
// below the sea; with kOverBudget for one wider than kMaxLakeM.
tl::expected<WaterEdits, WaterError> lake_edits(const World& world, const models::EditLayer& below,
                                                const Lake& lake, const BodyName& name);

// Fails for a value of a key outside of its range, or NaN.
tl::expected<void, WaterError> check_range(std::string_view key, double value, double least,
                                           double most);
// Fails for fewer points than `least`, or more than kMaxWaterPoints; for points that are not finite
// or too far away, and for those that are closer than kMinWaterStepM to the previous one.
tl::expected<void, WaterError> check_points(const std::vector<glm::dvec2>& points,
                                            std::size_t least);

}  // namespace psygen::world
