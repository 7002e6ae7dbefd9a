#include "engine/world/files/shaped_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/model_fields.hpp"
#include "engine/world/files/scatter_file.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr Limits kShapePlaces{-kFarthestShapeM, kFarthestShapeM};

// One number for both sides, or [x, z].
void read_size(TableReader& reader, glm::dvec2& size_m) {
  const Member* member = reader.find("size_m");
  const Limits limits{kStampSize.hard.min, kStampSize.hard.max};
  if (member != nullptr && member->value.kind == Node::Kind::kArray) {
    reader.read("size_m", size_m, limits);
  } else if (double side_m = 0; reader.read("size_m", side_m, limits)) {
    size_m = glm::dvec2(side_m);
  }
}

// Reads the name of one of some choices.
template <std::size_t n>
void read_choice(TableReader& reader, std::string_view key, std::string& value,
                 const std::array<std::string_view, n>& choices) {
  if (reader.read(key, value, 16) && std::ranges::find(choices, value) == choices.end())
    reader.problem(key, fmt::format("it must be one of {}", fmt::join(choices, ", ")));
}

// The reason why the image of a stamp cannot be its heights; empty: it can.
std::string wrong_numbers(const Stamp& stamp) {
  constexpr double kRounding = 1e-3;  // of black and white
  const HeightPicture& picture = *stamp.picture;
  if (picture.width < 2 || picture.height < 2)
    return fmt::format("the image has {} x {} pixels; a stamp needs at least 2 x 2", picture.width,
                       picture.height);
  if (stamp.is_in_metres() && picture.is_coloured)
    return "the image has colours; heights in metres need one grey channel";
  const auto [least, largest] = numbers_of(stamp);
  if (!(least <= largest)) return "no pixel of the image has a height";
  const double white = picture.white;
  if (stamp.unit != kStampUnits[0] ||
      (double{least} >= -kRounding * white && double{largest} <= (1 + kRounding) * white))
    return {};
  return fmt::format(
      "the numbers of the image are {:.7g} to {:.7g}, but grey is 0 (black) to {:g} (white); write "
      "unit = \"m\" if they are heights in metres, and no_data for a number that marks pixels "
      "without height",
      least, largest, white);
}

// Writes the switch of a shape that is off.
template <class Shape>
void write_switch(const Shape& shape, std::string& text) {
  if (!shape.enabled) text += "enabled = false\n";
}

// The strength and the switch of a stamp or a road.
template <class Shape>
void read_layer(TableReader& reader, Shape& shape) {
  visit_strength(shape, FieldReader{reader});
  reader.read("enabled", shape.enabled);
}
template <class Shape>
void write_layer(const Shape& shape, std::string& text) {
  write_changed(shape, Shape{}, visit_strength, text);
  write_switch(shape, text);
}

Stamp read_stamp(TableReader& reader, const Beside& beside) {
  Stamp stamp;
  reader.read("centre_m", stamp.centre_m, kShapePlaces, Presence::kRequired);
  visit_stamp(stamp, FieldReader{reader});
  read_size(reader, stamp.size_m);
  reader.read("no_data", stamp.no_data, {kNoData.hard.min, kNoData.hard.max});
  read_choice(reader, "mode", stamp.mode, kStampModes);
  read_choice(reader, "unit", stamp.unit, kStampUnits);
  read_layer(reader, stamp);
  read_mask(reader, beside, stamp.mask);
  visit_ranges(stamp, FieldReader{reader});
  if (stamp.min_height_m > stamp.max_height_m)
    reader.problem("min_height_m", "it must not be above max_height_m");
  if (stamp.min_slope_deg > stamp.max_slope_deg)
    reader.problem("min_slope_deg", "it must not be above max_slope_deg");
  const double max_m = std::min(stamp.size_m.x, stamp.size_m.y) / 2;
  if (reader.find("border_m") == nullptr)
    stamp.border_m = std::min(stamp.border_m, max_m);
  else if (stamp.border_m > max_m)
    reader.problem("border_m",
                   fmt::format("{:g} is not allowed: it must be at most half of size_m, {:g}",
                               stamp.border_m, max_m));
  if (read_name_beside(reader, "image", stamp.image, Presence::kRequired)) {
    auto picture = beside.read_heights(stamp.image);
    if (picture) {
      stamp.picture = *std::move(picture);
      if (const std::string wrong = wrong_numbers(stamp); !wrong.empty())
        reader.problem("image", wrong);
    } else {
      reader.problem("image", picture.error().message, picture.error().code);
    }
  }
  reader.finish();
  return stamp;
}

// The smallest and the largest number of points of a curve.
struct PointCount {
  std::size_t least = 2, most = kMaxRoadPoints;
};

// True for a number. Its value may be NaN.
bool is_a_number(const Node& n) {
  return n.kind == Node::Kind::kReal || n.kind == Node::Kind::kInteger;
}

// Points of two numbers each. Reports one problem a point. Returns true without problems.
bool read_points(TableReader& reader, std::vector<glm::dvec2>& points, PointCount count = {},
                 Presence presence = Presence::kRequired) {
  const Member* member = reader.find("points_m", presence);
  if (member == nullptr) return false;
  const Node& node = member->value;
  const auto refuse = [&](const Node& at, std::string_view sentence) {
    reader.problem(at.line, "points_m", sentence);
    return false;
  };
  if (node.kind != Node::Kind::kArray || node.items.size() < count.least ||
      node.items.size() > count.most)
    return refuse(node, fmt::format("it must be {} to {} points, [[x, z], [x, z], …]", count.least,
                                    count.most));
  const auto usable = [](const Node& n) {
    return is_a_number(n) && std::abs(n.real) <= kFarthestShapeM;  // false for NaN
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
  return true;
}

// One number, or as many numbers as there are points.
void read_numbers(TableReader& reader, std::string_view key, std::vector<double>& numbers,
                  const FieldSpec& spec, std::size_t points) {
  const Member* member = reader.find(key);
  if (member == nullptr) return;
  const Limits limits{spec.hard.min, spec.hard.max};
  if (member->value.kind != Node::Kind::kArray) {
    double number = 0;
    if (reader.read(key, number, limits)) numbers = {number};
    return;
  }
  const std::vector<Node>& items = member->value.items;
  if (items.size() != points)
    return reader.problem(key, fmt::format("it must be one number, or one for each of the {} "
                                           "points, not {} numbers",
                                           points, items.size()));
  numbers.clear();
  for (const Node& item : items) {
    if (!is_a_number(item) || !(item.real >= limits.low && item.real <= limits.high))
      return reader.problem(
          item.line, key,
          fmt::format("number {} must be {:g} to {:g}", numbers.size(), limits.low, limits.high));
    numbers.push_back(item.real);
  }
}

River read_river(TableReader& reader) {
  River river;
  read_points(reader, river.points_m, {2, kMaxWaterPoints});
  visit_river_lists(river, [&](std::string_view key, auto& numbers, const FieldSpec& spec) {
    read_numbers(reader, key, numbers, spec, river.points_m.size());
  });
  visit_river(river, FieldReader{reader});
  reader.read("enabled", river.enabled);
  reader.finish();
  return river;
}

Lake read_lake(TableReader& reader) {
  Lake lake;
  const bool has_circle = reader.find("centre_m") != nullptr || reader.find("radius_m") != nullptr;
  if (has_circle) {
    reader.read("centre_m", lake.centre_m, kShapePlaces, Presence::kRequired);
    reader.read("radius_m", lake.radius_m, {kLakeRadius.hard.min, kLakeRadius.hard.max},
                Presence::kRequired);
    if (reader.find("points_m") != nullptr)
      reader.problem("points_m", "a lake has an outline or a circle, not both");
  } else if (read_points(reader, lake.points_m, {3, kMaxWaterPoints})) {
    const glm::dvec2 last = lake.points_m.back() - lake.points_m.front();
    if (last.x * last.x + last.y * last.y < kMinWaterStepM * kMinWaterStepM)
      reader.problem("points_m", fmt::format("the last point must be at least {:g} m from the "
                                             "first one, because the outline closes by itself",
                                             kMinWaterStepM));
  }
  if (double spill_m = 0; reader.read("spill_m", spill_m, {kSpill.hard.min, kSpill.hard.max}))
    lake.spill_m = spill_m;
  visit_lake(lake, FieldReader{reader});
  reader.read("enabled", lake.enabled);
  reader.finish();
  return lake;
}

Road read_road(TableReader& reader) {
  Road road;
  read_points(reader, road.points_m);
  visit_road(road, FieldReader{reader});
  read_layer(reader, road);
  reader.finish();
  return road;
}

}  // namespace

ShapedGround read_shaped(TableReader& root, const Beside& beside) {
  ShapedGround shaped;
  if (std::optional<TableReader> reader = root.table("erosion")) {
    models::Erosion& erosion = shaped.erosion;
    models::visit_erosion(erosion, FieldReader{*reader});
    if (erosion.min_height_m > erosion.max_height_m)
      reader->problem(reader->line(), "min_height_m", "it must not be above max_height_m");
    reader->finish();
  }
  if (std::optional<TableReader> reader = root.table("rivers")) {
    visit_rivers(shaped.network.emplace(), FieldReader{*reader});
    reader->finish();
  }
  for (TableReader& reader : root.tables("stamp", kMaxStamps))
    shaped.stamps.push_back(read_stamp(reader, beside));
  for (TableReader& reader : root.tables("road", kMaxRoads))
    shaped.roads.push_back(read_road(reader));
  for (TableReader& reader : root.tables("lake", kMaxLakes))
    shaped.lakes.push_back(read_lake(reader));
  for (TableReader& reader : root.tables("river", kMaxRivers))
    shaped.rivers.push_back(read_river(reader));
  return shaped;
}

void shape_world(TableReader& root, World& world) {
  const auto shaped = shape_ground(world);
  if (shaped) return;
  const ShapeError& wrong = shaped.error();
  if (wrong.place == "rivers") {
    if (std::optional<TableReader> reader = root.table(wrong.place))
      reader->problem(reader->line(), wrong.key, wrong.error.message);
    return;
  }
  root.tables(wrong.place, kMaxRoads)[wrong.number].problem(wrong.key, wrong.error.message,
                                                            wrong.error.code);
}

void write_shaped(const ShapedGround& shaped, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const Stamp& stamp : shaped.stamps) {
    fmt::format_to(out, "\n[[stamp]]\nimage = {}\ncentre_m = [{}, {}]\n", toml_string(stamp.image),
                   stamp.centre_m.x, stamp.centre_m.y);
    fmt::format_to(out, "size_m = {}\n", toml_range(stamp.size_m.x, stamp.size_m.y));
    visit_stamp(stamp, FieldWriter{text});
    fmt::format_to(out, "mode = {}\nunit = {}\n", toml_string(stamp.mode), toml_string(stamp.unit));
    if (std::isfinite(stamp.no_data))
      fmt::format_to(out, "no_data = {}\n", toml_number(stamp.no_data));
    write_layer(stamp, text);
    write_mask(stamp.mask, text);
    write_changed(stamp, Stamp{}, visit_ranges, text);
  }
  for (const Road& road : shaped.roads) {
    fmt::format_to(out, "\n[[road]]\npoints_m = {}\n", toml_points(road.points_m));
    visit_road(road, FieldWriter{text});
    write_layer(road, text);
  }
  for (const Lake& lake : shaped.lakes) {
    text += "\n[[lake]]\n";
    if (lake.points_m.empty())
      fmt::format_to(out, "centre_m = [{}, {}]\nradius_m = {}\n", lake.centre_m.x, lake.centre_m.y,
                     toml_number(lake.radius_m));
    else
      fmt::format_to(out, "points_m = {}\n", toml_points(lake.points_m));
    if (lake.spill_m) fmt::format_to(out, "spill_m = {}\n", toml_number(*lake.spill_m));
    visit_lake(lake, FieldWriter{text});
    write_switch(lake, text);
  }
  for (const River& river : shaped.rivers) {
    fmt::format_to(out, "\n[[river]]\npoints_m = {}\n", toml_points(river.points_m));
    visit_river_lists(river, [&](std::string_view key, const auto& numbers, const FieldSpec&) {
      if (!numbers.empty()) fmt::format_to(out, "{} = {}\n", key, toml_numbers(numbers));
    });
    visit_river(river, FieldWriter{text});
    write_switch(river, text);
  }
}

std::string toml_numbers(const std::vector<double>& numbers) {
  if (numbers.size() == 1) return toml_number(numbers.front());
  std::vector<std::string> all;
  for (const double number : numbers)
    all.push_back(toml_number(number));
  return fmt::format("[{}]", fmt::join(all, ", "));
}

std::string toml_points(const std::vector<glm::dvec2>& points) {
  std::vector<std::string> pairs;
  for (const glm::dvec2& point : points)
    pairs.push_back(fmt::format("[{}, {}]", point.x, point.y));
  return fmt::format("[{}]", fmt::join(pairs, ", "));
}

}  // namespace psygen::world
