#include "engine/world/files/world_schema.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <utility>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/model_fields.hpp"
#include "engine/world/files/scatter_file.hpp"
#include "engine/world/files/shaped_file.hpp"
#include "engine/world/files/species_file.hpp"
#include "engine/world/files/text_layout.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

// Field values of all types: their TOML text, their numbers and their kind.
struct FieldValue {
  FieldKind kind;
  std::string toml;
  std::vector<double> numbers;
  std::string plain = {};
  ColourEncoding encoding = ColourEncoding::kLinear;
};
FieldValue value_of(double v) {
  if (!std::isfinite(v)) return {FieldKind::kReal, "", {}};  // a limit that is not set
  return {FieldKind::kReal, toml_number(v), {v}};
}
FieldValue value_of(std::int64_t v) {
  return {FieldKind::kInteger, toml_number(v), {static_cast<double>(v)}};
}
FieldValue value_of(const glm::vec3& v) {
  return {FieldKind::kColour, toml_vector(v), {v.x, v.y, v.z}};
}
// A colour of a species.
FieldValue value_of(const std::array<double, 3>& v) {
  return {FieldKind::kColour, toml_vector(v), {v[0], v[1], v[2]}, {}, ColourEncoding::kSquareRoot};
}
FieldValue value_of(bool v) {
  return {FieldKind::kBoolean, v ? "true" : "false", {v ? 1.0 : 0.0}};
}
FieldValue text_value(const std::string& v, FieldKind kind = FieldKind::kText) {
  return {kind, v.empty() ? "" : toml_string(v), {}, v};
}

constexpr double kDecades = 100;  // minimum ratio of the ends of a logarithmic scale

// The specification of a field without limits.
constexpr models::NumberSpec without_limits(std::string_view doc, std::string_view unit = "") {
  return {.unit = unit, .doc = doc};
}

class SchemaBuilder {
 public:
  SchemaBuilder(const TextLayout& layout, const World& world, const models::Registry& registry)
      : layout_(layout), world_(world), registry_(registry) {}

  std::vector<WorldSection> all() {
    std::vector<WorldSection> sections;
    sections.push_back(world_section());
    sections.push_back(terrain_section());
    sections.push_back(section(SectionKind::kErosion, {"erosion"}, "Erosion"));
    add_all(sections.back(), world_.shaped.erosion, models::Erosion{}, models::visit_erosion);
    if (world_.shaped.network) {
      sections.push_back(section(SectionKind::kRivers, {"rivers"}, "Rivers"));
      add_all(sections.back(), *world_.shaped.network, models::RiverSettings{}, visit_rivers);
    }
    sections.push_back(section(SectionKind::kSky, {"sky"}, "Sky"));
    const Sky usual = with_sun(Sky{}, {Sky{}.sun_azimuth_deg, world_.sky.sun_elevation_deg});
    Sky usual_here = usual;
    usual_here.sun_elevation_deg = Sky{}.sun_elevation_deg;
    add_all(sections.back(), world_.sky, usual_here, visit_sky);
    sections.push_back(section(SectionKind::kWater, {"water"}, "Water"));
    add_all(sections.back(), world_.water, Water{}, visit_water);
    sections.push_back(palette_section());
    add_each(sections, "species", world_.species, &SchemaBuilder::species_section);
    add_each(sections, "model", world_.models, &SchemaBuilder::handmade_section);
    add_each(sections, "scatter", world_.scatter, &SchemaBuilder::scatter_section);
    add_each(sections, "place", world_.places.all, &SchemaBuilder::place_section);
    add_each(sections, "stamp", world_.shaped.stamps, &SchemaBuilder::stamp_section);
    add_each(sections, "road", world_.shaped.roads, &SchemaBuilder::road_section);
    add_each(sections, "lake", world_.shaped.lakes, &SchemaBuilder::lake_section);
    add_each(sections, "river", world_.shaped.rivers, &SchemaBuilder::river_section);
    return sections;
  }

 private:
  template <class Item>
  void add_each(std::vector<WorldSection>& sections, std::string_view key,
                const std::vector<Item>& items,
                WorldSection (SchemaBuilder::*section_of)(const Item&, const TextPath&)
                    const) const {
    for (std::size_t i = 0; i < items.size(); ++i)
      sections.push_back((this->*section_of)(items[i], {key, i}));
  }
  WorldSection section(SectionKind kind, TextPath path, std::string title) const {
    WorldSection made;
    made.kind = kind;
    made.is_set = false;
    for (const TextPlace& place : layout_.places)
      made.is_set = made.is_set || place.path.starts_with(path);
    made.path = std::move(path);
    made.title = std::move(title);
    return made;
  }

  // Adds a field. `usual` is its default as TOML.
  WorldField& add(WorldSection& to, std::string_view key, FieldValue now, std::string usual,
                  const models::NumberSpec& spec) const {
    WorldField field;
    field.path = to.path.with(key);
    field.label = field_label(key, spec.unit);
    field.kind = now.kind;
    field.encoding = now.encoding;
    field.unit = spec.unit == "1" ? "" : spec.unit;
    field.doc = spec.doc;
    field.hard_min = spec.hard.min, field.hard_max = spec.hard.max;
    field.soft_min = spec.soft.min, field.soft_max = spec.soft.max;
    field.logarithmic = spec.soft.min > 0 && spec.soft.max >= kDecades * spec.soft.min;
    const TextPlace* at = layout_.find(field.path);
    field.is_set = at != nullptr;
    field.value = field.is_set ? std::string(layout_.value_of(*at)) : std::move(now.toml);
    field.numbers = std::move(now.numbers);
    field.plain = std::move(now.plain);
    field.usual = std::move(usual);
    to.fields.push_back(std::move(field));
    return to.fields.back();
  }
  void add_required(WorldSection& to, std::string_view key, FieldValue now,
                    const models::NumberSpec& spec) const {
    add(to, key, std::move(now), "", spec).required = true;
  }
  template <std::size_t n>
  void add_choice(WorldSection& to, std::string_view key, const std::string& now,
                  const std::string& usual, const std::array<std::string_view, n>& choices,
                  std::string_view doc) const {
    add(to, key, text_value(now, FieldKind::kChoice), toml_string(usual), without_limits(doc))
        .choices.assign(choices.begin(), choices.end());
  }
  // Adds the fields that `visit_fields` visits.
  template <class T, class VisitFields>
  void add_all(WorldSection& to, const T& now, const T& usual,
               const VisitFields& visit_fields) const {
    std::vector<std::string> defaults;
    visit_fields(usual, [&](std::string_view, const auto& value, const models::NumberSpec&) {
      defaults.push_back(value_of(value).toml);
    });
    std::size_t i = 0;
    visit_fields(now, [&](std::string_view key, const auto& value, const models::NumberSpec& spec) {
      add(to, key, value_of(value), defaults[i++], spec);
    });
  }
  // Adds a parameter of a model type.
  void add_parameter(WorldSection& to, std::string_view key, const models::ParameterSpec& spec,
                     ParameterRange now, bool is_range) const {
    const bool integer = spec.type == models::ParameterType::kInteger;
    const FieldKind kind = is_range ? (integer ? FieldKind::kIntegerRange : FieldKind::kRealRange)
                                    : (integer ? FieldKind::kInteger : FieldKind::kReal);
    FieldValue value{kind, toml_range(now.low, now.high, integer), {now.low}};
    if (is_range) value.numbers.push_back(now.high);
    add(to, key, std::move(value), toml_range(spec.default_value, spec.default_value, integer),
        {{spec.hard_min, spec.hard_max}, {spec.soft_min, spec.soft_max}, spec.unit, spec.doc});
  }
  void add_terrain_parameter(WorldSection& to, std::string_view key, std::size_t i) const {
    const models::ModelType& type = registry_[world_.terrain_model];
    const double value = models::parameter_number(type, world_.terrain, i);
    add_parameter(to, key, type.parameters()[i], {value, value}, false);
  }

  WorldSection world_section() const {
    WorldSection made = section(SectionKind::kWorld, {"world"}, "World");
    add_required(made, "name", text_value(world_.name), without_limits("name of the world"));
    FieldValue seed{FieldKind::kSeed,
                    toml_seed(world_.seed),
                    {static_cast<double>(world_.seed)},
                    fmt::format("{}", world_.seed)};
    add_required(made, "seed", std::move(seed),
                 {{0, 0x1.0p64}, {0, 0x1.0p63}, "", "random seed of the world"});
    const double x = static_cast<double>(world_.blocks_x), z = static_cast<double>(world_.blocks_z);
    FieldValue blocks{
        FieldKind::kIntegerPair, fmt::format("[{}, {}]", world_.blocks_x, world_.blocks_z), {x, z}};
    add_required(made, "blocks", std::move(blocks), kBlocks);
    for (const TerrainAlias& alias : kWorldKeys)
      add_terrain_parameter(made, alias.key,
                            static_cast<std::size_t>(models::parameter_index(
                                registry_[world_.terrain_model], alias.parameter)));
    return made;
  }

  WorldSection terrain_section() const {
    WorldSection made = section(SectionKind::kTerrain, {"terrain"}, "Terrain");
    const auto specs = registry_[world_.terrain_model].parameters();
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (is_terrain_key(specs[i])) add_terrain_parameter(made, specs[i].name, i);
    }
    return made;
  }

  WorldSection palette_section() const {
    WorldSection made = section(SectionKind::kPalette, {"palette"}, "Palette");
    add_all(made, world_.palette, Palette{}, visit_palette);
    for (std::size_t i = 0; i < kPaletteImages.size(); ++i)
      add(made, kPaletteImages[i], text_value(world_.palette.images[i], FieldKind::kImage), "",
          without_limits("a square image that repeats and replaces the texture"));
    return made;
  }

  WorldSection species_section(const models::Species& s, const TextPath& path) const {
    const models::Species usual;
    WorldSection made = section(SectionKind::kSpecies, path, s.name);
    add_required(made, "name", text_value(s.name),
                 without_limits("snake_case, different from all other models"));
    add(made, "doc", text_value(s.doc), "", without_limits("description in one sentence"));
    add_required(made, "axiom", text_value(s.axiom),
                 without_limits("the symbol of the trunk's kind"));
    add_all(made, s, usual, [](auto& o, const auto& v) { models::visit_counts(o, v); });
    add_all(made, s, usual, [](auto& o, const auto& v) { models::visit_numbers(o, v); });
    for (std::size_t i = 0; i < s.kinds.size(); ++i)
      made.parts.push_back(kind_section(s.kinds[i], path.with("kind").with(i)));
    for (std::size_t i = 0; i < s.rules.size(); ++i)
      made.parts.push_back(rule_section(s.rules[i], path.with("rule").with(i)));
    made.parts.push_back(section(SectionKind::kSpeciesFoliage, path.with("foliage"), "Foliage"));
    add_choice(made.parts.back(), "form", s.foliage.form, usual.foliage.form, models::kFoliageForms,
               "shape of a spray of leaves");
    add_all(made.parts.back(), s.foliage, usual.foliage,
            [](auto& o, const auto& v) { models::visit_foliage_numbers(o, v); });
    made.parts.push_back(section(SectionKind::kSpeciesColours, path.with("colours"), "Colours"));
    add_all(made.parts.back(), s.colours, usual.colours,
            [](auto& o, const auto& v) { models::visit_colours(o, v); });
    return made;
  }

  WorldSection kind_section(const models::SpeciesKind& k, TextPath path) const {
    const models::SpeciesKind usual;
    WorldSection made = section(SectionKind::kSpeciesKind, std::move(path), k.symbol);
    add_required(made, "symbol", text_value(k.symbol),
                 without_limits("the letter of this kind in rules"));
    add(made, "leader", value_of(k.leader), "false",
        without_limits("continues its parent from the end, in its direction"));
    add_choice(made, "leaves", k.leaves, usual.leaves, models::kLeavesChoices,
               "branches with leaves; tips: branches that do not branch further");
    add_all(made, k, usual, [](auto& o, const auto& v) { models::visit_kind_numbers(o, v); });
    return made;
  }

  WorldSection rule_section(const models::SpeciesRule& r, TextPath path) const {
    WorldSection made =
        section(SectionKind::kSpeciesRule, std::move(path), fmt::format("{} -> {}", r.from, r.to));
    add_required(made, "from", text_value(r.from), without_limits("the kind that branches"));
    add_required(made, "to", text_value(r.to),
                 without_limits("its branches: letters, each with a number or, once, a star"));
    add_all(made, r, models::SpeciesRule{},
            [](auto& o, const auto& v) { models::visit_rule_numbers(o, v); });
    return made;
  }

  WorldSection handmade_section(const HandmadeModel& m, const TextPath& path) const {
    const HandmadeModel usual;
    WorldSection made = section(SectionKind::kModel, path, m.name);
    add_required(made, "name", text_value(m.name),
                 without_limits("snake_case, different from all other models"));
    add_required(made, "file", text_value(m.file),
                 without_limits("a glTF file (.glb or .gltf) in the folder of the world or below"));
    add_all(made, m, usual, visit_handmade);
    add_choice(made, "collider", m.collider, usual.collider, kHandmadeColliders,
               "collider: the hull of its points, their box, or none");
    return made;
  }

  void add_mask(WorldSection& to, const ScatterMask& mask, std::string_view image_doc,
                std::string_view area_doc) const {
    const bool has_area = mask.area_m != std::array<double, 4>{};
    add(to, "mask_image", text_value(mask.image, FieldKind::kImage), "", without_limits(image_doc));
    add(to, "mask_area_m", {FieldKind::kToml, has_area ? toml_vector(mask.area_m) : "", {}}, "",
        without_limits(area_doc, "m"));
    add_all(to, mask, ScatterMask{}, visit_mask);
  }

  template <class Shape>
  void add_switch(WorldSection& to, const Shape& shape) const {
    add(to, "enabled", value_of(shape.enabled), "true",
        without_limits("false: the world is as without it"))
        .is_switch = true;
  }
  template <class Shape>
  void add_layer(WorldSection& to, const Shape& shape) const {
    add_all(to, shape, Shape{}, visit_strength);
    add_switch(to, shape);
  }

  // A section whose first field chooses a model type.
  WorldSection model_section(SectionKind kind, const TextPath& path, const models::ModelType& type,
                             std::string_view doc) const {
    const std::string name(type.name());
    WorldSection made = section(kind, path, name);
    WorldField& model =
        add(made, "model", text_value(name, FieldKind::kChoice), "", without_limits(doc));
    model.required = true;
    for (models::ModelIndex i = 0; i < registry_.size(); ++i)
      if (i != world_.terrain_model) model.choices.emplace_back(registry_[i].name());
    return made;
  }

  WorldSection scatter_section(const Scatter& s, const TextPath& path) const {
    const models::ModelType& type = registry_[s.model];
    WorldSection made =
        model_section(SectionKind::kScatter, path, type, "model type of the instances");
    add_required(made, "count", value_of(std::int64_t{s.count}), kCount);
    add_all(made, s, Scatter{}, visit_place);
    const auto beside = static_cast<std::size_t>(std::countr_zero(s.site.beside));
    add(made, "beside",
        text_value(s.is_beside() ? std::string(registry_[world_.scatter[beside].model].name())
                                 : ""),
        "", without_limits("model of an earlier [[scatter]] that instances stand beside"));
    add(made, "on_ground",
        {FieldKind::kToml, s.mask.ground == 0 ? "" : toml_grounds(s.mask.ground), {}}, "",
        without_limits("kinds of ground with instances: [\"grass\", \"forest\"]"));
    add_mask(made, s.mask, "an image whose grey is the fraction of instances kept; white: all",
             "area of the image: [x0, z0, x1, z1]; default: the whole world");
    for (std::size_t i = 0; i < s.ranges.size(); ++i) {
      const models::ParameterSpec& spec = type.parameters()[i];
      if (spec.source == models::ParameterSource::kUser)
        add_parameter(made, spec.name, spec, s.ranges[i], true);
    }
    return made;
  }

  WorldSection place_section(const Place& p, const TextPath& path) const {
    const models::ModelType& type = registry_[p.model];
    WorldSection made = model_section(SectionKind::kPlace, path, type, "model type");
    add_required(made, "at_m", {FieldKind::kToml, toml_vector(std::array{p.at_m.x, p.at_m.y}), {}},
                 without_limits("position: [x, z]", "m"));
    add_all(made, p, Place{}, visit_placed);
    const auto specs = type.parameters();
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (specs[i].source != models::ParameterSource::kUser) continue;
      const double now = models::parameter_number(type, p.parameters, i);
      add_parameter(made, specs[i].name, specs[i], {now, now}, false);
    }
    return made;
  }

  WorldSection stamp_section(const Stamp& s, const TextPath& path) const {
    const Stamp usual;
    WorldSection made = section(SectionKind::kStamp, path, s.image);
    add_required(made, "image", text_value(s.image, FieldKind::kImage),
                 without_limits("an image whose grey or numbers are heights"));
    add_required(made, "centre_m",
                 {FieldKind::kToml, toml_vector(std::array{s.centre_m.x, s.centre_m.y}), {}},
                 without_limits("centre of the rectangle: [x, z]", "m"));
    add(made, "size_m",
        {FieldKind::kRealPair, toml_range(s.size_m.x, s.size_m.y), {s.size_m.x, s.size_m.y}},
        toml_number(usual.size_m.x), kStampSize);
    add_all(made, s, usual, visit_stamp);
    add_choice(made, "mode", s.mode, usual.mode, kStampModes,
               "adds to the ground, replaces it, or takes the higher or the lower of both");
    add_choice(made, "unit", s.unit, usual.unit, kStampUnits,
               "numbers of the image: grey from black to white, or heights in metres");
    add(made, "no_data",
        {FieldKind::kToml, std::isfinite(s.no_data) ? toml_number(s.no_data) : "", {}}, "",
        kNoData);
    add_layer(made, s);
    add_mask(made, s.mask, "an image whose grey is the fraction of the change; white: all",
             "area of the image: [x0, z0, x1, z1]; default: the rectangle of the stamp");
    add_all(made, s, usual, visit_ranges);
    return made;
  }

  WorldSection road_section(const Road& r, const TextPath& path) const {
    WorldSection made =
        section(SectionKind::kRoad, path, fmt::format("road {}", path.back().index + 1));
    add_required(made, "points_m", {FieldKind::kToml, toml_points(r.points_m), {}},
                 without_limits("points on the road: [[x, z], [x, z]]", "m"));
    add_all(made, r, Road{}, visit_road);
    add_layer(made, r);
    return made;
  }

  WorldSection lake_section(const Lake& l, const TextPath& path) const {
    WorldSection made =
        section(SectionKind::kLake, path, fmt::format("lake {}", path.back().index + 1));
    const bool round = l.points_m.empty();
    add(made, "points_m", {FieldKind::kToml, round ? "" : toml_points(l.points_m), {}}, "",
        without_limits("points of the outline: [[x, z], [x, z], [x, z]]", "m"));
    add(made, "centre_m",
        {FieldKind::kToml, round ? toml_vector(std::array{l.centre_m.x, l.centre_m.y}) : "", {}},
        "", without_limits("centre of a round lake: [x, z]", "m"));
    add(made, "radius_m", {FieldKind::kToml, round ? toml_number(l.radius_m) : "", {}}, "",
        kLakeRadius);
    add(made, "spill_m", {FieldKind::kToml, l.spill_m ? toml_number(*l.spill_m) : "", {}}, "",
        kSpill);
    add_all(made, l, Lake{}, visit_lake);
    add_switch(made, l);
    return made;
  }

  WorldSection river_section(const River& r, const TextPath& path) const {
    const River usual;
    WorldSection made =
        section(SectionKind::kRiver, path, fmt::format("river {}", path.back().index + 1));
    add_required(made, "points_m", {FieldKind::kToml, toml_points(r.points_m), {}},
                 without_limits("points on the river, downstream: [[x, z], [x, z]]", "m"));
    std::vector<std::string> defaults;
    const auto text_of = [](const std::vector<double>& numbers) {
      return numbers.empty() ? "" : toml_numbers(numbers);
    };
    visit_river_lists(usual, [&](std::string_view, const auto& numbers, const models::NumberSpec&) {
      defaults.push_back(text_of(numbers));
    });
    std::size_t i = 0;
    visit_river_lists(
        r, [&](std::string_view key, const auto& numbers, const models::NumberSpec& spec) {
          add(made, key, {FieldKind::kToml, text_of(numbers), {}}, defaults[i++], spec);
        });
    add_all(made, r, usual, visit_river);
    add_switch(made, r);
    return made;
  }

  const TextLayout& layout_;
  const World& world_;
  const models::Registry& registry_;
};

}  // namespace

core::Result<std::vector<WorldSection>> world_schema(std::string_view text, const World& world,
                                                     const models::Registry& registry) {
  const auto layout = lay_out(text, "the text");
  if (!layout) return tl::unexpected(layout.error());
  if (layout->item_count({"species"}) != world.species.size() ||
      layout->item_count({"model"}) != world.models.size() ||
      layout->item_count({"scatter"}) != world.scatter.size() ||
      layout->item_count({"place"}) != world.places.all.size() ||
      layout->item_count({"stamp"}) != world.shaped.stamps.size() ||
      layout->item_count({"road"}) != world.shaped.roads.size() ||
      layout->item_count({"lake"}) != world.shaped.lakes.size() ||
      layout->item_count({"river"}) != world.shaped.rivers.size())
    return core::fail(core::ErrorCode::kInvalidArgument, "the world does not belong to the text");
  return SchemaBuilder(*layout, world, registry).all();
}

const WorldField* find_field(const std::vector<WorldSection>& sections, const TextPath& path) {
  for (const WorldSection& section : sections) {
    if (!path.starts_with(section.path)) continue;
    for (const WorldField& field : section.fields) {
      if (field.path == path) return &field;
    }
    if (const WorldField* found = find_field(section.parts, path)) return found;
  }
  return nullptr;
}

std::string field_label(std::string_view key, std::string_view unit) {
  // Plain words for keys that are short or rare.
  static constexpr std::pair<std::string_view, std::string_view> kLabels[] = {
      {"above_m", "Height above ground"},
      {"at_m", "Position"},
      {"axiom", "Start symbol"},
      {"clear_m", "Clearance"},
      {"doc", "Description"},
      {"dry", "Dry grass"},
      {"mask_noise_m", "Mask patch size"},
      {"mask_patches", "Mask patch seed"},
      {"mask_share", "Mask coverage"},
      {"out", "Outward"},
      {"relief_m", "Height range"},
      {"side_out", "Side outward"},
      {"side_up", "Side upward"},
      {"sink_m", "Depth in ground"},
      {"turn_deg", "Rotation"},
      {"up", "Upward"},
  };
  for (const auto& [name, text] : kLabels)
    if (key == name) return std::string(text);
  const std::string_view suffix = unit == "degrees" ? "_deg"
                                  : unit == "m"     ? "_m"
                                  : unit == "s"     ? "_s"
                                                    : "";
  if (!suffix.empty() && key.ends_with(suffix)) key.remove_suffix(suffix.size());
  std::string label(key);
  for (char& c : label)
    if (c == '_') c = ' ';
  if (!label.empty() && label[0] >= 'a' && label[0] <= 'z')
    label[0] = static_cast<char>(label[0] - 'a' + 'A');
  return label;
}

}  // namespace psygen::world
