// Menus, toolbar and commands of the window.
#include <QActionGroup>
#include <QApplication>
#include <QClipboard>
#include <QDir>
#include <QDockWidget>
#include <QFileDialog>
#include <QInputDialog>
#include <QMenuBar>
#include <QMessageBox>
#include <QSettings>
#include <array>

#include "editor/gallery/library_panel.hpp"
#include "editor/gallery/model_view.hpp"
#include "editor/gallery/picture_tools.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/shell/command_line.hpp"
#include "editor/shell/command_palette.hpp"
#include "editor/shell/main_window.hpp"
#include "editor/shell/theme.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::editor {
namespace {

constexpr std::array kScales{80, 100, 125, 150, 200};

}  // namespace

void MainWindow::add_menus() {
  add_file_menu();
  add_edit_menu();
  add_view_menu();
  add_world_menu();
  add_tools_menu();
  add_flight_menu();
  add_help_menu();
}

void MainWindow::add_file_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  menu->addAction(tr("&New world"), QKeySequence(QKeySequence::New), this, [this] {
    if (may_discard()) tell(document_.make_new());
  });
  menu->addAction(tr("&Open …"), QKeySequence::Open, this, &MainWindow::choose_file);
  recent_menu_ = menu->addMenu(tr("Open &recent"));
  fill_recent_files();
  menu->addSeparator();
  menu->addAction(tr("&Save"), QKeySequence::Save, this, &MainWindow::save);
  menu->addAction(tr("Save &as …"), QKeySequence::SaveAs, this, &MainWindow::save_as);
  menu->addAction(tr("Show &changes …"), tr("Ctrl+D"), this, &MainWindow::show_diff);
  menu->addAction(tr("Re&vert to the saved file"), this, [this] { tell(document_.revert()); });
  menu->addSeparator();
  menu->addAction(tr("Save &picture …"), tr("F12"), this, [this] {
    if (view_->session() == nullptr) return say(tr("There is no picture."));
    const QString file = QFileDialog::getSaveFileName(this, tr("Save the picture as"),
                                                      "picture.png", tr("Pictures (*.png)"));
    if (!file.isEmpty() && tell(view_->session()->save_picture(file.toStdString())))
      say(tr("Saved %1.").arg(file));
  });
  menu->addAction(tr("Copy command &line"), this, [this] {
    if (view_->session() == nullptr) return say(tr("There is no picture."));
    if (model_->is_on()) return say(tr("Only pictures of the world have a command line."));
    const QString line =
        picture_command(*view_->session(), document_.file(), view_->camera().pose());
    QApplication::clipboard()->setText(line);
    say(tr("Copied: %1").arg(line));
  });
  pictures_->add_to_file_menu(*menu);
  menu->addSeparator();
  add_attach_action(menu);
  menu->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
}

void MainWindow::add_edit_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  QAction* undo = document_.undo_stack().createUndoAction(this, tr("&Undo"));
  undo->setShortcut(QKeySequence::Undo);
  QAction* redo = document_.undo_stack().createRedoAction(this, tr("&Redo"));
  redo->setShortcut(QKeySequence::Redo);
  menu->addActions({undo, redo});
  menu->addSeparator();
  menu->addAction(tr("Randomise this section"), tr("Ctrl+R"), this,
                  [this] { randomise(properties_->section()); });
  menu->addAction(tr("Reset this section"), tr("Ctrl+Shift+0"), this,
                  [this] { tell(document_.reset_section(properties_->section())); });
  menu->addAction(tr("Copy this section"), tr("Ctrl+Shift+C"), this,
                  [this] { copy_section(properties_->section()); });
  menu->addAction(tr("Paste into this section"), tr("Ctrl+Shift+V"), this,
                  [this] { paste_section(properties_->section()); });
  menu->addSeparator();
  menu->addAction(tr("Find a command or field …"), tr("Ctrl+Shift+P"), this, [this] {
    std::vector<CommandPalette::Command> commands;
    for (QAction* action : findChildren<QAction*>()) {
      if (action->text().isEmpty() || action->menu() != nullptr || !action->isEnabled()) continue;
      QString name = action->text();
      commands.push_back(
          {name.remove('&'), action->shortcut().toString(), [action] { action->trigger(); }});
    }
    // A species and its scatter have one name, and every species has a foliage.
    const auto add = [&](auto& self, const std::vector<world::WorldSection>& sections,
                         const QString& of) -> void {
      for (const world::WorldSection& section : sections) {
        QString title = of + QString::fromStdString(section.title);
        if (section.kind == world::SectionKind::kScatter) title = tr("Scattered %1").arg(title);
        for (const world::WorldField& field : section.fields)
          commands.push_back({title + ": " + QString::fromStdString(field.label),
                              QString::fromStdString(field.doc),
                              [this, path = section.path] { properties_->go_to(path); }});
        self(self, section.parts, title + ", ");
      }
    };
    add(add, document_.sections(), {});
    palette_->ask(std::move(commands));
  });
}

void MainWindow::add_view_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  menu->addAction(tr("&Focus the selection"), tr("Ctrl+F"), this, [this] { view_->focus(); });
  menu->addAction(tr("Select &nothing"), tr("Ctrl+Shift+A"), this,
                  [this] { view_->select(std::nullopt); });
  menu->addSeparator();
  auto* views = new QActionGroup(this);
  const std::pair<QString, render::View> kinds[] = {
      {tr("&Picture"), render::View::kNormal},      {tr("&Levels"), render::View::kLevels},
      {tr("PLP l&ayers"), render::View::kLayers},   {tr("&Bounds"), render::View::kBounds},
      {tr("&Wireframe"), render::View::kWireframe}, {tr("&Missing"), render::View::kMissing},
      {tr("&Cache"), render::View::kCache}};
  int key = 1;
  for (const auto& [name, kind] : kinds) {
    QAction* action =
        menu->addAction(name, QString("Ctrl+%1").arg(key++), this, [this, kind = kind] {
          if (view_->session() != nullptr) view_->session()->scene().input().view = kind;
        });
    action->setCheckable(true);
    action->setChecked(kind == render::View::kNormal);
    views->addAction(action);
  }
  add_model_action(*menu);
  add_grid_menu(*menu);
  pictures_->add_to_view_menu(*menu);
  menu->addSeparator();
  panels_menu_ = menu->addMenu(tr("Pan&els"));
  for (QDockWidget* dock : findChildren<QDockWidget*>())
    panels_menu_->addAction(dock->toggleViewAction());
  menu->addAction(tr("&Reset the layout"), this, [this] {
    restoreState(first_layout_);
    Q_EMIT model_->switched();
  });
  QMenu* themes = menu->addMenu(tr("&Theme"));
  themes->addAction(tr("&Dark"), this, [this] { set_theme("dark"); });
  themes->addAction(tr("&Light"), this, [this] { set_theme("light"); });
  QMenu* scales = menu->addMenu(tr("&Size of text"));
  for (const int percent : kScales)
    scales->addAction(QString("%1 %").arg(percent), this, [this, percent] { set_scale(percent); });
}

void MainWindow::add_world_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&World"));
  menu->addAction(tr("Add a &species …"), this, [this] {
    QDockWidget* library = findChild<QDockWidget*>("library");
    library->show();
    library->raise();
  });
  menu->addAction(tr("Add a s&catter"), this, [this] {
    tell(document_.append_table({"scatter"}, "model = \"rock\"\ncount = 10\n"));
  });
  menu->addAction(tr("&Duplicate this section"), this,
                  [this] { tell(document_.duplicate_table(properties_->section())); });
  menu->addAction(tr("&Remove this section"), this,
                  [this] { tell(document_.remove_table(properties_->section())); });
  menu->addSeparator();
  menu->addAction(tr("Save section as &preset …"), this, [this] {
    const QString folder = QString::fromStdString(own_library_folder().string());
    QDir().mkpath(folder);
    const QString file = QFileDialog::getSaveFileName(
        this, tr("Save a preset"), folder + "/preset.toml", tr("Presets (*.toml)"));
    if (!file.isEmpty() && tell(document_.save_preset(properties_->section(), file.toStdString())))
      pictures_->library().reload();
  });
  menu->addAction(tr("&Apply a preset to this section …"), this, [this] {
    const QString file =
        QFileDialog::getOpenFileName(this, tr("Apply a preset"), {}, tr("Presets (*.toml)"));
    if (!file.isEmpty()) tell(document_.apply_preset(properties_->section(), file.toStdString()));
  });
  menu->addSeparator();
  pictures_->add_to_world_menu(*menu);
  QAction* pause = menu->addAction(tr("Pause &synthesis"), tr("Ctrl+P"), this,
                                   [this](bool on) { view_->set_paused(on); });
  pause->setCheckable(true);
  pause->setChecked(options_.safe);
}

void MainWindow::add_help_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Help"));
  menu->addAction(tr("&Keys and mouse"), tr("F1"), this, [this] {
    QMessageBox::information(
        this, tr("Keys and mouse"),
        tr("<table><tr><td>W A S D, E, Q &nbsp;<td>fly; Shift faster, wheel: the speed"
           "<tr><td>right button<td>look around<tr><td>click<td>select"
           "<tr><td>middle button<td>turn around the selection"
           "<tr><td>wheel<td>towards the selection<tr><td>Ctrl+F<td>look at the selection"
           "<tr><td>Ctrl+Shift+P<td>find any command or field</table>"));
  });
  menu->addAction(tr("&About"), this, [this] {
    const QString device =
        view_->session() == nullptr
            ? tr("none")
            : QString::fromStdString(view_->session()->renderer().device().name + ", " +
                                     view_->session()->renderer().device().driver);
    QMessageBox::about(this, tr("About the psygen editor"),
                       tr("<b>psygen editor %1</b><br>Qt %2<br>Device: %3")
                           .arg(QApplication::applicationVersion(), qVersion(), device));
  });
}

void MainWindow::set_theme(const QString& name) {
  apply_theme(name);
  QSettings().setValue("theme", name);
}

void MainWindow::set_scale(int percent) {
  apply_scale(percent);
  QSettings().setValue("scale", percent);
}

}  // namespace psygen::editor
