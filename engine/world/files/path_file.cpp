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

CameraPath::Settings read_settings(TableReader& root, Problems& problems) {
  CameraPath::Settings settings;
  const Member* member = root.table("path", Presence::kRequired);
  if (member == nullptr) return settings;
  TableReader reader(member->value, "path", member->line, problems);
  reader.read("name", settings.name, kMaxNameBytes, Presence::kRequired);
  std::int64_t block[2] = {0, 0};
  reader.read_pair("origin_block", block, {-0x1.0p31, 0x1.0p31 - 1});
  settings.origin_block = {static_cast<std::int32_t>(block[0]),
                           static_cast<std::int32_t>(block[1])};
  reader.read("smoothing_s", settings.smoothing_s, kSmoothing);
  reader.finish();
  return settings;
}

PathPoint read_point(const Node& node, std::size_t number, Problems& problems) {
  TableReader reader(node, fmt::format("point[{}]", number), node.line, problems);
  PathPoint point;
  reader.read("time_s", point.time_s, kTimes, Presence::kRequired);
  reader.read("at_m", point.at_m, kPlaces, Presence::kRequired);
  reader.read("height_m", point.height_m, kHeights, Presence::kRequired);
  double heading = 0;
  if (reader.read("heading_deg", heading, kHeadings)) point.heading_deg = heading;
  glm::dvec2 target{0.0};
  if (reader.read("look_at_m", target, kPlaces)) point.look_at_m = target;
  if (point.heading_deg && point.look_at_m)
    reader.problem(reader.find("look_at_m")->line, "look_at_m",
                   "a point may have heading_deg or look_at_m, not both");
  reader.read("pitch_deg", point.pitch_deg, kPitches);
  if (reader.read("jump", point.jump) && point.jump && number == 0)
    reader.problem(node.line, "jump", "the first point cannot be a jump");
  reader.finish();
  return point;
}

// Checks a point against the previous one.
void check_order(const PathPoint& before, const PathPoint& point, const Node& node,
                 std::size_t number, Problems& problems) {
  const double dt = point.time_s - before.time_s;
  if (!(dt > 0)) {
    problems.add(
        node.line, fmt::format("point[{}].time_s", number),
        fmt::format("{} is not after the previous point, which is at {}: times must ascend",
                    point.time_s, before.time_s));
  } else if (!point.jump && glm::distance(point.at_m, before.at_m) > kMaxSpeed_m_s * dt) {
    problems.add(node.line, fmt::format("point[{}].at_m", number),
                 fmt::format("it is {:.0f} m in {} s from the previous point; allowed: {} m/s, or "
                             "jump = true",
                             glm::distance(point.at_m, before.at_m), dt, kMaxSpeed_m_s));
  }
}

std::vector<PathPoint> read_points(TableReader& root, Problems& problems) {
  std::vector<PathPoint> points;
  for (const Node* node : root.tables("point", kMaxPoints)) {
    points.push_back(read_point(*node, points.size(), problems));
    const std::size_t last = points.size() - 1;
    if (last > 0) check_order(points[last - 1], points[last], *node, last, problems);
  }
  if (points.empty())
    problems.add(root.line(), "point", "a path needs at least one point, [[point]]");
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
  CameraPath::Settings settings = read_settings(root, problems);
  std::vector<PathPoint> points = read_points(root, problems);
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
