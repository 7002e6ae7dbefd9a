#include "engine/input/bindings_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "engine/core/nearest_word.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/world/files/document.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::input {
namespace {

using world::Node;
using world::Presence;
using world::Problems;
using world::TableReader;

constexpr std::size_t kMaxControlBytes = 64;
constexpr world::Limits kScales{-1000, 1000};
constexpr world::Limits kDeadZones{0, 0.95};

struct ActionTable {
  ActionId action = 0;
  std::vector<Binding> bindings;
};

Binding read_binding(TableReader& reader) {
  Binding binding;
  std::string control;
  if (reader.read("control", control, kMaxControlBytes, Presence::kRequired)) {
    if (const auto named = control_named(control)) {
      binding.control = *named;
    } else {
      reader.problem("control", named.error().message);
    }
  }
  if (reader.read("scale", binding.scale, kScales) && binding.scale == 0)
    reader.problem("scale", "0 would ignore the control");
  reader.read("dead_zone", binding.dead_zone, kDeadZones);
  reader.finish();
  return binding;
}

std::string no_action(const std::string& name, const Actions& actions) {
  std::vector<std::string> names;
  for (ActionId id = 0; id < actions.size(); ++id)
    names.push_back(actions.name(id));
  const std::string_view nearest = core::nearest_word(name, names);
  return fmt::format("there is no action \"{}\"{}", core::shown(name, Actions::kMaxNameBytes),
                     nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest));
}

ActionTable read_action(TableReader& reader, const Actions& actions) {
  ActionTable table;
  std::string name;
  if (reader.read("name", name, Actions::kMaxNameBytes, Presence::kRequired)) {
    if (const auto id = actions.find(name)) {
      table.action = *id;
    } else {
      reader.problem("name", no_action(name, actions));
    }
  }
  for (TableReader& binding : reader.tables("binding", Actions::kMaxBindings))
    table.bindings.push_back(read_binding(binding));
  reader.finish();
  return table;
}

}  // namespace

std::string bindings_text(const Actions& actions) {
  std::string text = fmt::format("format = {}\n", kBindingsFormat);
  for (ActionId id = 0; id < actions.size(); ++id) {
    text += fmt::format("\n[[action]]\nname = \"{}\"\n", actions.name(id));
    for (const Binding& binding : actions.bindings(id)) {
      text += fmt::format("[[action.binding]]\ncontrol = \"{}\"\n", name_of(binding.control));
      if (binding.scale != Binding{}.scale) text += fmt::format("scale = {}\n", binding.scale);
      if (binding.dead_zone != Binding{}.dead_zone)
        text += fmt::format("dead_zone = {}\n", binding.dead_zone);
    }
  }
  return text;
}

core::Result<void> apply_bindings(std::string_view text, std::string_view file_name,
                                  Actions& actions) {
  const core::Result<Node> document = world::parse_document(text, file_name);
  if (!document) return tl::unexpected(document.error());
  Problems problems(file_name);
  TableReader root(*document, "", 1, problems);
  world::read_format(root, kBindingsFormat);
  // For another version, errors about other fields would be misleading.
  if (problems.any()) return tl::unexpected(problems.first());
  std::vector<ActionTable> tables;
  std::vector<bool> seen(actions.size(), false);
  for (TableReader& reader : root.tables("action", Actions::kMaxActions)) {
    tables.push_back(read_action(reader, actions));
    if (problems.any()) continue;
    if (seen[tables.back().action]) {
      reader.problem(reader.line(), "name",
                     fmt::format("\"{}\" is a duplicate", actions.name(tables.back().action)));
    }
    seen[tables.back().action] = true;
  }
  root.finish();
  if (problems.any()) return tl::unexpected(problems.first());
  for (ActionTable& table : tables)
    (void)actions.set_bindings(table.action, std::move(table.bindings));  // they were checked
  return {};
}

core::Result<void> save_bindings(const Actions& actions, const std::filesystem::path& file) {
  return core::replace_file(file, bindings_text(actions));
}

core::Result<void> load_bindings(const std::filesystem::path& file, Actions& actions) {
  const core::Result<std::string> text = world::read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return apply_bindings(*text, file.string(), actions);
}

}  // namespace psygen::input
