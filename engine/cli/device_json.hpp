// A device as JSON, for `psygen devices` and `psygen doctor`. Pure.
#pragma once

#include <nlohmann/json.hpp>

#include "engine/render/types.hpp"

namespace psygen::cli {

// The fields that are known of every device, with the path and the preset that it gets if the user
// chooses none.
nlohmann::ordered_json device_json(const render::DeviceInfo& device);

}  // namespace psygen::cli
