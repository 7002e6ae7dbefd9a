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

#include "editor/document/qt_text.hpp"
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
  const core::WorldPosition& at = pose.position;
  const glm::dvec2 at_m = world.metres(at);
  const double surface_m = world::surface_height_m(world, at);
  const std::string_view preset = render::to_string(session.renderer().preset());
  QString file = to_qstring(world_file.string());
  if (file.contains(' ')) file = "'" + file + "'";
  return QString(
             "psygen picture --world %1 --at=%2,%3 --height %4 --yaw %5 --pitch=%6 --preset %7 "
             "--error %8 --out picture.png")
      .arg(file)
      .arg(at_m.x, 0, 'f', 1)
      .arg(at_m.y, 0, 'f', 1)
      .arg(std::max(at.local.y - surface_m, 0.1), 0, 'f', 1)
      .arg(glm::degrees(pose.yaw), 0, 'f', 1)
      .arg(glm::degrees(pose.pitch), 0, 'f', 1)
      .arg(to_qstring(preset))
      .arg(scene.settings().max_error_pixels, 0, 'g', 4);
}

void save_image(const EditorContext& context) {
  if (context.view.session() == nullptr)
    return context.messages.show_message(tr("The view has no image."));
  const QString file = QFileDialog::getSaveFileName(&context.window, tr("Save the image as"),
                                                    "image.png", tr("Images (*.png)"));
  if (!file.isEmpty() &&
      context.messages.check(context.view.session()->save_picture(file.toStdString())))
    context.messages.show_message(tr("Saved %1.").arg(file));
}

void copy_command_line(const EditorContext& context) {
  if (context.view.session() == nullptr)
    return context.messages.show_message(tr("The view has no image."));
  if (context.model.is_on())
    return context.messages.show_message(
        tr("A model alone has no command line. Go back to the world."));
  const QString line = picture_command(*context.view.session(), context.document.file(),
                                       context.view.camera().pose());
  QApplication::clipboard()->setText(line);
  context.messages.show_message(tr("Copied: %1").arg(line));
}

void show_about(const EditorContext& context) {
  QString device = tr("none");
  if (context.view.session() != nullptr) {
    const auto& used = context.view.session()->renderer().device();
    device = to_qstring(used.name + ", " + used.driver);
  }
  QMessageBox::about(&context.window, tr("About the psygen editor"),
                     tr("<b>psygen editor %1</b><br>Qt %2<br>Device: %3")
                         .arg(QApplication::applicationVersion(), qVersion(), device));
}

void add_debug_views(QMenu& menu, const EditorContext& context) {
  struct Entry {
    QString name;
    render::View view;
  };
  const Entry entries[] = {
      {tr("N&ormal"), render::View::kNormal},       {tr("&Levels"), render::View::kLevels},
      {tr("PLP l&ayers"), render::View::kLayers},   {tr("&Bounds"), render::View::kBounds},
      {tr("&Wireframe"), render::View::kWireframe}, {tr("&Missing"), render::View::kMissing},
      {tr("&Cache"), render::View::kCache}};
  auto* group = new QActionGroup(&context.window);
  int key = 1;
  for (const Entry& entry : entries) {
    QAction* action = menu.addAction(entry.name, QString("Ctrl+%1").arg(key++), &context.window,
                                     [context, view = entry.view] {
                                       if (context.view.session() != nullptr)
                                         context.view.session()->scene().input().view = view;
                                     });
    action->setCheckable(true);
    action->setChecked(entry.view == render::View::kNormal);
    group->addAction(action);
  }
}

void add_model_alone(QMenu& menu, const EditorContext& context) {
  QAction* alone =
      menu.addAction(tr("Model a&lone"), tr("Ctrl+M"), &context.window, [context](bool on) {
        on ? context.model.open(context.properties.section()) : context.model.close();
      });
  alone->setCheckable(true);
  const auto update = [context, alone] { alone->setChecked(context.model.is_on()); };
  QObject::connect(&context.model, &ModelView::switched, &context.window, update);
  QObject::connect(alone, &QAction::triggered, &context.window,
                   update);  // also if there is no model to show
}

void add_grids(QMenu& menu, const EditorContext& context) {
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
  auto* group = new QActionGroup(&context.window);
  for (const Entry& entry : entries) {
    QAction* action = grids->addAction(
        entry.name, &context.window,
        [context, spacing_m = entry.spacing_m] { context.view.grid().set_spacing(spacing_m); });
    action->setCheckable(true);
    action->setChecked(entry.spacing_m == 0);
    group->addAction(action);
  }
  menu.addAction(tr("Next grid"), tr("Ctrl+G"), &context.window, [group] {
    const auto actions = group->actions();
    const auto now = actions.indexOf(group->checkedAction());
    actions[(now + 1) % actions.size()]->trigger();
  });
}

void add_rivers(QMenu& menu, const EditorContext& context) {
  QAction* rivers =
      menu.addAction(tr("River net&work"), tr("Ctrl+J"), &context.window, [context](bool on) {
        context.view.rivers().set_on(on);
        if (on && context.document.world().network() == nullptr)
          context.messages.show_message(
              tr("The world has no river network. Add the section [rivers] to its file."));
      });
  rivers->setCheckable(true);
}

}  // namespace

void add_image_commands(QMenu& menu, const EditorContext& context) {
  menu.addAction(tr("Save &image …"), tr("F12"), &context.window,
                 [context] { save_image(context); });
  menu.addAction(tr("Copy command &line"), &context.window,
                 [context] { copy_command_line(context); });
}

void add_view_commands(QMenu& menu, const EditorContext& context) {
  menu.addAction(tr("&Focus the selection"), tr("Ctrl+F"), &context.window,
                 [context] { context.view.focus(); });
  menu.addAction(tr("Select &nothing"), tr("Ctrl+Shift+A"), &context.window,
                 [context] { context.view.select(std::nullopt); });
  menu.addSeparator();
  add_debug_views(menu, context);
  add_model_alone(menu, context);
  add_grids(menu, context);
  add_rivers(menu, context);
}

void add_pause_command(QMenu& menu, const EditorContext& context, bool paused) {
  QAction* pause = menu.addAction(tr("Pause &synthesis"), tr("Ctrl+P"), &context.window,
                                  [context](bool on) { context.view.set_paused(on); });
  pause->setCheckable(true);
  pause->setChecked(paused);
}

void add_help_commands(QMenu& menu, const EditorContext& context) {
  menu.addAction(tr("&Keys and mouse"), tr("F1"), &context.window, [context] {
    QMessageBox::information(
        &context.window, tr("Keys and mouse"),
        tr("<table><tr><td>W A S D, E, Q &nbsp;<td>fly; Shift: faster; wheel: change the speed"
           "<tr><td>right button<td>look around<tr><td>click<td>select"
           "<tr><td>middle button<td>orbit the selection"
           "<tr><td>wheel<td>zoom to the selection<tr><td>Ctrl+F<td>look at the selection"
           "<tr><td>Ctrl+Shift+P<td>find any command or field</table>"));
  });
  menu.addAction(tr("&About"), &context.window, [context] { show_about(context); });
}

}  // namespace psygen::editor
