#include "editor/document/field_value.hpp"

#include <bit>
#include <optional>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/world/files/text_edit.hpp"

namespace psygen::editor {
namespace {

using Text = core::Result<std::string>;

// The name in a TOML string; names of model types need no escapes.
std::string_view unquoted(std::string_view toml) {
  return toml.size() >= 2 ? toml.substr(1, toml.size() - 2) : std::string_view();
}

// True for paths such as species[2].name, of a table in an array of the root.
bool is_key_of_item(const world::TextPath& path, std::string_view key) {
  return path.size() == 3 && path.steps[1].is_index && path.back().key == key;
}

// The name of the model type that a table uses, such as scatter[2] or place[0].
std::optional<std::string_view> model_of(const ParsedWorld& parsed, const world::TextPath& table) {
  const world::World& world = parsed.world;
  const std::size_t item = table.steps[1].index;
  if (table.steps[0].key == "scatter" && item < world.scatter.size())
    return parsed.registry[world.scatter[item].model].name();
  if (table.steps[0].key == "place" && item < world.places.all.size())
    return parsed.registry[world.places.all[item].model].name();
  return std::nullopt;
}

// The name of the model type that the instances of a scatter stand beside.
std::optional<std::string_view> beside_of(const ParsedWorld& parsed, const world::TextPath& table) {
  const std::vector<world::Scatter>& scatter = parsed.world.scatter;
  const std::size_t item = table.steps[1].index;
  if (item >= scatter.size() || !scatter[item].is_beside()) return std::nullopt;
  const auto first = static_cast<std::size_t>(std::countr_zero(scatter[item].site.beside));
  return parsed.registry[scatter[first].model].name();
}

// The text with a new name in all tables that use the model type of `path`, a name.
Text with_model_renamed(const std::string& text, const ParsedWorld& before,
                        const world::TextPath& path, std::string_view name) {
  const world::World& world = before.world;
  const std::size_t item = path.steps[1].index;
  std::string old_name;
  if (path.steps[0].key == "species" && item < world.species.size())
    old_name = world.species[item].name;
  if (path.steps[0].key == "model" && item < world.models.size())
    old_name = world.models[item].name;
  if (old_name.empty()) return text;
  const auto uses = [&](const world::TextPath& value) {
    if (is_key_of_item(value, "beside")) return beside_of(before, value.parent()) == old_name;
    return is_key_of_item(value, "model") && model_of(before, value.parent()) == old_name;
  };
  return world::with_each_value(text, uses, name);
}

// The text after another model type at `path`, without the parameters that this type lacks.
Text without_unknown_parameters(std::string text, const ParsedWorld& before,
                                const world::TextPath& path, std::string_view name) {
  const auto used = model_of(before, path.parent());
  const int now = before.registry.find(unquoted(name));
  if (!used || now < 0) return text;
  const models::ModelType& type = before.registry[static_cast<models::ModelIndex>(now)];
  const auto old = static_cast<models::ModelIndex>(before.registry.find(*used));
  for (const models::ParameterSpec& spec : before.registry[old].parameters()) {
    const int i = models::parameter_index(type, spec.name);
    if (i >= 0 &&
        type.parameters()[static_cast<std::size_t>(i)].source == models::ParameterSource::kUser)
      continue;
    Text fewer = world::without_value(text, path.parent().with(spec.name));
    if (!fewer) return fewer;
    text = *std::move(fewer);
  }
  return text;
}

}  // namespace

core::Result<std::string> with_field_value(std::string_view text, const ParsedWorld& before,
                                           const world::TextPath& path,
                                           std::string_view toml_value) {
  Text changed = world::with_value(text, path, toml_value);
  if (changed && is_key_of_item(path, "name"))
    return with_model_renamed(*changed, before, path, toml_value);
  if (changed && is_key_of_item(path, "model"))
    return without_unknown_parameters(*std::move(changed), before, path, toml_value);
  return changed;
}

}  // namespace psygen::editor
