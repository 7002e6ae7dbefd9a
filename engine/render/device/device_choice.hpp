// Chooses a device from the list of all devices of a machine, as the user names it. Pure functions
// of plain values, any thread. Private to engine/render.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// The path and the preset that a device gets if the user chooses none.
RenderPath default_path(const DeviceInfo& device);
Preset default_preset(const DeviceInfo& device);

// The place in `devices` of the device that `wish` names: a whole number is a place, otherwise it
// is a UUID, a whole name, or a part of one, in any case. Empty: the usable device of the best
// type. Fails with kNoDevice for an unknown name, for one that fits several devices, and for a
// device that lacks something; the message then lists the devices.
core::Result<std::size_t> choose_device(std::span<const DeviceInfo> devices, std::string_view wish);

}  // namespace psygen::render
