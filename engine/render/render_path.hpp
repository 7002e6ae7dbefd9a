// Names of RenderPath, for options and reports. Pure, any thread. Knows no Vulkan.
#pragma once

#include <string_view>

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// The name of a path and its inverse, which fails with kInvalidArgument.
std::string_view to_string(RenderPath path);  // "auto", "cpu", "gpu"
core::Result<RenderPath> render_path_from(std::string_view name);

}  // namespace psygen::render
