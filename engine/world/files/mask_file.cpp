#include "engine/world/files/mask_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/handmade_file.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/ground_blends.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxMaskBytes = 200;  // of an image's name
constexpr Limits kMaskPlaces{-1e12, 1e12};  // metres

void read_grounds(TableReader& reader, ScatterMask& mask) {
  const Member* member = reader.find("on_ground");
  if (member == nullptr) return;
  const Node& node = member->value;
  std::uint32_t grounds = 0;
  bool sound = node.kind == Node::Kind::kArray && !node.items.empty();
  for (const Node& item : node.items) {
    const auto at = std::ranges::find(kGroundNames, item.text);
    sound = sound && item.kind == Node::Kind::kText && at != kGroundNames.end();
    if (sound) grounds |= 1U << (at - kGroundNames.begin());
  }
  if (sound)
    mask.ground = grounds;
  else
    reader.problem(node.line, "on_ground",
                   fmt::format("it must be a list of kinds of ground, [\"grass\", …]; allowed: {}",
                               fmt::join(kGroundNames, ", ")));
}

void read_area(TableReader& reader, const World& world, ScatterMask& mask) {
  const bool given = reader.read("mask_area_m", mask.area_m, kMaskPlaces);
  const Member* const area = reader.find("mask_area_m");
  const Member* const image = reader.find("mask_image");
  if (image == nullptr) {
    if (area != nullptr)
      reader.problem(area->line, "mask_area_m", "it is the area of mask_image, which is missing");
  } else if (area == nullptr && world.is_endless()) {
    reader.problem(image->line, "mask_image", "an endless world also needs mask_area_m");
  } else if (area == nullptr) {
    mask.area_m = {0, 0, static_cast<double>(world.blocks_x) * world.block_size_m(),
                   static_cast<double>(world.blocks_z) * world.block_size_m()};
  } else if (given && !(mask.area_m[0] < mask.area_m[2] && mask.area_m[1] < mask.area_m[3])) {
    reader.problem(area->line, "mask_area_m",
                   "it must be [x0, z0, x1, z1] with x0 below x1 and z0 below z1");
  }
}

}  // namespace

void read_mask(TableReader& reader, const World& world, const Beside& beside, ScatterMask& mask) {
  visit_mask(mask, [&reader](std::string_view key, auto& field, const FieldSpec& spec) {
    reader.read(key, field, {spec.low, spec.high});
  });
  read_grounds(reader, mask);
  const bool named = reader.read("mask_image", mask.image, kMaxMaskBytes);
  read_area(reader, world, mask);
  if (!named) return;
  if (!check_name_beside(reader, "mask_image", mask.image)) return;
  auto picture = beside.read_grey(mask.image);
  if (picture)
    mask.picture = std::move(*picture);
  else
    reader.problem(reader.find("mask_image")->line, "mask_image", picture.error().message,
                   picture.error().code);
}

void write_mask(const ScatterMask& mask, std::string& text) {
  const auto out = std::back_inserter(text);
  if (!mask.image.empty())
    fmt::format_to(out, "mask_image = {}\nmask_area_m = {}\n", toml_string(mask.image),
                   toml_vector(mask.area_m));
  const ScatterMask usual;
  if (mask.noise_m != usual.noise_m || mask.share != usual.share || mask.patches != usual.patches)
    visit_mask(mask, FieldWriter{text});
  if (mask.ground != 0) fmt::format_to(out, "on_ground = {}\n", toml_grounds(mask.ground));
}

std::string toml_grounds(std::uint32_t grounds) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kGroundNames.size(); ++i)
    if ((grounds >> i & 1U) != 0) names.push_back(toml_string(kGroundNames[i]));
  return fmt::format("[{}]", fmt::join(names, ", "));
}

}  // namespace psygen::world
