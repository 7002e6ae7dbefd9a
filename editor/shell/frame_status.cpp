#include "editor/shell/frame_status.hpp"

#include <QLabel>
#include <QStatusBar>
#include <QTimer>
#include <memory>

#include "editor/document/qt_text.hpp"
#include "editor/panels/water_text.hpp"
#include "editor/view/world_view.hpp"
#include "engine/core/camera.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

constexpr int kUpdateMs = 250, kSettledShownMs = 4000;
constexpr double kSmoothing = 0.1;

QString status_text(WorldView& view, double frame_ms) {
  if (view.session() == nullptr) return tr("No image");
  const scene::Scene& scene = view.session()->scene();
  return tr("%1 ms  ·  %2 triangles  ·  error %3 px  ·  %4 queued  ·  %5 m/s")
      .arg(frame_ms, 0, 'f', 1)
      .arg(count_text(scene.drawn().triangles))
      .arg(scene.quality().error_pixels, 0, 'f', 1)
      .arg(scene.meshes().outstanding())
      .arg(view.camera().speed_m_s(), 0, 'f', 0);
}

}  // namespace

void add_frame_status(QStatusBar& bar, WorldView& view) {
  auto* water = new QLabel;
  water->setObjectName("water");
  water->setAccessibleName(tr("Water under the pointer"));
  bar.addPermanentWidget(water);
  auto* label = new QLabel;
  bar.addPermanentWidget(label);
  struct Times {
    double frame_ms = 0;     // smoothed; 0 before the first frame
    double answered_ms = 0;  // from the last change to its first frame
  };
  const auto times = std::make_shared<Times>();
  QObject::connect(&view, &WorldView::drawn, label, [times](double ms) {
    times->frame_ms += (ms - times->frame_ms) * (times->frame_ms == 0 ? 1 : kSmoothing);
  });
  QObject::connect(&view, &WorldView::answered, label,
                   [times](double ms) { times->answered_ms = ms; });
  QObject::connect(&view, &WorldView::settled, label, [times, &bar](double ms) {
    bar.showMessage(tr("Updated in %1 s; fully detailed after %2 s.")
                        .arg(times->answered_ms * 1e-3, 0, 'f', 1)
                        .arg(ms * 1e-3, 0, 'f', 1),
                    kSettledShownMs);
  });
  auto* timer = new QTimer(label);
  QObject::connect(timer, &QTimer::timeout, label, [label, water, times, &view] {
    label->setText(status_text(view, times->frame_ms));
    water->setText(water_text(view.water_under_pointer()));
  });
  timer->start(kUpdateMs);
}

}  // namespace psygen::editor
