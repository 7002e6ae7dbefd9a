#include "editor/shell/section_commands.hpp"

#include <QApplication>
#include <QClipboard>
#include <QDir>
#include <QFileDialog>
#include <QMenu>

#include "editor/gallery/library_panel.hpp"
#include "editor/panels/field_row.hpp"
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

}  // namespace

SectionCommands::SectionCommands(const EditorContext& context, LibraryPanel& library)
    : QObject(&context.window),
      window_(context.window),
      document_(context.document),
      view_(context.view),
      properties_(context.properties),
      messages_(context.messages),
      library_(library) {
  connect_properties();
  connect(&view_, &WorldView::picked, this, &SectionCommands::open_section_of_selection);
}

void SectionCommands::connect_properties() {
  using Properties = PropertiesPanel;
  connect(&properties_, &Properties::change_requested, this,
          [this](const world::TextPath& path, const std::string& toml) {
            if (messages_.check(document_.set_value(path, toml))) return;
            properties_.show(document_.sections());  // shows the old value again
          });
  connect(&properties_, &Properties::reset_requested, this,
          [this](const world::TextPath& path) { messages_.check(document_.reset_value(path)); });
  connect(&properties_, &Properties::step_requested, this,
          [this](const world::TextPath& path, int steps) {
            messages_.check(document_.step_value(path, steps));
          });
  connect(&properties_, &Properties::randomise_requested, this, &SectionCommands::randomise);
  connect(&properties_, &Properties::copy_requested, this, &SectionCommands::copy);
  connect(&properties_, &Properties::paste_requested, this, &SectionCommands::paste);
  connect(&properties_, &Properties::section_reset_requested, this, &SectionCommands::reset);
  connect(&properties_, &Properties::section_menu_requested, this,
          &SectionCommands::show_context_menu);
  connect(&properties_, &Properties::row_created, this, [this](FieldRow* row) {
    row->set_locked(document_.locks().is_locked(row->field().path));
  });
  connect(&properties_, &Properties::lock_requested, this,
          [this](const world::TextPath& path, bool locked) {
            document_.locks().set_locked(path, locked);
          });
}

// The section of the model type, or of the terrain for the ground.
void SectionCommands::open_section_of_selection() {
  const Selection& selection = *view_.selection();
  const std::string_view name = view_.session()->scene().registry()[selection.model].name();
  const bool is_ground = selection.kind == query::HitKind::kGround;
  for (const world::WorldSection& section : document_.sections()) {
    if (section.title == name || (is_ground && section.kind == world::SectionKind::kTerrain))
      return properties_.go_to(section.path);
  }
}

void SectionCommands::add_to_edit_menu(QMenu& menu) {
  menu.addAction(tr("Randomise this section"), tr("Ctrl+R"), this,
                 [this] { randomise(properties_.section()); });
  menu.addAction(tr("Reset this section"), tr("Ctrl+Shift+0"), this,
                 [this] { reset(properties_.section()); });
  menu.addAction(tr("Copy this section"), tr("Ctrl+Shift+C"), this,
                 [this] { copy(properties_.section()); });
  menu.addAction(tr("Paste into this section"), tr("Ctrl+Shift+V"), this,
                 [this] { paste(properties_.section()); });
}

void SectionCommands::add_to_world_menu(QMenu& menu) {
  menu.addAction(tr("Add a &species …"), this, [this] { show_panel(library_); });
  menu.addAction(tr("Add a s&catter layer"), this, [this] {
    messages_.check(document_.append_table({"scatter"}, "model = \"rock\"\ncount = 10\n"));
  });
  menu.addAction(tr("&Duplicate this section"), this, [this] { duplicate(properties_.section()); });
  menu.addAction(tr("&Remove this section"), this, [this] { remove(properties_.section()); });
  menu.addAction(tr("Move this section &up"), tr("Ctrl+Shift+Up"), this,
                 [this] { move(properties_.section(), -1); });
  menu.addAction(tr("Move this section do&wn"), tr("Ctrl+Shift+Down"), this,
                 [this] { move(properties_.section(), 1); });
  menu.addSeparator();
  menu.addAction(tr("Save section as &preset …"), this, &SectionCommands::save_preset);
  menu.addAction(tr("&Apply a preset to this section …"), this, &SectionCommands::apply_preset);
}

std::vector<CommandPalette::Command> SectionCommands::field_commands() {
  std::vector<CommandPalette::Command> commands;
  // A species and its scatter layer have the same name, and every species has a foliage.
  const auto add = [&](auto& self, const std::vector<world::WorldSection>& sections,
                       const QString& parent) -> void {
    for (const world::WorldSection& section : sections) {
      QString title = parent + QString::fromStdString(section.title);
      if (section.kind == world::SectionKind::kScatter) title = tr("Scattered %1").arg(title);
      for (const world::WorldField& field : section.fields)
        commands.push_back({.name = title + ": " + QString::fromStdString(field.label),
                            .hint = QString::fromStdString(field.doc),
                            .run = [this, path = section.path] { properties_.go_to(path); }});
      self(self, section.parts, title + ", ");
    }
  };
  add(add, document_.sections(), {});
  return commands;
}

void SectionCommands::randomise(const world::TextPath& path) {
  messages_.check(document_.randomise(path, random_));
}

void SectionCommands::copy(const world::TextPath& path) {
  const auto text = document_.copy(path);
  if (!text) return messages_.show_message(QString::fromStdString(text.error().message));
  QApplication::clipboard()->setText(QString::fromStdString(*text));
  messages_.show_message(tr("Copied %1 as text.").arg(QString::fromStdString(path.text())));
}

void SectionCommands::paste(const world::TextPath& path) {
  messages_.check(document_.paste(path, QApplication::clipboard()->text().toStdString()));
}

void SectionCommands::reset(const world::TextPath& path) {
  messages_.check(document_.reset_section(path));
}

void SectionCommands::duplicate(const world::TextPath& path) {
  messages_.check(document_.duplicate_table(path));
}

void SectionCommands::remove(const world::TextPath& path) {
  messages_.check(document_.remove_table(path));
}

// The section stays chosen at its new place. The first and the last one stay where they are.
void SectionCommands::move(const world::TextPath& path, int by) {
  if (!is_item(path)) return messages_.show_message(tr("Only sections of a list can be moved."));
  const std::size_t from = path.back().index;
  const std::size_t count = world::item_count(document_.text(), path.parent());
  if (by < 0 ? from == 0 : from + 1 >= count) return;
  const std::size_t to = by < 0 ? from - 1 : from + 1;
  const std::string before = document_.text();
  // An edit that awaits confirmation has not moved the section yet.
  if (messages_.check(document_.move_table(path, to)) && document_.text() != before)
    properties_.go_to(path.parent().with(to));
}

void SectionCommands::save_preset() {
  const QString folder = QString::fromStdString(own_library_folder().string());
  QDir().mkpath(folder);
  const QString file = QFileDialog::getSaveFileName(
      &window_, tr("Save a preset"), folder + "/preset.toml", tr("Presets (*.toml)"));
  if (!file.isEmpty() &&
      messages_.check(document_.save_preset(properties_.section(), file.toStdString())))
    library_.reload();
}

void SectionCommands::apply_preset() {
  const QString file =
      QFileDialog::getOpenFileName(&window_, tr("Apply a preset"), {}, tr("Presets (*.toml)"));
  if (!file.isEmpty())
    messages_.check(document_.apply_preset(properties_.section(), file.toStdString()));
}

void SectionCommands::show_context_menu(const world::TextPath& path, const QPoint& at) {
  QMenu menu;
  menu.addAction(tr("Randomise"), this, [&] { randomise(path); });
  menu.addAction(tr("Reset"), this, [&] { reset(path); });
  menu.addAction(tr("Copy"), this, [&] { copy(path); });
  menu.addAction(tr("Paste"), this, [&] { paste(path); });
  if (is_item(path)) {
    menu.addSeparator();
    menu.addAction(tr("Duplicate"), this, [&] { duplicate(path); });
    menu.addAction(tr("Remove"), this, [&] { remove(path); });
    menu.addAction(tr("Move up"), this, [&] { move(path, -1); });
    menu.addAction(tr("Move down"), this, [&] { move(path, 1); });
  }
  menu.exec(at);
}

}  // namespace psygen::editor
