#include "engine/world/files/shaped_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/handmade_file.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxStampBytes = 200;  // of an image's name
constexpr Limits kShapePlaces{-kFarthestShapeM, kFarthestShapeM};

void read_stamp_picture(TableReader& reader, const Beside& beside, Stamp& stamp) {
  if (!reader.read("image", stamp.image, kMaxStampBytes, Presence::kRequired)) return;
  if (!check_name_beside(reader, "image", stamp.image)) return;
  const int line = reader.find("image")->line;
  auto picture = beside.read_grey(stamp.image);
  if (!picture) return reader.problem(line, "image", picture.error().message, picture.error().code);
  if ((*picture)->width < 2 || (*picture)->height < 2)
    return reader.problem(line, "image",
                          fmt::format("the image has {} x {} pixels; a stamp needs at least 2 x 2",
                                      (*picture)->width, (*picture)->height));
  stamp.picture = std::move(*picture);
}

Stamp read_stamp(const Node& node, std::size_t number, const Beside& beside, Problems& problems) {
  TableReader reader(node, fmt::format("stamp[{}]", number), node.line, problems);
  Stamp stamp;
  reader.read("centre_m", stamp.centre_m, kShapePlaces, Presence::kRequired);
  visit_stamp(stamp, [&reader](std::string_view key, auto& field, const FieldSpec& spec) {
    reader.read(key, field, {spec.low, spec.high});
  });
  if (reader.read("mode", stamp.mode, 16) &&
      std::ranges::find(kStampModes, stamp.mode) == kStampModes.end()) {
    reader.problem(reader.find("mode")->line, "mode",
                   fmt::format("it must be one of {}", fmt::join(kStampModes, ", ")));
  }
  if (const Member* border = reader.find("border_m");
      border != nullptr && stamp.border_m > stamp.size_m / 2)
    reader.problem(border->line, "border_m",
                   fmt::format("{:g} is not allowed: it must be at most half of size_m, {:g}",
                               stamp.border_m, stamp.size_m / 2));
  read_stamp_picture(reader, beside, stamp);
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

Road read_road(const Node& node, std::size_t number, Problems& problems) {
  TableReader reader(node, fmt::format("road[{}]", number), node.line, problems);
  Road road;
  read_points(reader, road.points_m);
  visit_road(road, [&reader](std::string_view key, auto& field, const FieldSpec& spec) {
    reader.read(key, field, {spec.low, spec.high});
  });
  reader.finish();
  return road;
}

}  // namespace

ShapedGround read_shaped(TableReader& root, const Beside& beside, Problems& problems) {
  ShapedGround shaped;
  for (const Node* node : root.tables("stamp", kMaxStamps))
    shaped.stamps.push_back(read_stamp(*node, shaped.stamps.size(), beside, problems));
  for (const Node* node : root.tables("road", kMaxRoads))
    shaped.roads.push_back(read_road(*node, shaped.roads.size(), problems));
  return shaped;
}

void shape_world(TableReader& root, World& world, Problems& problems) {
  auto shaped = shape_ground(world);
  if (shaped) return;
  const ShapeError& wrong = shaped.error();
  const Node& node = *root.tables(wrong.place, kMaxRoads)[wrong.number];
  int line = node.line;
  for (const Member& member : node.members)
    if (member.key == wrong.key) line = member.value.line;
  problems.add(line, fmt::format("{}[{}].{}", wrong.place, wrong.number, wrong.key),
               wrong.error.message, wrong.error.code);
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
