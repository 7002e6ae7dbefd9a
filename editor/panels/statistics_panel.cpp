#include "editor/panels/statistics_panel.hpp"

#include <QHeaderView>
#include <QLabel>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "editor/document/qt_text.hpp"
#include "editor/panels/cache_contents.hpp"
#include "editor/panels/cost_strip.hpp"
#include "editor/view/world_view.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

constexpr std::size_t kSamples = 512;
constexpr int kTableUpdateMs = 250;

QString percentile(std::vector<double> ms, double share) {
  if (ms.empty()) return "–";
  return kEnglish.toString(synthesis::quantile(ms, share), 'g', 3);
}

// Returns true if the text of the cell changed.
bool set_cell(QTableWidget& table, int row, int column, const QString& text) {
  QTableWidgetItem* item = table.item(row, column);
  if (item == nullptr) {
    item = new QTableWidgetItem(text);
    item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable);
    if (column > 0) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    table.setItem(row, column, item);
    return true;
  }
  if (item->text() == text) return false;
  item->setText(text);
  return true;
}

}  // namespace

StatisticsPanel::StatisticsPanel(WorldView& view)
    : world_(new QLabel), cache_(new QLabel), table_(new QTableWidget) {
  world_->setWordWrap(true);
  cache_->setWordWrap(true);
  const QStringList columns{tr("Model"),  tr("Meshes"),         tr("Triangles"), tr("Vertices"),
                            tr("Memory"), tr("Share of cache"), tr("p50 ms"),    tr("p99 ms")};
  table_->setColumnCount(static_cast<int>(columns.size()));
  table_->setHorizontalHeaderLabels(columns);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(table_->fontMetrics().height() + 4);
  table_->setAccessibleName(tr("Cached meshes by model type"));
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(world_);
  layout->addWidget(cache_);
  layout->addWidget(table_, 1);
  connect(&view, &WorldView::opened, this, [this](const QString& error) {
    if (error.isEmpty()) made_.clear();
  });
  connect(&view, &WorldView::drawn, this, [this, &view] { note(view.session()->scene()); });
  connect(&timer_, &QTimer::timeout, this, [this, &view] {
    if (isVisible() && view.session() != nullptr) show(view.session()->scene());
  });
  timer_.start(kTableUpdateMs);
}

void StatisticsPanel::note(const scene::Scene& scene) {
  for (const auto& cost : scene.statistics().meshes.costs) {
    if (cost.model >= scene.registry().size()) continue;
    SynthesisTimes& made = made_[std::string(scene.registry()[cost.model].name())];
    if (made.ms.size() < kSamples) made.ms.push_back(0);
    made.ms[made.next] = cost.actual_s * 1e3;
    made.next = (made.next + 1) % kSamples;
  }
}

void StatisticsPanel::show(const scene::Scene& scene) {
  const synthesis::CacheStats stats = scene.meshes().stats();
  cache_->setText(tr("Cache: %3 meshes, %1 of %2 used, %4 in view. %5 evicted, %6 queued.")
                      .arg(bytes_text(stats.bytes), bytes_text(stats.budget_bytes),
                           count_text(stats.ready), bytes_text(stats.visible_bytes),
                           count_text(stats.evictions), count_text(scene.meshes().outstanding())));
  const auto held = contents_by_type(scene);
  table_->setRowCount(static_cast<int>(held.size()));
  int row = 0;
  bool changed = false;
  for (const auto& [name, of] : held) {
    const auto made = made_.find(name);
    const std::vector<double> ms = made != made_.end() ? made->second.ms : std::vector<double>{};
    const double share = 100.0 * static_cast<double>(of.bytes) /
                         static_cast<double>(std::max<std::uint64_t>(stats.bytes, 1));
    const QString cells[] = {to_qstring(name),         count_text(of.meshes),
                             count_text(of.triangles), count_text(of.vertices),
                             bytes_text(of.bytes),     kEnglish.toString(share, 'f', 1) + " %",
                             percentile(ms, 0.5),      percentile(ms, 0.99)};
    for (int column = 0; column < 8; ++column)
      changed = set_cell(*table_, row, column, cells[column]) || changed;
    ++row;
  }
  if (changed) table_->resizeColumnsToContents();
}

void StatisticsPanel::show_block_cost(const BlockCost& cost, double blocks) {
  QString text = "<b>" + tr("Per block at full detail:") + "</b> " + cost_text(cost) + ".";
  if (blocks > 0) {
    text += " <b>" + tr("The world:") + "</b> " +
            tr("%1 triangles, %2, %3 on one core.")
                .arg(kEnglish.toString(cost.triangles * blocks, 'g', 3),
                     bytes_text(cost.bytes * blocks),
                     cost.seconds * blocks > 7200
                         ? tr("%1 hours").arg(cost.seconds * blocks / 3600, 0, 'f', 1)
                         : tr("%1 s").arg(cost.seconds * blocks, 0, 'f', 1));
  } else {
    text += " " + tr("Endless world.");
  }
  world_->setText(text);
}

}  // namespace psygen::editor
