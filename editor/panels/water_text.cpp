#include "editor/panels/water_text.hpp"

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

QString name_of(WaterKind kind) {
  switch (kind) {
    case WaterKind::kSea:
      return tr("Sea");
    case WaterKind::kLake:
      return tr("Lake");
    case WaterKind::kRiver:
      return tr("River");
  }
  return {};
}

// Two digits for brooks, none after the point for rivers.
QString discharge_text(double m3_s) {
  return m3_s < 10 ? kEnglish.toString(m3_s, 'g', 2) : kEnglish.toString(m3_s, 'f', 0);
}

}  // namespace

QString water_text(const WaterFacts& water) {
  QString text = tr("%1: surface %2 m, %3 m deep")
                     .arg(name_of(water.kind))
                     .arg(water.surface_m, 0, 'f', 1)
                     .arg(water.depth_m, 0, 'f', 1);
  if (water.kind != WaterKind::kRiver) return text;
  return text + tr(", %1 m/s, %2 m³/s")
                    .arg(water.speed_m_s, 0, 'f', 1)
                    .arg(discharge_text(water.discharge_m3_s));
}

}  // namespace psygen::editor
