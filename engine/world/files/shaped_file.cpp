#include "engine/world/files/shaped_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/scatter_file.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr Limits kShapePlaces{-kFarthestShapeM, kFarthestShapeM};

Stamp read_stamp(TableReader& reader, const Beside& beside) {
  Stamp stamp;
  reader.read("centre_m", stamp.centre_m, kShapePlaces, Presence::kRequired);
  visit_stamp(stamp, FieldReader{reader});
  if (reader.read("mode", stamp.mode, 16) &&
      std::ranges::find(kStampModes, stamp.mode) == kStampModes.end())
    reader.problem("mode", fmt::format("it must be one of {}", fmt::join(kStampModes, ", ")));
  if (reader.find("border_m") != nullptr && stamp.border_m > stamp.size_m / 2)
    reader.problem("border_m",
                   fmt::format("{:g} is not allowed: it must be at most half of size_m, {:g}",
                               stamp.border_m, stamp.size_m / 2));
  auto picture = read_picture(reader, "image", beside, stamp.image, Presence::kRequired,
                              sizeof(models::Heightmap::heights_m[0]));
  if (picture && (picture->width < 2 || picture->height < 2))
    reader.problem("image",
                   fmt::format("the image has {} x {} pixels; a stamp needs at least 2 x 2",
                               picture->width, picture->height));
  stamp.picture = std::move(picture);
  reader.finish();
  return stamp;
}

// Points of two numbers each. Reports one problem a point.
void read_points(TableReader& reader, std::vector<glm::dvec2>& points) {
  const Member* member = reader.find("points_m", Presence::kRequired);
  if (member == nullptr) return;
  const Node& node = member->value;
  const auto refuse = [&](const Node& at, std::string_view sentence) {
    reader.problem(at.line, "points_m", sentence);
  };
  if (node.kind != Node::Kind::kArray || node.items.size() < 2 ||
      node.items.size() > kMaxRoadPoints)
    return refuse(node,
                  fmt::format("it must be 2 to {} points, [[x, z], [x, z], …]", kMaxRoadPoints));
  const auto usable = [](const Node& n) {
    const bool number = n.kind == Node::Kind::kReal || n.kind == Node::Kind::kInteger;
    return number && std::abs(n.real) <= kFarthestShapeM;  // false for NaN
  };
  for (const Node& item : node.items) {
    const bool pair = item.kind == Node::Kind::kArray && item.items.size() == 2 &&
                      usable(item.items[0]) && usable(item.items[1]);
    if (!pair)
      return refuse(item, fmt::format("point {} must be [x, z], each {:g} to {:g}", points.size(),
                                      -kFarthestShapeM, kFarthestShapeM));
    const glm::dvec2 point{item.items[0].real, item.items[1].real};
    if (!points.empty()) {
      const double x = point.x - points.back().x, z = point.y - points.back().y;
      if (x * x + z * z < kMinRoadStepM * kMinRoadStepM)
        return refuse(item, fmt::format("point {} must be at least {:g} m from the previous one",
                                        points.size(), kMinRoadStepM));
    }
    points.push_back(point);
  }
}

Road read_road(TableReader& reader) {
  Road road;
  read_points(reader, road.points_m);
  visit_road(road, FieldReader{reader});
  reader.finish();
  return road;
}

}  // namespace

ShapedGround read_shaped(TableReader& root, const Beside& beside) {
  ShapedGround shaped;
  for (TableReader& reader : root.tables("stamp", kMaxStamps))
    shaped.stamps.push_back(read_stamp(reader, beside));
  for (TableReader& reader : root.tables("road", kMaxRoads))
    shaped.roads.push_back(read_road(reader));
  return shaped;
}

void shape_world(TableReader& root, World& world) {
  const auto shaped = shape_ground(world);
  if (shaped) return;
  const ShapeError& wrong = shaped.error();
  root.tables(wrong.place, kMaxRoads)[wrong.number].problem(wrong.key, wrong.error.message,
                                                            wrong.error.code);
}

void write_shaped(const ShapedGround& shaped, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const Stamp& stamp : shaped.stamps) {
    fmt::format_to(out, "\n[[stamp]]\nimage = {}\ncentre_m = [{}, {}]\n", toml_string(stamp.image),
                   stamp.centre_m.x, stamp.centre_m.y);
    visit_stamp(stamp, FieldWriter{text});
    fmt::format_to(out, "mode = {}\n", toml_string(stamp.mode));
  }
  for (const Road& road : shaped.roads) {
    fmt::format_to(out, "\n[[road]]\npoints_m = {}\n", toml_points(road.points_m));
    visit_road(road, FieldWriter{text});
  }
}

std::string toml_points(const std::vector<glm::dvec2>& points) {
  std::vector<std::string> pairs;
  for (const glm::dvec2& point : points)
    pairs.push_back(fmt::format("[{}, {}]", point.x, point.y));
  return fmt::format("[{}]", fmt::join(pairs, ", "));
}

}  // namespace psygen::world
