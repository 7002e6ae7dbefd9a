// psygen models: lists every model type and every parameter, from the schemas.
#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/cli/commands.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/placement.hpp"

namespace psygen::cli {
namespace {

std::string number(const models::ParameterSpec& spec, double value) {
  if (spec.type == models::ParameterType::kInteger) {
    return fmt::format("{:.0f}", value);
  }
  return fmt::format("{:g}", value);
}

nlohmann::ordered_json to_json(const models::ParameterSpec& spec) {
  return {{"name", spec.name},
          {"type", spec.type == models::ParameterType::kInteger ? "integer" : "real"},
          {"unit", spec.unit},
          {"default", spec.default_value},
          {"range", {spec.hard_min, spec.hard_max}},
          {"usual", {spec.soft_min, spec.soft_max}},
          {"set_by", spec.source == models::ParameterSource::kUser ? "user" : "world"},
          {"doc", spec.doc}};
}

std::string json_of(const models::Registry& registry) {
  auto list = nlohmann::ordered_json::array();
  for (models::ModelIndex i = 0; i < registry.size(); ++i) {
    const models::ModelType& type = registry[i];
    auto parameters = nlohmann::ordered_json::array();
    for (const models::ParameterSpec& spec : type.parameters())
      parameters.push_back(to_json(spec));
    list.push_back({{"name", type.name()},
                    {"doc", type.doc()},
                    {"levels", type.level_count()},
                    {"parameters", parameters}});
  }
  return list.dump(2) + "\n";
}

std::string table_of(const models::Registry& registry) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (models::ModelIndex i = 0; i < registry.size(); ++i) {
    const models::ModelType& type = registry[i];
    fmt::format_to(out, "{}{}: {} ({} levels of detail)\n", i == 0 ? "" : "\n", type.name(),
                   type.doc(), type.level_count());
    for (const models::ParameterSpec& spec : type.parameters()) {
      if (spec.source == models::ParameterSource::kPlaced) {
        fmt::format_to(out, "  {:<16} set by the world{:<21} {}\n", spec.name, "", spec.doc);
        continue;
      }
      const std::string range =
          fmt::format("{} to {}", number(spec, spec.hard_min), number(spec, spec.hard_max));
      fmt::format_to(out, "  {:<16} {:>8} {:<9} {:<18} {}\n", spec.name,
                     number(spec, spec.default_value), spec.unit, range, spec.doc);
    }
  }
  return text;
}

// The tables [[scatter]] of a world: how many instances each has on a block, and how many stand.
std::string stands_of(const world::World& world, const models::Registry& registry) {
  std::string text;
  const std::vector<double> placed = world::placed_per_block(world, registry);
  for (std::size_t s = 0; s < placed.size(); ++s) {
    const world::Scatter& scatter = world.scatter[s];
    fmt::format_to(std::back_inserter(text),
                   "\nscatter[{}] {:<12} {:>5} instances a block, {:.1f} stand", s,
                   registry[scatter.model].name(), scatter.count, placed[s]);
  }
  return text.empty() ? text : text + "\n";
}

class ModelsCommand final : public Command {
 public:
  explicit ModelsCommand(CLI::App& cli)
      : Command(cli, "models", "List every model type and its parameters") {
    command_->add_flag("--json", json_, "Print the list as JSON");
    command_->add_option("--world", world_,
                         "Include the species of this world, and how many instances stand");
  }

  int run() override {
    models::Registry registry = models::make_standard_registry();
    std::string stands;
    if (!world_.empty()) {
      const auto world = load_world(world_, registry);
      if (!world) return fail_with(world.error());
      if (!json_) stands = stands_of(*world, registry);
    }
    return print(json_ ? json_of(registry) : table_of(registry) + stands);
  }

 private:
  std::string world_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_models_command(CLI::App& cli) {
  return std::make_unique<ModelsCommand>(cli);
}

}  // namespace psygen::cli
