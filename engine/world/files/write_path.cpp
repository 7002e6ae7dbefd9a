// CameraPath → the text of a path file. Reading is in path_file.cpp.
#include <fmt/format.h>

#include <iterator>

#include "engine/world/files/path_file.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {

std::string write_camera_path(const CameraPath& path) {
  const CameraPath::Settings& settings = path.settings();
  std::string text =
      fmt::format("format = {}\n\n[path]\nname = {}\norigin_block = [{}, {}]\nsmoothing_s = {}\n",
                  kPathFormat, toml_string(settings.name), settings.origin_block.x,
                  settings.origin_block.z, toml_number(settings.smoothing_s));
  const auto to = std::back_inserter(text);
  for (const PathPoint& point : path.points()) {
    const double at_m[] = {point.at_m.x, point.at_m.y};
    fmt::format_to(to, "\n[[point]]\ntime_s = {}\nat_m = {}\nheight_m = {}\n",
                   toml_number(point.time_s), toml_vector(at_m), toml_number(point.height_m));
    if (point.heading_deg) {
      fmt::format_to(to, "heading_deg = {}\n", toml_number(*point.heading_deg));
    } else if (point.look_at_m) {
      const double target_m[] = {point.look_at_m->x, point.look_at_m->y};
      fmt::format_to(to, "look_at_m = {}\n", toml_vector(target_m));
    }
    if (point.pitch_deg != 0) fmt::format_to(to, "pitch_deg = {}\n", toml_number(point.pitch_deg));
    if (point.jump) fmt::format_to(to, "jump = true\n");
  }
  return text;
}

}  // namespace psygen::world
