#include "editor/shell/frame_status.hpp"

#include <QLocale>
#include <QStatusBar>

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

}  // namespace

FrameStatus::FrameStatus(QStatusBar& bar, WorldView& view) : view_(view) {
  bar.addPermanentWidget(this);
  connect(&view_, &WorldView::drawn, this,
          [this](double ms) { frame_ms_ += (ms - frame_ms_) * (frame_ms_ == 0 ? 1 : kSmoothing); });
  connect(&view_, &WorldView::answered, this, [this](double ms) { answered_ms_ = ms; });
  connect(&view_, &WorldView::settled, this, [this, &bar](double ms) {
    bar.showMessage(tr("Updated in %1 s; fully detailed after %2 s.")
                        .arg(answered_ms_ * 1e-3, 0, 'f', 1)
                        .arg(ms * 1e-3, 0, 'f', 1),
                    kSettledShownMs);
  });
  connect(&timer_, &QTimer::timeout, this, &FrameStatus::update_text);
  timer_.start(kUpdateMs);
}

void FrameStatus::update_text() {
  if (view_.session() == nullptr) return setText(tr("No image"));
  const scene::Scene& scene = view_.session()->scene();
  setText(
      tr("%1 ms  ·  %2 triangles  ·  error %3 px  ·  %4 queued  ·  %5 m/s")
          .arg(frame_ms_, 0, 'f', 1)
          .arg(QLocale(QLocale::English).toString(static_cast<qulonglong>(scene.drawn().triangles)))
          .arg(scene.quality().error_pixels, 0, 'f', 1)
          .arg(scene.meshes().outstanding())
          .arg(view_.camera().speed_m_s(), 0, 'f', 0));
}

}  // namespace psygen::editor
