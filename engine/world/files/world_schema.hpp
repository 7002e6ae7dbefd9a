// Every field of a world file as data, from which an editor makes its controls: position in the
// text, type, limits, and a line of help. It uses the lists of the readers (fields.hpp,
// tree/species.hpp) and the schemas of model types, so a program's own model types appear without
// further code. It changes nothing (text_edit.hpp). Plain values, any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/world/files/text_path.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The type of a field's value, and its form in TOML.
enum class FieldKind : std::uint8_t {
  kInteger,
  kReal,
  kIntegerRange,  // one number, or [lowest, highest]
  kRealRange,
  kIntegerPair,  // [x, z]
  kRealPair,     // one number for both, or [x, z]
  kColour,       // [red, green, blue]
  kSeed,         // 0 to 2^64 - 1; in quotes from 2^63 on
  kText,
  kImage,   // the name of an image, relative to the folder of the file
  kChoice,  // one of `choices`
  kBoolean,
  kToml,  // several parts, shown and written as TOML
};

// The meaning of a colour's numbers: linear light (albedo or radiance), or square roots of a linear
// albedo, as vertices store it.
enum class ColourEncoding : std::uint8_t { kLinear, kSquareRoot };

// One field.
struct WorldField {
  TextPath path;
  std::string label;  // "Sun elevation", without the unit
  FieldKind kind = FieldKind::kReal;
  ColourEncoding encoding = ColourEncoding::kLinear;  // for kColour
  std::string unit;                                   // "m", "degrees"; empty: none
  std::string doc;                                    // one line
  // For each of its numbers: the limits beyond which values are rejected, and the range of a
  // slider. The value and the default may be outside the soft range.
  double hard_min = 0, hard_max = 0, soft_min = 0, soft_max = 0;
  bool logarithmic = false;          // the soft range is positive and spans two decades or more
  std::vector<std::string> choices;  // for kChoice
  bool required = false;             // has no default and cannot be removed
  bool is_switch = false;            // false: the world is as without the field's table
  bool is_set = false;               // the text has it
  // The present value, in three forms: as TOML (from the text, else the default); as numbers (one,
  // two for ranges and pairs, three for colours); and, for texts, choices and seeds, without
  // quotes. Empty if there is no value, such as a limit that is not set.
  std::string value;
  std::vector<double> numbers;
  std::string plain;
  std::string usual;  // the default as TOML; empty: no default
};

// The type of a section.
enum class SectionKind : std::uint8_t {
  kWorld,
  kTerrain,
  kErosion,
  kRivers,
  kSky,
  kWater,
  kPalette,
  kSpecies,
  kSpeciesKind,
  kSpeciesRule,
  kSpeciesFoliage,
  kSpeciesColours,
  kModel,
  kScatter,
  kPlace,
  kStamp,
  kRoad,
  kLake,
  kRiver,
};

// A table of the file with its fields.
struct WorldSection {
  SectionKind kind = SectionKind::kWorld;
  TextPath path;
  std::string title;  // "Sky"; the name of a species, the model of a scatter, the symbol of a kind
  bool is_set = false;  // the text has the table
  std::vector<WorldField> fields;
  std::vector<WorldSection> parts;  // for a species: kinds, rules, foliage, colours
};

// The sections of a world: World, Terrain, Erosion, Rivers, Sky, Water, Palette, each species, each
// handmade model, each scatter, each place, each stamp, each road, each lake, each river. `world`
// must be the result of parse_world() for `text` with `registry`. Fails with kParse if the text is
// not TOML, and with kInvalidArgument if the world belongs to another text.
core::Result<std::vector<WorldSection>> world_schema(std::string_view text, const World& world,
                                                     const models::Registry& registry);

// The field with this path, or null.
const WorldField* find_field(const std::vector<WorldSection>& sections, const TextPath& path);

// The label for a key: "sun_elevation_deg" in degrees gives "Sun elevation".
std::string field_label(std::string_view key, std::string_view unit);

}  // namespace psygen::world
