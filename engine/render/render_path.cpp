#include "engine/render/render_path.hpp"

#include <fmt/format.h>

namespace psygen::render {

std::string_view to_string(RenderPath path) {
  switch (path) {
    case RenderPath::kCpu:
      return "cpu";
    case RenderPath::kGpu:
      return "gpu";
    case RenderPath::kAuto:
      break;
  }
  return "auto";
}

core::Result<RenderPath> render_path_from(std::string_view name) {
  for (const RenderPath path : {RenderPath::kAuto, RenderPath::kCpu, RenderPath::kGpu}) {
    if (to_string(path) == name) return path;
  }
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("render path '{}' is unknown; allowed are auto, cpu, gpu", name));
}

}  // namespace psygen::render
