#include "editor/panels/cache_map_panel.hpp"

#include <QComboBox>
#include <QLabel>
#include <QVBoxLayout>

#include "editor/panels/cache_map.hpp"
#include "editor/view/world_view.hpp"

namespace psygen::editor {
namespace {

constexpr int kMapUpdateMs = 250;

}  // namespace

CacheMapPanel::CacheMapPanel(WorldView& view) {
  auto* map = new CacheMap;
  auto* colours = new QComboBox;
  colours->addItems({tr("State"), tr("Level"), tr("PLP layer"), tr("Cost"), tr("Age")});
  colours->setAccessibleName(tr("Colouring of the map"));
  auto* legend = new QLabel(legend_text(MapColour::kState));
  legend->setWordWrap(true);
  legend->setMinimumHeight(2 * legend->fontMetrics().lineSpacing());
  legend->setAlignment(Qt::AlignTop);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(colours);
  layout->addWidget(map, 1);
  layout->addWidget(legend);
  connect(colours, &QComboBox::activated, this, [map, legend](int index) {
    map->set_colour(static_cast<MapColour>(index));
    legend->setText(legend_text(static_cast<MapColour>(index)));
  });
  connect(&timer_, &QTimer::timeout, this, [map, &view] {
    if (view.session() == nullptr) return;
    const scene::Scene& scene = view.session()->scene();
    map->note(scene);  // also while the map is hidden: it measures ages
    if (map->isVisible()) map->show(scene);
  });
  timer_.start(kMapUpdateMs);
}

}  // namespace psygen::editor
