#include "editor/panels/cache_map.hpp"

#include <QComboBox>
#include <QHelpEvent>
#include <QLabel>
#include <QPainter>
#include <QTimer>
#include <QToolTip>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <algorithm>
#include <array>
#include <cmath>

#include "ecs/ecs.hpp"
#include "editor/document/qt_text.hpp"
#include "editor/view/world_view.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr int kMapUpdateMs = 250;
constexpr int kPictureMarginPx = 128;
constexpr double kMinRadiusM = 100, kMaxRadiusM = 30'000;
constexpr double kOldestPower = 3;  // log10 of seconds: older meshes are blue
const QColor kNotLoaded(90, 90, 96), kFailed(190, 60, 190), kOutdated(230, 150, 40),
    kQueued(225, 205, 70), kInView(86, 176, 92), kOutOfView(70, 110, 150);

// From blue over green and yellow to red, for 0 … 1.
QColor heat(double share) {
  return QColor::fromHsvF(static_cast<float>(0.66 * (1 - std::clamp(share, 0.0, 1.0))), 0.75F,
                          0.85F);
}

QString swatch(const QColor& colour, const QString& words) {
  return QString("<font color=%1>■</font>&nbsp;%2 ").arg(colour.name(), words);
}

// The ends and the middle of heat().
QString scale_text(const QString& least, const QString& middle, const QString& most) {
  return swatch(heat(0), least) + swatch(heat(0.5), middle) + swatch(heat(1), most);
}

QString legend_text(MapColour colour) {
  const auto words = [](const char* text) { return tr(text).replace(' ', "&nbsp;"); };
  switch (colour) {
    case MapColour::kState:
      return swatch(kInView, words("in view")) + swatch(kOutOfView, words("out of view")) +
             swatch(kQueued, words("queued")) + swatch(kOutdated, words("outdated mesh")) +
             swatch(kNotLoaded, words("not loaded")) + swatch(kFailed, words("failed"));
    case MapColour::kLevel:
      return scale_text(words("level 8"), words("4"), words("0, finest"));
    case MapColour::kLayer:
      return scale_text(words("layer 24"), words("12"), words("0, first"));
    case MapColour::kCost:
      return scale_text(words("1 µs"), words("30 µs"), words("1 ms"));
    case MapColour::kAge:
      return scale_text(words("1000 s"), words("30 s"), words("new")) +
             swatch(kNotLoaded, words("no mesh"));
  }
  return {};
}

// The colours of discharges, shores and divides.
QString rivers_text() {
  const auto line = [](const glm::vec3& colour, const QString& words) {
    return swatch(QColor::fromRgbF(colour.x, colour.y, colour.z), words);
  };
  QString text = "<br>";
  for (int px = 1; px <= kMaxRiverPx; ++px)
    text += line(river_colour(px), tr("%1&nbsp;m³/s").arg(usual_discharge_m3_s(px)));
  return text + line(kShoreColour, tr("shore")) + line(kDivideColour, tr("divide"));
}

}  // namespace

CacheMap::CacheMap(QWidget* parent) : QWidget(parent) {
  setMinimumSize(160, 160);
  setAccessibleName(tr("Map of the cache around the camera"));
  setToolTip(" ");  // replaced by tool_tip_of() in event()
}

void CacheMap::set_colour(MapColour colour) {
  colour_ = colour;
  update();
}

void CacheMap::set_radius_m(double radius_m) {
  radius_m_ = std::clamp(radius_m, kMinRadiusM, kMaxRadiusM);
  update();
}

void CacheMap::note(const scene::Scene& scene) {
  std::unordered_map<std::uint64_t, KnownMesh> known;
  scene.entities().each<const scene::QuadtreeNode, const scene::Mesh, const scene::MeshDemand>(
      [&](std::span<const ecs::Entity> entities, std::span<const scene::QuadtreeNode>,
          std::span<const scene::Mesh> meshes, std::span<const scene::MeshDemand> demands) {
        for (std::size_t i = 0; i < entities.size(); ++i) {
          if (demands[i].drawn_level == scene::kNoLevel) continue;
          const std::uint64_t owner = scene::owner_of(entities[i]);
          const auto before = known_.find(owner);
          const bool same = before != known_.end() && before->second.mesh == meshes[i].handle;
          known[owner] = same ? before->second : KnownMesh{meshes[i].handle, scene.clock().real_s};
        }
      });
  known_ = std::move(known);
}

void CacheMap::show(const scene::Scene& scene) {
  cells_.clear();
  const core::WorldPosition& camera = scene.camera().pose.position;
  const double block_m = scene.world().block_size_m();
  yaw_ = scene.camera().pose.yaw;
  fov_ = 2 * std::atan(std::tan(double{scene.camera().projection.vertical_fov} / 2) *
                       double{scene.camera().projection.aspect});
  scene.entities()
      .each<const scene::QuadtreeNode, const scene::Visibility, const scene::MissingMeshes,
            const scene::MeshSource, const scene::MeshDemand>(
          [&](std::span<const ecs::Entity> entities, std::span<const scene::QuadtreeNode> nodes,
              std::span<const scene::Visibility> seen,
              std::span<const scene::MissingMeshes> lacking,
              std::span<const scene::MeshSource> sources,
              std::span<const scene::MeshDemand> demands) {
            for (std::size_t i = 0; i < nodes.size(); ++i) {
              Cell cell;
              cell.at = nodes[i].at;
              cell.size_m = block_m * static_cast<double>(1U << cell.at.level);
              const glm::dvec3 corner =
                  core::offset_m(visibility::corner_block(cell.at), camera, block_m);
              cell.x_m = corner.x;
              cell.z_m = corner.z;
              const scene::MeshDemand& demand = demands[i];
              cell.in_view = seen[i].in_view != 0;
              cell.drawn = demand.drawn_level != scene::kNoLevel;
              cell.stale = demand.stale;
              cell.requested = demand.requested_level != scene::kNoLevel;
              cell.failed = demand.failed_levels != 0;
              cell.level_drawn = demand.drawn_level;
              cell.layer = seen[i].layer;
              cell.deadline_s = double{seen[i].deadline_s};
              cell.lacking = lacking[i].meshes;
              cell.cost_s = scene.meshes().costs().predict(sources[i].model, sources[i].parameters,
                                                           sources[i].first_level);
              const auto known = known_.find(scene::owner_of(entities[i]));
              if (known != known_.end()) cell.age_s = scene.clock().real_s - known->second.since_s;
              cells_.push_back(cell);
            }
          });
  std::ranges::sort(cells_, std::greater{}, [](const Cell& cell) { return cell.at.level; });
  update();
}

void CacheMap::show_cells(std::vector<Cell> cells, double yaw, double horizontal_fov) {
  cells_ = std::move(cells);
  yaw_ = yaw;
  fov_ = horizontal_fov;
  update();
}

void CacheMap::show_rivers(std::shared_ptr<const RiverMap> rivers,
                           const core::WorldPosition& camera, double block_m) {
  rivers_ = std::move(rivers);
  if (rivers_ != nullptr) rivers_from_camera_m_ = core::offset_m(rivers_->corner, camera, block_m);
  update();
}

double CacheMap::pixels_per_m() const {
  return std::min(width(), height()) / (2 * radius_m_);
}

QColor CacheMap::colour_of(const Cell& cell) const {
  switch (colour_) {
    case MapColour::kLevel:
      return heat(1 - cell.at.level / 8.0);
    case MapColour::kLayer:
      return heat(1 - cell.layer / 24.0);
    case MapColour::kCost:
      return heat(std::log10(std::max(cell.cost_s * 1e6, 1.0)) / 3);
    case MapColour::kAge:
      if (cell.age_s < 0) return kNotLoaded;
      return heat(1 - std::log10(1 + cell.age_s) / kOldestPower);
    case MapColour::kState:
      break;
  }
  if (cell.failed) return kFailed;
  if (cell.stale) return kOutdated;
  if (cell.requested || (cell.in_view && cell.lacking > 0)) return kQueued;
  if (!cell.drawn) return kNotLoaded;
  return cell.in_view ? kInView : kOutOfView;
}

void CacheMap::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  if (cells_.empty()) {
    painter.drawText(rect(), Qt::AlignCenter, tr("No nodes are loaded."));
    return;
  }
  const double scale = pixels_per_m();
  painter.translate(width() / 2.0, height() / 2.0);
  for (const Cell& cell : cells_) {
    const QRectF place(cell.x_m * scale, cell.z_m * scale, cell.size_m * scale,
                       cell.size_m * scale);
    painter.fillRect(place.adjusted(0.5, 0.5, -0.5, -0.5), colour_of(cell));
  }
  if (rivers_ != nullptr) paint_rivers(painter);
  // The camera, its view, and a scale.
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(Qt::white, 1.5));
  const double length = std::min(width(), height());
  for (const double side : {-0.5, 0.5}) {
    const double angle = yaw_ + side * fov_;
    painter.drawLine(QPointF(0, 0), QPointF(std::sin(angle), -std::cos(angle)) * length);
  }
  painter.setBrush(Qt::white);
  painter.drawEllipse(QPointF(0, 0), 3, 3);
  const double bar_m = std::pow(10.0, std::floor(std::log10(radius_m_)));
  const QPointF left(-width() / 2.0 + 8, height() / 2.0 - 8);
  painter.setPen(QPen(palette().color(QPalette::Text), 2));
  painter.drawLine(left, left + QPointF(bar_m * scale, 0));
  painter.drawText(left - QPointF(0, 5), tr("%1 m").arg(bar_m));
}

// The origin of the painter is the camera. A shade leaves lines readable on all colours of nodes.
void CacheMap::paint_rivers(QPainter& painter) {
  const QPointF low(-width() / 2.0, -height() / 2.0), margin(kPictureMarginPx, kPictureMarginPx);
  painter.fillRect(QRectF(low, size()), QColor(12, 20, 34, 150));
  const QPointF corner = QPointF(rivers_from_camera_m_.x, rivers_from_camera_m_.z) * pixels_per_m();
  const QPointF moved = corner - picture_.corner;
  const QSize wide = size() + QSize(2 * kPictureMarginPx, 2 * kPictureMarginPx);
  if (picture_.rivers != rivers_ || picture_.scale != pixels_per_m() ||
      picture_.pixels.size() != wide * devicePixelRatioF() ||
      std::max(std::abs(moved.x()), std::abs(moved.y())) > kPictureMarginPx)
    draw_rivers(corner, wide);
  painter.drawPixmap(low - margin + corner - picture_.corner, picture_.pixels);
}

// Lines of one look are drawn together. Takes milliseconds.
void CacheMap::draw_rivers(QPointF corner, QSize wide) {
  const double scale = pixels_per_m();
  picture_ = {rivers_, scale, corner, QPixmap(wide * devicePixelRatioF())};
  picture_.pixels.setDevicePixelRatio(devicePixelRatioF());
  picture_.pixels.fill(Qt::transparent);
  QPainter painter(&picture_.pixels);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.translate(corner + QPointF(wide.width() / 2.0, wide.height() / 2.0));
  const auto draw = [&](const std::vector<RiverMap::Line>& lines, const glm::vec3& colour,
                        double width_px, Qt::PenStyle style = Qt::SolidLine) {
    std::vector<QLineF> shown;
    for (const auto& [from, to] : lines)
      shown.emplace_back(QPointF(from.x, from.z) * scale, QPointF(to.x, to.z) * scale);
    painter.setPen(
        QPen(QColor::fromRgbF(colour.x, colour.y, colour.z), width_px, style, Qt::RoundCap));
    painter.drawLines(shown.data(), static_cast<int>(shown.size()));
  };
  draw(rivers_->divides, kDivideColour, 1, Qt::DotLine);
  draw(rivers_->shores, kShoreColour, 1);
  for (int px = 1; px <= kMaxRiverPx; ++px) {
    std::vector<RiverMap::Line> lines;
    for (const RiverMap::Channel& channel : rivers_->channels)
      if (channel.width_px == px) lines.push_back(channel.line);
    draw(lines, river_colour(px), 0.6 * px + 0.2);
  }
}

const CacheMap::Cell* CacheMap::cell_at(QPointF place) const {
  const double x = (place.x() - width() / 2.0) / pixels_per_m();
  const double z = (place.y() - height() / 2.0) / pixels_per_m();
  const Cell* found = nullptr;  // the finest one, which is the last
  for (const Cell& cell : cells_) {
    if (x >= cell.x_m && x < cell.x_m + cell.size_m && z >= cell.z_m && z < cell.z_m + cell.size_m)
      found = &cell;
  }
  return found;
}

QString CacheMap::tool_tip_of(const Cell& cell) const {
  QString text = tr("Node of level %1 at (%2, %3), %4 m wide.\n")
                     .arg(cell.at.level)
                     .arg(cell.at.coord.x)
                     .arg(cell.at.coord.z)
                     .arg(cell.size_m, 0, 'f', 0);
  if (cell.failed) text += tr("Synthesis of a mesh failed.\n");
  if (!cell.drawn) text += tr("Terrain not loaded.\n");
  if (cell.drawn && cell.stale) text += tr("Outdated terrain, until the new mesh is ready.\n");
  if (cell.drawn && !cell.stale) text += tr("Terrain loaded.\n");
  if (cell.requested) text += tr("A mesh is queued or in synthesis.\n");
  if (cell.lacking != UINT32_MAX && cell.lacking > 0)
    text += tr("%1 meshes are missing.\n").arg(cell.lacking);
  text += cell.in_view ? tr("In view, PLP layer %1.\n").arg(cell.layer)
          : std::isfinite(cell.deadline_s)
              ? tr("Out of view, expected in view in %1 s.\n").arg(cell.deadline_s, 0, 'f', 1)
              : tr("Out of view, PLP layer %1.\n").arg(cell.layer);
  if (cell.age_s >= 0) text += tr("Mesh built %1 s ago.\n").arg(cell.age_s, 0, 'f', 1);
  return text +
         tr("Predicted synthesis time of the terrain: %1 µs.").arg(cell.cost_s * 1e6, 0, 'f', 0);
}

bool CacheMap::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const Cell* cell = cell_at(help->pos());
  QToolTip::showText(help->globalPos(),
                     cell != nullptr
                         ? tool_tip_of(*cell)
                         : tr("No node: too far from the camera, or outside the world."),
                     this);
  return true;
}

void CacheMap::wheelEvent(QWheelEvent* event) {
  set_radius_m(radius_m_ * std::pow(0.8, event->angleDelta().y() / 120.0));
  event->accept();
}

QWidget* make_cache_map_panel(WorldView& view) {
  auto* panel = new QWidget;
  auto* timer = new QTimer(panel);
  auto* map = new CacheMap;
  auto* colours = new QComboBox;
  colours->addItems({tr("State"), tr("Level"), tr("PLP layer"), tr("Cost"), tr("Age")});
  colours->setAccessibleName(tr("Colouring of the map"));
  auto* legend = new QLabel(legend_text(MapColour::kState));
  legend->setWordWrap(true);
  legend->setMinimumHeight(2 * legend->fontMetrics().lineSpacing());
  legend->setAlignment(Qt::AlignTop);
  auto* layout = new QVBoxLayout(panel);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(colours);
  layout->addWidget(map, 1);
  layout->addWidget(legend);
  const auto update_legend = [legend, colours, &view] {
    legend->setText(legend_text(static_cast<MapColour>(colours->currentIndex())) +
                    (view.rivers().map() != nullptr ? rivers_text() : QString()));
  };
  QObject::connect(colours, &QComboBox::activated, panel, [map, update_legend](int index) {
    map->set_colour(static_cast<MapColour>(index));
    update_legend();
  });
  QObject::connect(timer, &QTimer::timeout, panel, [map, update_legend, &view] {
    if (view.session() == nullptr) return;
    const scene::Scene& scene = view.session()->scene();
    map->note(scene);  // also while the map is hidden: it measures ages
    if (!map->isVisible()) return;
    map->show(scene);
    map->show_rivers(view.rivers().map(), scene.camera().pose.position,
                     scene.world().block_size_m());
    update_legend();
  });
  timer->start(kMapUpdateMs);
  return panel;
}

}  // namespace psygen::editor
