// Figures of the session: what the cache holds of each model and what making it took, the cost of
// the world, and what is selected. Reads the scene, changes nothing. Main thread.
#pragma once

#include <QWidget>
#include <map>
#include <optional>
#include <string>

#include "editor/cost/block_cost.hpp"
#include "editor/view/picking.hpp"
#include "engine/telemetry/sample_set.hpp"

class QLabel;
class QTableWidget;

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

class StatisticsPanel final : public QWidget {
  Q_OBJECT

 public:
  explicit StatisticsPanel(QWidget* parent = nullptr);

  // Takes over what was made in the last tick; once a picture.
  void note(const scene::Scene& scene);
  // Shows the figures; some times a second.
  void show(const scene::Scene& scene);
  void show_world_cost(const BlockCost& cost, double blocks);
  void forget();  // another world

 private:
  struct Made {
    std::vector<double> ms;  // the last of them, a ring
    std::size_t next = 0;
  };
  QLabel* world_;
  QLabel* cache_;
  QTableWidget* table_;
  std::map<std::string, Made> made_;  // by the name of the model
};

// What is known of a selected model or place, as lines.
QString describe(const Selection& selection, const scene::Scene& scene);

}  // namespace psygen::editor
