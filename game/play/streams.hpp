// The water that a listener hears: rivers and falls, by their discharge.
#pragma once

#include <optional>

#include "engine/query/world.hpp"

namespace cairns {

// A place of flowing water, and how loud it is: 0 … 1.
struct Stream {
  core::WorldPosition at;
  double gain = 0;
};

// Returns the loudest flowing water within 32 m of a listener, by discharge for each metre of
// width, foam and distance; nothing: no water flows there. Looks at 33 places, some microseconds.
std::optional<Stream> loudest_stream(query::World& query, const core::WorldPosition& listener);

}  // namespace cairns
