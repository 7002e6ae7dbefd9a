// The panel "Statistics": cache contents and synthesis times by model type, and the predicted cost
// of a block and of the world. Reads the scene, changes nothing. Main thread.
#pragma once

#include <QTimer>
#include <QWidget>
#include <map>
#include <string>
#include <vector>

#include "editor/cost/block_cost.hpp"

class QLabel;
class QTableWidget;

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

class WorldView;

// Updates the table four times a second while it is visible.
class StatisticsPanel final : public QWidget {
  Q_OBJECT

 public:
  // The view outlives the panel.
  explicit StatisticsPanel(WorldView& view);

  // `blocks`: number of blocks of the world, 0 for endless worlds.
  void show_block_cost(const BlockCost& cost, double blocks);

 private:
  void note(const scene::Scene& scene);
  void show(const scene::Scene& scene);

  struct SynthesisTimes {
    std::vector<double> ms;  // a ring of the last ones
    std::size_t next = 0;
  };
  QLabel* world_;
  QLabel* cache_;
  QTableWidget* table_;
  QTimer timer_;
  std::map<std::string, SynthesisTimes> made_;  // by name of the model type
};

}  // namespace psygen::editor
