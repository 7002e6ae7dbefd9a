#include "game/show/settings.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

#include "engine/core/replace_file.hpp"
#include "engine/input/bindings_file.hpp"
#include "engine/world/files/document.hpp"
#include "engine/world/files/text_file.hpp"

namespace cairns {
namespace {

constexpr const char* kFile = "settings.toml";
constexpr const char* kKeys = "keys.toml";
using SettingKind = world::Node::Kind;

// The finite number of a key, or `usual`.
double number_of(const world::Node& table, std::string_view key, double usual) {
  const world::Member* found = table.find(key);
  if (found == nullptr) return usual;
  const bool is_number =
      found->value.kind == SettingKind::kReal || found->value.kind == SettingKind::kInteger;
  return is_number && std::isfinite(found->value.real) ? found->value.real : usual;
}

}  // namespace

core::Result<void> load_keys(const std::filesystem::path& folder, input::Actions& actions) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kKeys, ignored)) return {};
  return input::load_bindings(folder / kKeys, actions);
}

core::Result<Settings> load_settings(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kFile;
  Settings settings;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return settings;
  const auto text = world::read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  const auto root = world::parse_document(*text, file.string());
  if (!root) return tl::unexpected(root.error());
  for (const Number& n : kNumbers)
    settings.*n.value = std::clamp(number_of(*root, n.name, settings.*n.value), n.low, n.high);
  for (const Switch& s : kSwitches) {
    const world::Member* found = root->find(s.name);
    if (found != nullptr && found->value.kind == SettingKind::kBoolean)
      settings.*s.value = found->value.boolean;
  }
  settings.quality = static_cast<int>(std::clamp(number_of(*root, "quality", -1), -1.0, 3.0));
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
