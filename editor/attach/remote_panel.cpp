#include "editor/attach/remote_panel.hpp"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QHelpEvent>
#include <QJsonArray>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QScrollArea>
#include <QToolTip>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>

#include "editor/document/qt_text.hpp"
#include "editor/panels/cache_map.hpp"

namespace psygen::editor {
namespace {

QLabel* words_label() {
  auto* label = new QLabel;
  label->setWordWrap(true);
  label->setTextFormat(Qt::RichText);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

QString names(const QJsonValue& list) {
  QStringList words;
  for (const QJsonValue& name : list.toArray())
    words.push_back(name.toString());
  return words.join(", ");
}

CacheMap::Cell cell_of(const QJsonArray& node, const core::WorldPosition& camera, double block_m) {
  CacheMap::Cell cell;
  cell.at = {{node[0].toInt(), node[1].toInt()},
             static_cast<std::uint8_t>(std::clamp(node[2].toInt(), 0, 30))};
  cell.size_m = block_m * static_cast<double>(1U << cell.at.level);
  const glm::dvec3 corner = core::offset_m(visibility::corner_block(cell.at), camera, block_m);
  cell.x_m = corner.x;
  cell.z_m = corner.z;
  const int flags = node[3].toInt();
  cell.in_view = (flags & 1) != 0;
  cell.drawn = (flags & 2) != 0;
  cell.stale = (flags & 4) != 0;
  cell.requested = (flags & 8) != 0;
  cell.failed = (flags & 16) != 0;
  cell.level_drawn = node[4].toInt();
  cell.layer = node[5].toInt();
  cell.lacking = node[6].toInt() < 0 ? UINT32_MAX : static_cast<std::uint32_t>(node[6].toInt());
  cell.deadline_s = node[7].toDouble(std::numeric_limits<double>::infinity());
  cell.cost_s = node[8].toDouble() * 1e-6;
  return cell;
}

}  // namespace

// System times as bars: the mean, and a mark at the maximum.
class SystemBars final : public QWidget {
 public:
  // Times of one system per frame.
  struct Bar {
    QString name;
    double mean_ms = 0, max_ms = 0;
    QString tool_tip = {};
  };
  SystemBars() {
    setAccessibleName(tr("System times"));
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    setToolTip(" ");
  }
  void show_bars(std::vector<Bar> bars) {
    const bool other = bars.size() != bars_.size();
    bars_ = std::move(bars);
    if (other) updateGeometry();
    update();
  }
  QSize sizeHint() const override {
    return {240, row_height() * std::max(1, static_cast<int>(bars_.size())) + 4};
  }

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

 private:
  int row_height() const { return fontMetrics().height() + 3; }
  std::vector<Bar> bars_;
};

void SystemBars::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  double max_ms = 0.1;
  int name_width = 0;
  for (const Bar& bar : bars_) {
    max_ms = std::max(max_ms, bar.max_ms);
    name_width = std::max(name_width, fontMetrics().horizontalAdvance(bar.name));
  }
  const int number_width = fontMetrics().horizontalAdvance("00.00 ms ");
  const int left = name_width + 8, room = std::max(10, width() - left - number_width - 4);
  int y = 2;
  for (const Bar& bar : bars_) {
    const auto length = [&](double ms) { return static_cast<int>(room * ms / max_ms); };
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(2, y, name_width, row_height(), Qt::AlignVCenter, bar.name);
    painter.fillRect(left, y + 3, std::max(1, length(bar.mean_ms)), row_height() - 6,
                     palette().color(QPalette::Highlight));
    painter.fillRect(left + length(bar.max_ms), y + 3, 2, row_height() - 6, QColor(230, 150, 40));
    painter.drawText(left + room, y, number_width, row_height(), Qt::AlignVCenter | Qt::AlignRight,
                     tr("%1 ms").arg(bar.mean_ms, 0, 'f', 2));
    y += row_height();
  }
}

bool SystemBars::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const auto row = static_cast<std::size_t>(std::max(0, help->pos().y() - 2) / row_height());
  QToolTip::showText(help->globalPos(), row < bars_.size() ? bars_[row].tool_tip : QString(), this);
  return true;
}

RemotePanel::RemotePanel(RemoteSession& remote, QWidget* parent)
    : QWidget(parent),
      remote_(remote),
      title_(words_label()),
      statistics_(words_label()),
      kinds_(words_label()),
      bars_(new SystemBars),
      map_(new CacheMap),
      pause_(new QCheckBox(tr("Pause program"))),
      follow_(new QCheckBox(tr("Sync its camera to this view"))),
      keep_(new QCheckBox(tr("Keep my changes"))),
      go_(new QPushButton(tr("Go to its camera"))),
      detach_(new QPushButton(tr("Detach"))) {
  auto* colours = new QComboBox;
  colours->addItems({tr("State"), tr("Level"), tr("PLP layer"), tr("Cost")});
  colours->setAccessibleName(tr("Colouring of the program's map"));
  keep_->setToolTip(
      tr("Detaching leaves your world in the program. Without this option it restores the "
         "program's original state."));
  auto* content = new QWidget;
  auto* layout = new QVBoxLayout(content);
  auto* detach_row = new QHBoxLayout;
  detach_row->addWidget(detach_);
  detach_row->addWidget(keep_, 1);
  layout->addWidget(title_);
  layout->addLayout(detach_row);
  layout->addWidget(pause_);
  layout->addWidget(follow_);
  layout->addWidget(go_, 0, Qt::AlignLeft);
  layout->addWidget(statistics_);
  layout->addWidget(new QLabel(tr("<b>Systems</b>: mean (bar) and maximum (mark)")));
  layout->addWidget(bars_);
  layout->addWidget(kinds_);
  layout->addWidget(colours);
  map_->setMinimumHeight(240);
  layout->addWidget(map_, 1);
  auto* scroll = new QScrollArea;
  scroll->setWidget(content);
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setFrameShape(QFrame::NoFrame);
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  outer->addWidget(scroll);
  connect(colours, &QComboBox::activated, map_,
          [this](int index) { map_->set_colour(static_cast<MapColour>(index)); });
  connect(pause_, &QCheckBox::toggled, this, [this](bool on) { remote_.set_paused(on); });
  connect(follow_, &QCheckBox::toggled, this, &RemotePanel::sync_camera_requested);
  connect(go_, &QPushButton::clicked, this, [this] {
    if (remote_.pose()) Q_EMIT go_to_requested(*remote_.pose());
  });
  connect(detach_, &QPushButton::clicked, this, [this] { remote_.detach(keep_->isChecked()); });
  connect(&remote_, &RemoteSession::attached, this, &RemotePanel::show_hello);
  connect(&remote_, &RemoteSession::statistics, this, &RemotePanel::show_statistics);
  connect(&remote_, &RemoteSession::systems, this, &RemotePanel::show_systems);
  connect(&remote_, &RemoteSession::entities, this, &RemotePanel::show_entities);
  connect(&remote_, &RemoteSession::ended, this, &RemotePanel::show_end);
  show_end({});
}

void RemotePanel::show_hello(const QJsonObject& hello) {
  title_->setText(tr("<b>%1</b> in process %2, on %3%4")
                      .arg(hello["world"].toString().toHtmlEscaped())
                      .arg(hello["pid"].toInt())
                      .arg(hello["device"].toString().toHtmlEscaped(),
                           hello["virtual_clock"].toBool() ? tr(", on the virtual clock") : ""));
  for (QWidget* widget : std::initializer_list<QWidget*>{pause_, follow_, keep_, go_, detach_})
    widget->setEnabled(true);
}

void RemotePanel::show_statistics(const QJsonObject& f) {
  const QJsonObject cache = f["cache"].toObject();
  const auto bytes = [&](const char* name) { return bytes_text(cache[name].toDouble()); };
  statistics_->setText(
      tr("Running for %1 s%2. Frame time %3 ms (max %4). %5 triangles in %6 draws, error %7 px, "
         "%8 % of pixels missing.<br>%9 queued; %10 worker threads, %11 % busy. "
         "Cache: %14 meshes, %12 of %13.")
          .arg(f["time_s"].toDouble(), 0, 'f', 1)
          .arg(f["paused"].toBool() ? tr(", paused") : QString())
          .arg(f["frame_ms"].toDouble(), 0, 'f', 1)
          .arg(f["longest_ms"].toDouble(), 0, 'f', 1)
          .arg(count_text(f["triangles"].toDouble()))
          .arg(f["draws"].toInt())
          .arg(f["error_pixels"].toDouble(), 0, 'f', 1)
          .arg(f["missing_pixels_percent"].toDouble(), 0, 'f', 1)
          .arg(f["outstanding"].toInt())
          .arg(f["modelers"].toInt())
          .arg(f["busy_percent"].toDouble(), 0, 'f', 0)
          .arg(bytes("bytes"), bytes("budget_bytes"))
          .arg(cache["meshes"].toInt()));
}

void RemotePanel::show_systems(const QJsonObject& object) {
  std::vector<SystemBars::Bar> bars;
  for (const QJsonValue& value : object["systems"].toArray()) {
    const QJsonObject system = value.toObject();
    SystemBars::Bar bar{.name = system["name"].toString(),
                        .mean_ms = system["mean_ms"].toDouble(),
                        .max_ms = system["longest_ms"].toDouble()};
    bar.tool_tip = tr("%1: mean %2 ms, maximum %3 ms\nreads %4\nwrites %5")
                       .arg(bar.name)
                       .arg(bar.mean_ms, 0, 'f', 3)
                       .arg(bar.max_ms, 0, 'f', 3)
                       .arg(names(system["reads"]), names(system["writes"]));
    bars.push_back(std::move(bar));
  }
  bars_->show_bars(std::move(bars));
}

void RemotePanel::show_entities(const QJsonObject& object) {
  QString rows;
  const QJsonObject kinds = object["kinds"].toObject();
  for (auto kind = kinds.begin(); kind != kinds.end(); ++kind) {
    const QJsonObject of = kind.value().toObject();
    rows += QString(
                "<tr><td>%1&nbsp;&nbsp;</td><td align=right>%2&nbsp;&nbsp;</td>"
                "<td align=right>%3</td></tr>")
                .arg(kind.key().toHtmlEscaped())
                .arg(of["entities"].toInt())
                .arg(of["drawn"].toInt());
  }
  kinds_->setText(tr("<b>Entities</b>: %1<table><tr><td></td><td>number&nbsp;&nbsp;</td>"
                     "<td>with a mesh</td></tr>%2</table>")
                      .arg(object["entities"].toInt())
                      .arg(rows));
  const auto camera = pose_of(object["camera"].toObject());
  const double block_m = object["block_m"].toDouble();
  if (!camera || !(block_m > 0)) return;
  std::vector<CacheMap::Cell> cells;
  for (const QJsonValue& node : object["nodes"].toArray())
    cells.push_back(cell_of(node.toArray(), camera->position, block_m));
  map_->show_cells(std::move(cells), camera->yaw, object["horizontal_fov"].toDouble(0.9));
}

void RemotePanel::show_end(const QString&) {
  title_->setText(tr("No program is attached. Choose one with File > Attach …"));
  statistics_->clear();
  kinds_->clear();
  bars_->show_bars({});
  map_->show_cells({}, 0, 0.9);
  for (QCheckBox* box : {pause_, follow_, keep_}) {
    const QSignalBlocker quiet(box);
    box->setChecked(false);
  }
  Q_EMIT sync_camera_requested(false);
  for (QWidget* widget : std::initializer_list<QWidget*>{pause_, follow_, keep_, go_, detach_})
    widget->setEnabled(false);
}

}  // namespace psygen::editor
