#include "engine/world/files/handmade_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxHandmadeBytes = 200;  // of a file name

// Reads a table, except its file. Returns false after a problem.
bool read_table(TableReader& reader, HandmadeModel& model) {
  bool sound = reader.read("name", model.name, 64, Presence::kRequired);
  if (reader.read("file", model.file, kMaxHandmadeBytes, Presence::kRequired))
    check_name_beside(reader, "file", model.file);
  visit_handmade(model, [&reader](std::string_view key, auto& field, const FieldSpec& spec) {
    reader.read(key, field, {spec.low, spec.high});
  });
  if (reader.read("collider", model.collider, 16) &&
      std::ranges::find(kHandmadeColliders, model.collider) == kHandmadeColliders.end()) {
    reader.problem(reader.find("collider")->line, "collider",
                   fmt::format("it must be one of {}", fmt::join(kHandmadeColliders, ", ")));
  }
  if (model.size_m > 0 && model.scale != 1)
    reader.problem(reader.find("scale")->line, "scale",
                   "size_m already sets the height of the model; give only one of the two");
  reader.finish();
  return sound;
}

void register_model(const HandmadeModel& model, const HandmadeSource& source, const Node& node,
                    std::size_t number, Problems& problems) {
  const auto refuse = [&](std::string_view key, std::string_view sentence,
                          core::ErrorCode code = core::ErrorCode::kParse) {
    int line = node.line;
    for (const Member& member : node.members)
      if (member.key == key) line = member.value.line;
    problems.add(line, fmt::format("model[{}].{}", number, key), sentence, code);
  };
  if (source.beside.files == nullptr)
    return refuse("file", "this program cannot read glTF models (engine/handmade)",
                  core::ErrorCode::kInvalidArgument);
  auto type = source.beside.path_of(model.file).and_then([&](const std::filesystem::path& file) {
    return source.beside.files->read_model(file, model);
  });
  if (!type) return refuse("file", type.error().message, type.error().code);
  if (const int known = source.registry.find(model.name); known >= 0) {
    const models::ModelType& there = source.registry[static_cast<models::ModelIndex>(known)];
    if (there.identity() != (*type)->identity())
      refuse("name", fmt::format("another model is named {}", model.name));
  } else if (source.grown == nullptr) {
    refuse("name", "this registry does not accept new models");
  } else if (auto added = source.grown->add(std::move(*type)); !added) {
    refuse("name", added.error().message);
  }
}

}  // namespace

bool check_name_beside(TableReader& reader, std::string_view key, const std::string& name) {
  const std::filesystem::path path(name);
  const bool leads_out =
      path.has_root_path() || std::find(path.begin(), path.end(), "..") != path.end();
  if (leads_out)
    reader.problem(reader.find(key)->line, key,
                   "it must be relative to the folder of the world file, without ..");
  return !leads_out;
}

std::vector<HandmadeModel> read_handmade(TableReader& root, const HandmadeSource& source,
                                         Problems& problems) {
  std::vector<HandmadeModel> models;
  for (const Node* node : root.tables("model", kMaxHandmadeModels)) {
    const std::size_t number = models.size();
    TableReader reader(*node, fmt::format("model[{}]", number), node->line, problems);
    models.emplace_back();
    const bool sound = read_table(reader, models.back());
    if (sound && !problems.any()) register_model(models.back(), source, *node, number, problems);
  }
  return models;
}

void write_handmade(const std::vector<HandmadeModel>& models, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const HandmadeModel& model : models) {
    fmt::format_to(out, "\n[[model]]\nname = {}\nfile = {}\n", toml_string(model.name),
                   toml_string(model.file));
    visit_handmade(model, [&](std::string_view key, const auto& value, const FieldSpec&) {
      fmt::format_to(out, "{} = {}\n", key, value);
    });
    fmt::format_to(out, "collider = {}\n", toml_string(model.collider));
  }
}

}  // namespace psygen::world
