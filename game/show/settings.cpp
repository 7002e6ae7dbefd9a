#include "game/show/settings.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/core/replace_file.hpp"
#include "engine/input/bindings_file.hpp"

namespace cairns {
namespace {

constexpr const char* kFile = "settings.toml";
constexpr const char* kKeys = "keys.toml";

}  // namespace

core::Result<void> load_keys(const std::filesystem::path& folder, input::Actions& actions) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kKeys, ignored)) return {};
  return input::load_bindings(folder / kKeys, actions);
}

core::Result<Settings> load_settings(const std::filesystem::path& folder) {
  Settings settings;
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kFile, ignored)) return settings;
  try {
    const toml::table table = toml::parse_file((folder / kFile).string());
    for (const Number& n : kNumbers) {
      if (const double value = table[n.name].value_or(settings.*n.value); std::isfinite(value))
        settings.*n.value = std::clamp(value, n.low, n.high);
    }
    for (const Switch& s : kSwitches)
      settings.*s.value = table[s.name].value_or(settings.*s.value);
    settings.quality = std::clamp(table["quality"].value_or(-1), -1, 3);
  } catch (const toml::parse_error& error) {
    return core::fail(core::ErrorCode::kParse,
                      (folder / kFile).string() + ": " + std::string(error.description()));
  }
  return settings;
}

core::Result<void> save_settings(const std::filesystem::path& folder, const Settings& settings,
                                 const input::Actions& actions) {
  toml::table table;
  for (const Number& n : kNumbers)
    table.insert(n.name, settings.*n.value);
  for (const Switch& s : kSwitches)
    table.insert(s.name, settings.*s.value);
  table.insert("quality", settings.quality);
  std::ostringstream text;
  text << table << '\n';
  if (auto ok = core::replace_file(folder / kFile, text.str()); !ok) return ok;
  return input::save_bindings(actions, folder / kKeys);
}

}  // namespace cairns
