#include "editor/panels/selection_panel.hpp"

#include <QPlainTextEdit>

#include "editor/document/qt_text.hpp"
#include "editor/panels/water_text.hpp"
#include "editor/view/world_view.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

QString parameters_text(const models::ModelType& type, const models::Parameters& p) {
  QString text;
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const QString value = specs[i].type == models::ParameterType::kInteger
                              ? QString::number(static_cast<quint64>(p.integer(i)))
                              : kEnglish.toString(p.real(i), 'g', 5);
    text += QString("%1 = %2\n").arg(to_qstring(specs[i].name), value);
  }
  return text;
}

QString describe(const Selection& selection, const scene::Scene& scene) {
  const models::ModelType& type = scene.registry()[selection.model];
  const models::Parameters& p = selection.parameters;
  QString text = to_qstring(type.name());
  if (selection.kind == query::HitKind::kModel) text += QString(" #%1").arg(selection.index);
  text += tr(", block (%1, %2)\n").arg(selection.block.x).arg(selection.block.z);
  text += tr("at %1, %2, %3 m; %4 m away\n\n")
              .arg(selection.at.local.x, 0, 'f', 1)
              .arg(selection.at.local.y, 0, 'f', 1)
              .arg(selection.at.local.z, 0, 'f', 1)
              .arg(selection.distance_m, 0, 'f', 1);
  if (selection.kind == query::HitKind::kGround) {
    const QString water = water_text(world::water_at(scene.world(), selection.at));
    if (!water.isEmpty()) text += water + "\n\n";
  }
  const int levels = type.level_count_of(p);
  text += tr("Level of detail: triangles, error, predicted time\n");
  for (int level = 0; level < levels; ++level) {
    const models::MeshSize size = type.mesh_size(p, level);
    text += tr("%1: %2, %3 m, %4 µs\n")
                .arg(level)
                .arg(count_text(size.triangle_count()))
                .arg(type.level_error_m(p, level), 0, 'g', 3)
                .arg(scene.meshes().costs().predict(selection.model, p, level) * 1e6, 0, 'f', 1);
  }
  return text + "\n" + parameters_text(type, p);
}

}  // namespace

QWidget* make_selection_panel(WorldView& view) {
  auto* panel = new QPlainTextEdit;
  panel->setReadOnly(true);
  panel->setAccessibleName(tr("Selected model or ground"));
  panel->setPlaceholderText(tr("Click on a tree, a rock or the ground."));
  panel->setFrameShape(QFrame::NoFrame);
  QObject::connect(&view, &WorldView::selected, panel, [panel, &view] {
    if (!view.selection()) return panel->clear();
    panel->setPlainText(describe(*view.selection(), view.session()->scene()));
  });
  return panel;
}

}  // namespace psygen::editor
