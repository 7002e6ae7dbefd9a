// Names of RenderPath, for options and reports.
#pragma once

#include <string_view>

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

std::string_view to_string(RenderPath path);  // "auto", "cpu", "gpu"
core::Result<RenderPath> render_path_from(std::string_view name);

}  // namespace psygen::render
