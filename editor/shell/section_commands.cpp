#include "editor/shell/section_commands.hpp"

#include <QDir>
#include <QFileDialog>
#include <QMenu>

#include "editor/document/qt_text.hpp"
#include "editor/gallery/library_panel.hpp"
#include "editor/pictures/preset_library.hpp"
#include "editor/shell/panel.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/text_edit.hpp"

namespace psygen::editor {
namespace {

// A section that is an item of a list of tables, such as a scatter or a species.
bool is_item(const world::TextPath& path) {
  return !path.empty() && path.back().is_index;
}

// Shows the section of the selection's model type, or of the terrain for the ground.
void open_section_of_selection(const EditorContext& context) {
  const Selection& selection = *context.view.selection();
  const std::string_view name = context.view.session()->scene().registry()[selection.model].name();
  const bool is_ground = selection.kind == query::HitKind::kGround;
  for (const world::WorldSection& section : context.document.sections()) {
    if (section.title == name || (is_ground && section.kind == world::SectionKind::kTerrain))
      return context.properties.go_to(section.path);
  }
}

// The section stays chosen at its new place. The first and the last one stay where they are.
void move_section(const EditorContext& context, int by) {
  const world::TextPath path = context.properties.section();
  if (!is_item(path))
    return context.messages.show_message(tr("Only sections of a list can be moved."));
  const std::size_t from = path.back().index;
  const std::size_t count = world::item_count(context.document.text(), path.parent());
  if (by < 0 ? from == 0 : from + 1 >= count) return;
  const std::size_t to = by < 0 ? from - 1 : from + 1;
  const std::string before = context.document.text();
  // An edit that awaits confirmation has not moved the section yet.
  if (context.messages.check(context.document.move_table(path, to)) &&
      context.document.text() != before)
    context.properties.go_to(path.parent().with(to));
}

void save_preset(const EditorContext& context, LibraryPanel& library) {
  const QString folder = to_qstring(own_library_folder().string());
  QDir().mkpath(folder);
  const QString file = QFileDialog::getSaveFileName(
      &context.window, tr("Save a preset"), folder + "/preset.toml", tr("Presets (*.toml)"));
  if (!file.isEmpty() && context.messages.check(context.document.save_preset(
                             context.properties.section(), file.toStdString())))
    library.reload();
}

void apply_preset(const EditorContext& context) {
  const QString file = QFileDialog::getOpenFileName(&context.window, tr("Apply a preset"), {},
                                                    tr("Presets (*.toml)"));
  if (!file.isEmpty())
    context.messages.check(
        context.document.apply_preset(context.properties.section(), file.toStdString()));
}

// A command of the menu and of the context menu.
struct SectionCommand {
  QString name, short_name;
  QKeySequence shortcut;
  std::function<void()> run;
};

std::vector<SectionCommand> commands_of_any(const EditorContext& context) {
  PropertiesPanel& of = context.properties;
  return {{tr("Randomise this section"), tr("Randomise"), tr("Ctrl+R"), [&of] { of.randomise(); }},
          {tr("Reset this section"), tr("Reset"), tr("Ctrl+Shift+0"), [&of] { of.reset(); }},
          {tr("Copy this section"), tr("Copy"), tr("Ctrl+Shift+C"), [&of] { of.copy(); }},
          {tr("Paste into this section"), tr("Paste"), tr("Ctrl+Shift+V"), [&of] { of.paste(); }}};
}

std::vector<SectionCommand> commands_of_items(const EditorContext& context) {
  const auto duplicate = [context] {
    context.messages.check(context.document.duplicate_table(context.properties.section()));
  };
  const auto remove = [context] {
    context.messages.check(context.document.remove_table(context.properties.section()));
  };
  return {{tr("&Duplicate this section"), tr("Duplicate"), {}, duplicate},
          {tr("&Remove this section"), tr("Remove"), {}, remove},
          {tr("Move this section &up"), tr("Move up"), tr("Ctrl+Shift+Up"),
           [context] { move_section(context, -1); }},
          {tr("Move this section do&wn"), tr("Move down"), tr("Ctrl+Shift+Down"),
           [context] { move_section(context, 1); }}};
}

void add_all(QMenu& menu, const std::vector<SectionCommand>& commands) {
  for (const SectionCommand& command : commands)
    menu.addAction(command.name, command.shortcut, &menu, command.run);
}

}  // namespace

void connect_sections(const EditorContext& context) {
  QObject::connect(&context.view, &WorldView::picked, &context.window,
                   [context] { open_section_of_selection(context); });
  QObject::connect(&context.properties, &PropertiesPanel::section_menu_requested, &context.window,
                   [context](const QPoint& at) {
                     QMenu menu;
                     for (const SectionCommand& command : commands_of_any(context))
                       menu.addAction(command.short_name, command.run);
                     if (is_item(context.properties.section())) {
                       menu.addSeparator();
                       for (const SectionCommand& command : commands_of_items(context))
                         menu.addAction(command.short_name, command.run);
                     }
                     menu.exec(at);
                   });
}

void add_section_commands(QMenu& menu, const EditorContext& context) {
  add_all(menu, commands_of_any(context));
}

void add_world_commands(QMenu& menu, const EditorContext& context, LibraryPanel& library) {
  menu.addAction(tr("Add a &species …"), &library, [&library] { show_panel(library); });
  menu.addAction(tr("Add a s&catter layer"), &menu, [context] {
    context.messages.check(
        context.document.append_table({"scatter"}, "model = \"rock\"\ncount = 10\n"));
  });
  add_all(menu, commands_of_items(context));
  menu.addSeparator();
  menu.addAction(tr("Save section as &preset …"), &library,
                 [context, &library] { save_preset(context, library); });
  menu.addAction(tr("&Apply a preset to this section …"), &menu,
                 [context] { apply_preset(context); });
}

std::vector<CommandPalette::Command> field_commands(const EditorContext& context) {
  std::vector<CommandPalette::Command> commands;
  // A species and its scatter layer have the same name, and every species has a foliage.
  const auto add = [&](auto& self, const std::vector<world::WorldSection>& sections,
                       const QString& parent) -> void {
    for (const world::WorldSection& section : sections) {
      QString title = parent + to_qstring(section.title);
      if (section.kind == world::SectionKind::kScatter) title = tr("Scattered %1").arg(title);
      for (const world::WorldField& field : section.fields)
        commands.push_back({.name = title + ": " + to_qstring(field.label),
                            .hint = to_qstring(field.doc),
                            .run = [&properties = context.properties, path = section.path] {
                              properties.go_to(path);
                            }});
      self(self, section.parts, title + ", ");
    }
  };
  add(add, context.document.sections(), {});
  return commands;
}

}  // namespace psygen::editor
