#include "editor/panels/statistics_panel.hpp"

#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "editor/panels/cache_contents.hpp"
#include "editor/panels/cost_strip.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

constexpr std::size_t kSamples = 512;

const QLocale kEnglish(QLocale::English);

// Of types that have meshes, by name.
std::map<std::string, HeldOfType> held_by_name(const scene::Scene& scene) {
  const std::vector<HeldOfType> of_type = held_by_type(scene);
  std::map<std::string, HeldOfType> held;
  for (models::ModelIndex i = 0; i < of_type.size(); ++i) {
    if (of_type[i].meshes > 0) held[std::string(scene.registry()[i].name())] = of_type[i];
  }
  return held;
}

QString percentile(std::vector<double> ms, double share) {
  if (ms.empty()) return "–";
  return kEnglish.toString(synthesis::quantile(ms, share), 'g', 3);
}

// Whether the cell had another text before.
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

QString parameters_text(const models::ModelType& type, const models::Parameters& p) {
  QString text;
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const QString value = specs[i].type == models::ParameterType::kInteger
                              ? QString::number(static_cast<quint64>(p.integer(i)))
                              : kEnglish.toString(p.real(i), 'g', 5);
    text +=
        QString("%1 = %2\n")
            .arg(QString::fromUtf8(specs[i].name.data(), static_cast<int>(specs[i].name.size())),
                 value);
  }
  return text;
}

}  // namespace

StatisticsPanel::StatisticsPanel(QWidget* parent)
    : QWidget(parent), world_(new QLabel), cache_(new QLabel), table_(new QTableWidget) {
  world_->setWordWrap(true);
  cache_->setWordWrap(true);
  const QStringList columns{tr("model"), tr("meshes"), tr("triangles"), tr("vertices"),
                            tr("bytes"), tr("share"),  tr("p50 ms"),    tr("p99 ms")};
  table_->setColumnCount(static_cast<int>(columns.size()));
  table_->setHorizontalHeaderLabels(columns);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(table_->fontMetrics().height() + 4);
  table_->setAccessibleName(tr("Meshes in the cache, by model"));
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(world_);
  layout->addWidget(cache_);
  layout->addWidget(table_, 1);
}

void StatisticsPanel::note(const scene::Scene& scene) {
  for (const auto& cost : scene.statistics().costs) {
    if (cost.model >= scene.registry().size()) continue;
    Made& made = made_[std::string(scene.registry()[cost.model].name())];
    if (made.ms.size() < kSamples) made.ms.push_back(0);
    made.ms[made.next] = cost.actual_s * 1e3;
    made.next = (made.next + 1) % kSamples;
  }
}

void StatisticsPanel::forget() {
  made_.clear();
}

void StatisticsPanel::show(const scene::Scene& scene) {
  const synthesis::CacheStats stats = scene.meshes().stats();
  cache_->setText(
      tr("Cache: %1 of %2 in %3 meshes, %4 of it in view. %5 evicted, %6 waiting.")
          .arg(kEnglish.formattedDataSize(static_cast<qint64>(stats.bytes)),
               kEnglish.formattedDataSize(static_cast<qint64>(stats.budget_bytes)),
               kEnglish.toString(stats.ready),
               kEnglish.formattedDataSize(static_cast<qint64>(stats.visible_bytes)),
               kEnglish.toString(static_cast<qulonglong>(stats.evictions)),
               kEnglish.toString(static_cast<qulonglong>(scene.meshes().outstanding()))));
  const auto held = held_by_name(scene);
  table_->setRowCount(static_cast<int>(held.size()));
  int row = 0;
  bool changed = false;
  for (const auto& [name, of] : held) {
    const auto made = made_.find(name);
    const std::vector<double> ms = made != made_.end() ? made->second.ms : std::vector<double>{};
    const double share = 100.0 * static_cast<double>(of.bytes) /
                         static_cast<double>(std::max<std::uint64_t>(stats.bytes, 1));
    const QString cells[] = {QString::fromStdString(name),
                             kEnglish.toString(static_cast<qulonglong>(of.meshes)),
                             kEnglish.toString(static_cast<qulonglong>(of.triangles)),
                             kEnglish.toString(static_cast<qulonglong>(of.vertices)),
                             kEnglish.formattedDataSize(static_cast<qint64>(of.bytes)),
                             kEnglish.toString(share, 'f', 1) + " %",
                             percentile(ms, 0.5),
                             percentile(ms, 0.99)};
    for (int column = 0; column < 8; ++column)
      changed = set_cell(*table_, row, column, cells[column]) || changed;
    ++row;
  }
  if (changed) table_->resizeColumnsToContents();
}

void StatisticsPanel::show_world_cost(const BlockCost& cost, double blocks) {
  QString text = "<b>" + tr("A block at full detail:") + "</b> " + cost_text(cost) + ".";
  if (blocks > 0) {
    text += " <b>" + tr("The world:") + "</b> " +
            tr("%1 triangles, %2, %3 of one core.")
                .arg(kEnglish.toString(cost.triangles * blocks, 'g', 3),
                     kEnglish.formattedDataSize(std::llround(cost.bytes * blocks)),
                     cost.seconds * blocks > 7200
                         ? tr("%1 hours").arg(cost.seconds * blocks / 3600, 0, 'f', 1)
                         : tr("%1 s").arg(cost.seconds * blocks, 0, 'f', 1));
  } else {
    text += " " + tr("The world has no end.");
  }
  world_->setText(text);
}

QString describe(const Selection& selection, const scene::Scene& scene) {
  const models::ModelType& type = scene.registry()[selection.model];
  const models::Parameters& p = selection.parameters;
  const bool model = selection.kind == query::HitKind::kModel;
  QString text = QString::fromUtf8(type.name().data(), static_cast<int>(type.name().size()));
  text += model ? QObject::tr(" number %1 of block (%2, %3)\n")
                      .arg(selection.index)
                      .arg(selection.block.x)
                      .arg(selection.block.z)
                : QObject::tr(" of block (%1, %2)\n").arg(selection.block.x).arg(selection.block.z);
  text += QObject::tr("at %1, %2, %3 m; %4 m away\n\n")
              .arg(selection.at.local.x, 0, 'f', 1)
              .arg(selection.at.local.y, 0, 'f', 1)
              .arg(selection.at.local.z, 0, 'f', 1)
              .arg(selection.distance_m, 0, 'f', 1);
  const int levels = type.level_count_of(p);
  text += QObject::tr("level: triangles, error, time\n");
  for (int level = 0; level < levels; ++level) {
    const models::MeshSize size = type.mesh_size(p, level);
    text += QObject::tr("%1: %2, %3 m, %4 µs\n")
                .arg(level)
                .arg(kEnglish.toString(size.triangle_count()))
                .arg(type.level_error_m(p, level), 0, 'g', 3)
                .arg(scene.meshes().costs().predict(selection.model, p, level) * 1e6, 0, 'f', 1);
  }
  return text + "\n" + parameters_text(type, p);
}

}  // namespace psygen::editor
