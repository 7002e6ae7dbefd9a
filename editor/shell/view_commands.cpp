#include "editor/shell/view_commands.hpp"

#include <QAction>
#include <QActionGroup>
#include <QApplication>
#include <QClipboard>
#include <QFileDialog>
#include <QMenu>
#include <QMessageBox>
#include <algorithm>
#include <glm/trigonometric.hpp>

#include "engine/core/camera.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

// The command line `psygen picture` that renders the view's image, from a saved world file.
QString picture_command(app::Session& session, const std::filesystem::path& world_file,
                        const core::CameraPose& pose) {
  const scene::Scene& scene = session.scene();
  const world::World& world = scene.world();
  const double block_m = world.block_size_m();
  const core::WorldPosition& at = pose.position;
  const double surface_m = world::surface_height_m(world, at);
  const std::string_view preset = render::to_string(session.renderer().preset());
  QString file = QString::fromStdString(world_file.string());
  if (file.contains(' ')) file = "'" + file + "'";
  return QString(
             "psygen picture --world %1 --at=%2,%3 --height %4 --yaw %5 --pitch=%6 --preset %7 "
             "--error %8 --out picture.png")
      .arg(file)
      .arg(at.block.x * block_m + at.local.x, 0, 'f', 1)
      .arg(at.block.z * block_m + at.local.z, 0, 'f', 1)
      .arg(std::max(at.local.y - surface_m, 0.1), 0, 'f', 1)
      .arg(glm::degrees(pose.yaw), 0, 'f', 1)
      .arg(glm::degrees(pose.pitch), 0, 'f', 1)
      .arg(QString::fromUtf8(preset.data(), static_cast<int>(preset.size())))
      .arg(scene.settings().max_error_pixels, 0, 'g', 4);
}

}  // namespace

ViewCommands::ViewCommands(const EditorContext& context)
    : QObject(&context.window),
      window_(context.window),
      document_(context.document),
      view_(context.view),
      model_(context.model),
      properties_(context.properties),
      messages_(context.messages) {}

void ViewCommands::add_to_file_menu(QMenu& menu) {
  menu.addAction(tr("Save &image …"), tr("F12"), this, &ViewCommands::save_image);
  menu.addAction(tr("Copy command &line"), this, &ViewCommands::copy_command_line);
}

void ViewCommands::add_to_view_menu(QMenu& menu) {
  menu.addAction(tr("&Focus the selection"), tr("Ctrl+F"), this, [this] { view_.focus(); });
  menu.addAction(tr("Select &nothing"), tr("Ctrl+Shift+A"), this,
                 [this] { view_.select(std::nullopt); });
  menu.addSeparator();
  add_debug_views(menu);
  add_model_alone(menu);
  add_grids(menu);
}

void ViewCommands::add_to_world_menu(QMenu& menu, bool paused) {
  QAction* pause = menu.addAction(tr("Pause &synthesis"), tr("Ctrl+P"), this,
                                  [this](bool on) { view_.set_paused(on); });
  pause->setCheckable(true);
  pause->setChecked(paused);
}

void ViewCommands::add_to_help_menu(QMenu& menu) {
  menu.addAction(tr("&Keys and mouse"), tr("F1"), this, [this] {
    QMessageBox::information(
        &window_, tr("Keys and mouse"),
        tr("<table><tr><td>W A S D, E, Q &nbsp;<td>fly; Shift: faster; wheel: change the speed"
           "<tr><td>right button<td>look around<tr><td>click<td>select"
           "<tr><td>middle button<td>orbit the selection"
           "<tr><td>wheel<td>zoom to the selection<tr><td>Ctrl+F<td>look at the selection"
           "<tr><td>Ctrl+Shift+P<td>find any command or field</table>"));
  });
  menu.addAction(tr("&About"), this, &ViewCommands::show_about);
}

void ViewCommands::add_debug_views(QMenu& menu) {
  struct Entry {
    QString name;
    render::View view;
  };
  const Entry entries[] = {
      {tr("N&ormal"), render::View::kNormal},       {tr("&Levels"), render::View::kLevels},
      {tr("PLP l&ayers"), render::View::kLayers},   {tr("&Bounds"), render::View::kBounds},
      {tr("&Wireframe"), render::View::kWireframe}, {tr("&Missing"), render::View::kMissing},
      {tr("&Cache"), render::View::kCache}};
  auto* group = new QActionGroup(this);
  int key = 1;
  for (const Entry& entry : entries) {
    QAction* action =
        menu.addAction(entry.name, QString("Ctrl+%1").arg(key++), this, [this, view = entry.view] {
          if (view_.session() != nullptr) view_.session()->scene().input().view = view;
        });
    action->setCheckable(true);
    action->setChecked(entry.view == render::View::kNormal);
    group->addAction(action);
  }
}

void ViewCommands::add_model_alone(QMenu& menu) {
  QAction* alone = menu.addAction(tr("Model a&lone"), tr("Ctrl+M"), this, [this](bool on) {
    on ? model_.open(properties_.section()) : model_.close();
  });
  alone->setCheckable(true);
  const auto update = [this, alone] { alone->setChecked(model_.is_on()); };
  connect(&model_, &ModelView::switched, this, update);
  connect(alone, &QAction::triggered, this, update);  // also if there is no model to show
}

void ViewCommands::add_grids(QMenu& menu) {
  struct Entry {
    QString name;
    double spacing_m;
  };
  const Entry entries[] = {{tr("&None"), 0},
                           {tr("&1 m"), 1},
                           {tr("1&0 m"), 10},
                           {tr("10&0 m"), 100},
                           {tr("&Block borders"), GridOverlay::kBlocks}};
  QMenu* grids = menu.addMenu(tr("&Grid on the ground"));
  auto* group = new QActionGroup(this);
  for (const Entry& entry : entries) {
    QAction* action = grids->addAction(entry.name, this, [this, spacing_m = entry.spacing_m] {
      view_.grid().set_spacing(spacing_m);
    });
    action->setCheckable(true);
    action->setChecked(entry.spacing_m == 0);
    group->addAction(action);
  }
  menu.addAction(tr("Next grid"), tr("Ctrl+G"), this, [group] {
    const auto actions = group->actions();
    const auto now = actions.indexOf(group->checkedAction());
    actions[(now + 1) % actions.size()]->trigger();
  });
}

void ViewCommands::save_image() {
  if (view_.session() == nullptr) return messages_.show_message(tr("The view has no image."));
  const QString file = QFileDialog::getSaveFileName(&window_, tr("Save the image as"), "image.png",
                                                    tr("Images (*.png)"));
  if (!file.isEmpty() && messages_.check(view_.session()->save_picture(file.toStdString())))
    messages_.show_message(tr("Saved %1.").arg(file));
}

void ViewCommands::copy_command_line() {
  if (view_.session() == nullptr) return messages_.show_message(tr("The view has no image."));
  if (model_.is_on())
    return messages_.show_message(tr("A model alone has no command line. Go back to the world."));
  const QString line = picture_command(*view_.session(), document_.file(), view_.camera().pose());
  QApplication::clipboard()->setText(line);
  messages_.show_message(tr("Copied: %1").arg(line));
}

void ViewCommands::show_about() {
  QString device = tr("none");
  if (view_.session() != nullptr) {
    const auto& used = view_.session()->renderer().device();
    device = QString::fromStdString(used.name + ", " + used.driver);
  }
  QMessageBox::about(&window_, tr("About the psygen editor"),
                     tr("<b>psygen editor %1</b><br>Qt %2<br>Device: %3")
                         .arg(QApplication::applicationVersion(), qVersion(), device));
}

}  // namespace psygen::editor
