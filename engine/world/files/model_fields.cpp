#include "engine/world/files/model_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <span>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

// The parameter to blame: one outside its hard range or, if all together cost too much, the one on
// the last line.
std::size_t culprit_of(const ModelFields& fields, const models::Parameters& p) {
  const auto specs = fields.type->parameters();
  std::size_t last = 0;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const double value = models::parameter_number(*fields.type, p, i);
    if (!(value >= specs[i].hard_min && value <= specs[i].hard_max)) return i;
    if (fields.lines[i] > fields.lines[last]) last = i;
  }
  return last;
}

std::uint32_t corner_count(const ModelFields& fields) {
  return 1U << std::ranges::count_if(fields.ranges,
                                     [](const ParameterRange& r) { return r.low != r.high; });
}

// Reads a table, except its file.
void read_table(TableReader& reader, HandmadeModel& model) {
  reader.read("name", model.name, 64, Presence::kRequired);
  read_name_beside(reader, "file", model.file, Presence::kRequired);
  visit_handmade(model, FieldReader{reader});
  if (reader.read("collider", model.collider, 16) &&
      std::ranges::find(kHandmadeColliders, model.collider) == kHandmadeColliders.end())
    reader.problem("collider",
                   fmt::format("it must be one of {}", fmt::join(kHandmadeColliders, ", ")));
  if (model.size_m > 0 && model.scale != 1)
    reader.problem("scale",
                   "size_m already sets the height of the model; give only one of the two");
  reader.finish();
}

// Reads the files of all tables and registers their types, up to the first problem.
void register_models(const std::vector<HandmadeModel>& models, const HandmadeSource& source,
                     std::span<TableReader> readers) {
  if (source.beside.files == nullptr)
    return readers.front().problem("file", "this program cannot read glTF models (engine/handmade)",
                                   core::ErrorCode::kInvalidArgument);
  std::vector<ModelFile> files;
  std::optional<core::Error> leads_out;
  for (const HandmadeModel& model : models) {
    auto path = source.beside.path_of(model.file);
    if (!path) leads_out = path.error();
    if (!path) break;
    files.push_back({*std::move(path), &model});
  }
  ModelTypes types = source.beside.files->read_models(files);
  if (leads_out && types.size() == files.size())
    types.emplace_back(tl::unexpected(*std::move(leads_out)));
  for (std::size_t i = 0; i < types.size(); ++i) {
    TableReader& reader = readers[i];
    if (!types[i]) return reader.problem("file", types[i].error().message, types[i].error().code);
    if (const auto refused = register_type(*std::move(types[i]), source.registry, source.grown))
      return reader.problem("name", *refused);
  }
}

}  // namespace

ModelFields fields_of(const models::ModelType& type, int line) {
  ModelFields fields{&type, {}, {}, {}};
  for (const models::ParameterSpec& spec : type.parameters()) {
    fields.ranges.push_back({spec.default_value, spec.default_value});
    fields.lines.push_back(line);
    fields.names.emplace_back(spec.name);
  }
  return fields;
}

void read_parameter(TableReader& reader, std::string_view key, std::size_t i, bool is_range,
                    ModelFields& fields) {
  fields.names[i] = reader.field(key);
  const std::optional<NumberRange> range = reader.read_range(key);
  if (!range) return;
  fields.lines[i] = range->line;
  const bool integer = fields.type->parameters()[i].type == models::ParameterType::kInteger;
  if (integer && !range->integers) {
    reader.problem(range->line, key, "it must be an integer, or [lowest, highest] of integers");
  } else if (!is_range && range->low != range->high) {
    reader.problem(range->line, key, "it must be one number, the same for the whole world");
  } else {
    fields.ranges[i] = {range->low, range->high};
  }
}

models::Parameters corner_of(const ModelFields& fields, std::uint32_t corner) {
  models::Parameters p = models::default_parameters(*fields.type);
  std::uint32_t bit = 0;
  for (std::size_t i = 0; i < fields.ranges.size(); ++i) {
    const ParameterRange& range = fields.ranges[i];
    if (fields.type->parameters()[i].source == models::ParameterSource::kPlaced) continue;
    const bool high = range.low != range.high && (corner >> bit++ & 1U) != 0;
    set_parameter(*fields.type, p, i, high ? range.high : range.low);
  }
  return p;
}

bool check_model(const ModelFields& fields, Problems& problems) {
  for (std::uint32_t corner = 0; corner < corner_count(fields); ++corner) {
    const models::Parameters p = corner_of(fields, corner);
    if (const auto valid = models::validate(*fields.type, p); !valid) {
      const std::size_t i = culprit_of(fields, p);
      problems.add(fields.lines[i], fields.names[i], valid.error().message, valid.error().code);
      return false;
    }
  }
  return true;
}

double log2_cost(const ModelFields& fields) {
  double cost = 0;
  for (std::uint32_t corner = 0; corner < corner_count(fields); ++corner)
    cost = std::max(cost, fields.type->log2_cost(corner_of(fields, corner)));
  return cost;
}

std::optional<std::string> register_type(std::unique_ptr<models::ModelType> type,
                                         const models::Registry& registry,
                                         models::Registry* grown) {
  if (const int known = registry.find(type->name()); known >= 0) {
    const models::ModelType& there = registry[static_cast<models::ModelIndex>(known)];
    if (there.identity() == type->identity()) return std::nullopt;
    return fmt::format("another model is named {}", type->name());
  }
  if (grown == nullptr) return "this registry does not accept new models";
  const auto added = grown->add(std::move(type));
  return added ? std::nullopt : std::optional(added.error().message);
}

bool read_name_beside(TableReader& reader, std::string_view key, std::string& name,
                      Presence presence) {
  constexpr std::size_t kMaxBytes = 200;
  if (!reader.read(key, name, kMaxBytes, presence)) return false;
  const std::filesystem::path path(name);
  const bool leads_out = path.has_root_path() || std::ranges::find(path, "..") != path.end();
  if (leads_out)
    reader.problem(key, "it must be relative to the folder of the world file, without ..");
  return !leads_out;
}

std::vector<HandmadeModel> read_handmade(TableReader& root, const HandmadeSource& source) {
  std::vector<HandmadeModel> models;
  std::vector<TableReader> readers = root.tables("model", kMaxHandmadeModels);
  for (TableReader& reader : readers)
    read_table(reader, models.emplace_back());
  if (!models.empty() && !root.problems().any()) register_models(models, source, readers);
  return models;
}

void write_handmade(const std::vector<HandmadeModel>& models, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const HandmadeModel& model : models) {
    fmt::format_to(out, "\n[[model]]\nname = {}\nfile = {}\n", toml_string(model.name),
                   toml_string(model.file));
    visit_handmade(model, FieldWriter{text});
    fmt::format_to(out, "collider = {}\n", toml_string(model.collider));
  }
}

}  // namespace psygen::world
