#include "engine/world/files/path_file.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <iterator>

#include "engine/world/camera_path.hpp"
#include "engine/world/files/document.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxPoints = 10'000;
constexpr std::size_t kMaxNameBytes = 128;
constexpr double kMaxSpeed_m_s = 2000;  // between two points
constexpr Limits kTimes{0, 1e6};
constexpr Limits kPlaces{-1e9, 1e9};
constexpr Limits kHeights{CameraPath::kMinHeightM, CameraPath::kMaxHeightM};
constexpr Limits kHeadings{-36'000, 36'000};
constexpr Limits kPitches{-89, 89};
constexpr Limits kSmoothing{0.1, 10};

CameraPath::Settings read_settings(TableReader& root) {
  CameraPath::Settings settings;
  std::optional<TableReader> reader = root.table("path", Presence::kRequired);
  if (!reader) return settings;
  reader->read("name", settings.name, kMaxNameBytes, Presence::kRequired);
  std::int64_t block[2] = {0, 0};
  reader->read_pair("origin_block", block, {-0x1.0p31, 0x1.0p31 - 1});
  settings.origin_block = {static_cast<std::int32_t>(block[0]),
                           static_cast<std::int32_t>(block[1])};
  reader->read("smoothing_s", settings.smoothing_s, kSmoothing);
  reader->finish();
  return settings;
}

PathPoint read_point(TableReader& reader, bool is_first) {
  PathPoint point;
  reader.read("time_s", point.time_s, kTimes, Presence::kRequired);
  reader.read("at_m", point.at_m, kPlaces, Presence::kRequired);
  reader.read("height_m", point.height_m, kHeights, Presence::kRequired);
  double heading = 0;
  if (reader.read("heading_deg", heading, kHeadings)) point.heading_deg = heading;
  glm::dvec2 target{0.0};
  if (reader.read("look_at_m", target, kPlaces)) point.look_at_m = target;
  if (point.heading_deg && point.look_at_m)
    reader.problem("look_at_m", "a point may have heading_deg or look_at_m, not both");
  reader.read("pitch_deg", point.pitch_deg, kPitches);
  if (reader.read("jump", point.jump) && point.jump && is_first)
    reader.problem(reader.line(), "jump", "the first point cannot be a jump");
  reader.finish();
  return point;
}

// Checks a point against the previous one.
void check_order(const PathPoint& before, const PathPoint& point, TableReader& reader) {
  const double dt = point.time_s - before.time_s;
  const double way_m = glm::distance(point.at_m, before.at_m);
  if (!(dt > 0))
    reader.problem(
        reader.line(), "time_s",
        fmt::format("{} is not after the previous point, which is at {}: times must ascend",
                    point.time_s, before.time_s));
  else if (!point.jump && way_m > kMaxSpeed_m_s * dt)
    reader.problem(reader.line(), "at_m",
                   fmt::format("it is {:.0f} m in {} s from the previous point; allowed: {} m/s, "
                               "or jump = true",
                               way_m, dt, kMaxSpeed_m_s));
}

// After a problem, others that it causes would hide it.
std::vector<PathPoint> read_points(TableReader& root) {
  std::vector<PathPoint> points;
  for (TableReader& reader : root.tables("point", kMaxPoints)) {
    const PathPoint point = read_point(reader, points.empty());
    if (!points.empty() && !reader.problems().any()) check_order(points.back(), point, reader);
    points.push_back(point);
  }
  if (points.empty() && !root.problems().any())
    root.problem(root.line(), "point", "a path needs at least one point, [[point]]");
  return points;
}

}  // namespace

core::Result<CameraPath> parse_camera_path(std::string_view text, std::string_view file_name) {
  const core::Result<Node> document = parse_document(text, file_name);
  if (!document) return tl::unexpected(document.error());
  Problems problems(file_name);
  TableReader root(*document, "", 1, problems);
  read_format(root, kPathFormat);
  // For another version, errors about other fields would be misleading.
  if (problems.any()) return tl::unexpected(problems.first());
  CameraPath::Settings settings = read_settings(root);
  std::vector<PathPoint> points = read_points(root);
  root.finish();
  if (problems.any()) return tl::unexpected(problems.first());
  return CameraPath(std::move(settings), std::move(points));
}

core::Result<CameraPath> load_camera_path(const std::filesystem::path& file) {
  const core::Result<std::string> text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_camera_path(*text, file.string());
}

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
