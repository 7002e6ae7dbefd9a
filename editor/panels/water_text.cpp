#include "editor/panels/water_text.hpp"

#include <glm/geometric.hpp>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

// Two digits for brooks, none after the point for rivers.
QString discharge_text(double m3_s) {
  return m3_s < 10 ? kEnglish.toString(m3_s, 'g', 2) : kEnglish.toString(m3_s, 'f', 0);
}

}  // namespace

QString water_text(const world::WaterPoint& water) {
  if (water.is_dry()) return {};
  const QString name = water.body == world::kSea ? tr("Sea")
                       : water.discharge_m3_s    ? tr("River")
                                                 : tr("Lake");
  QString text = tr("%1: surface %2 m, %3 m deep")
                     .arg(name)
                     .arg(water.surface_m, 0, 'f', 1)
                     .arg(water.depth_m, 0, 'f', 1);
  if (!water.discharge_m3_s) return text;
  return text + tr(", %1 m/s, %2 m³/s")
                    .arg(double{glm::length(water.flow_m_s)}, 0, 'f', 1)
                    .arg(discharge_text(*water.discharge_m3_s));
}

}  // namespace psygen::editor
