#include "engine/models/registry.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "engine/core/assert.hpp"
#include "engine/models/grass/grass.hpp"
#include "engine/models/rock/rock.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/models/tree/tree.hpp"

namespace psygen::models {
namespace {

bool is_snake_case(std::string_view name) {
  if (name.empty() || name.front() < 'a' || name.front() > 'z') return false;
  for (const char c : name) {
    if (c != '_' && (c < '0' || c > '9') && (c < 'a' || c > 'z')) return false;
  }
  return true;
}

// Returns the violation of the rules of schemas, as the end of a sentence; empty if there is none.
std::string_view fault_of(const ParameterSpec& spec) {
  if (!is_snake_case(spec.name)) return "has a name that is not snake_case";
  for (const double v :
       {spec.default_value, spec.hard_min, spec.hard_max, spec.soft_min, spec.soft_max}) {
    if (!std::isfinite(v)) return "has a range that is not finite";
    if (spec.type == ParameterType::kInteger && v != std::floor(v))
      return "is an integer with a broken range";
    if (v < spec.hard_min || v > spec.hard_max)
      return "has a default or a soft range outside its hard range";
  }
  if (spec.soft_min > spec.soft_max) return "has a soft range whose ends are swapped";
  return {};
}

core::Result<void> check_schema(const ModelType& type) {
  const auto refuse = [&](std::string_view parameter, std::string_view fault) {
    return core::invalid_argument(
        fmt::format("model type {}: parameter {} {}", type.name(), parameter, fault));
  };
  const std::span<const ParameterSpec> specs = type.parameters();
  if (specs.size() > Parameters::kMaxCount)
    return refuse(specs[Parameters::kMaxCount].name,
                  fmt::format("is one more than the {} allowed ones", Parameters::kMaxCount));
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (const std::string_view fault = fault_of(specs[i]); !fault.empty())
      return refuse(specs[i].name, fault);
    if (parameter_index(type, specs[i].name) != static_cast<int>(i))
      return refuse(specs[i].name, "occurs twice");
  }
  return {};
}

}  // namespace

core::Result<ModelIndex> Registry::add(std::unique_ptr<ModelType> type) {
  using core::ErrorCode;
  if (!type) return core::invalid_argument("a model type must not be null");
  if (!is_snake_case(type->name()))
    return core::invalid_argument(
        fmt::format("model type \"{}\": its name is not snake_case", type->name()));
  if (find(type->name()) >= 0)
    return core::invalid_argument(
        fmt::format("model type {}: the name is already taken", type->name()));
  if (types_.size() > std::numeric_limits<ModelIndex>::max())
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("model type {}: the registry is full", type->name()));
  if (type->level_count() < 1)
    return core::invalid_argument(
        fmt::format("model type {}: it has no level of detail", type->name()));
  if (auto checked = check_schema(*type); !checked)
    return tl::unexpected<core::Error>(std::move(checked.error()));
  const auto index = static_cast<ModelIndex>(types_.size());
  by_name_.emplace(type->name(), index);
  types_.push_back(std::move(type));
  return index;
}

void Registry::shrink(std::size_t size) {
  for (; types_.size() > size; types_.pop_back())
    by_name_.erase(types_.back()->name());
}

int Registry::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? -1 : int{found->second};
}

Registry make_standard_registry() {
  Registry registry;
  for (auto make : {make_terrain_type, make_rock_type, make_tree_type, make_grass_type}) {
    const auto added = registry.add(make());
    PSYGEN_CHECK(added.has_value(), "the standard types have sound schemas");
  }
  return registry;
}

}  // namespace psygen::models
