// The toolbar "Tools", the Tools menu and the shortcuts of the tools (road_tool, place_tool,
// mask_tool). At most one tool is active; Esc exits it. Main thread.
#pragma once

#include <QObject>
#include <functional>
#include <vector>

#include "editor/document/document.hpp"
#include "editor/tools/mask_tool.hpp"
#include "editor/tools/place_tool.hpp"
#include "editor/tools/road_tool.hpp"
#include "editor/view/world_view.hpp"

class QAction;
class QActionGroup;
class QComboBox;
class QDoubleSpinBox;
class QKeySequence;
class QLabel;
class QMainWindow;
class QMenu;
class QToolBar;
class QWidget;

namespace psygen::editor {

// One per window.
class ViewTools final : public QObject {
  Q_OBJECT

 public:
  // `set_dragging` begins and ends a drag of the document.
  ViewTools(QMainWindow& window, Document& document, WorldView& view,
            std::function<void(bool)> set_dragging);

  void add_to_menu(QMenu& menu);
  // Exits the active tool. To be called before the view or the document is destroyed.
  void leave();
  RoadTool& road() { return road_; }
  PlaceTool& place() { return place_; }
  MaskTool& mask() { return mask_; }

 Q_SIGNALS:
  void message_posted(const QString& message);
  // A tool became active: the view must show the world.
  void started();
  // A tool has chosen a table, whose section should be shown.
  void chosen(const psygen::world::TextPath& table);

 private:
  ToolHost host();
  // Adds the button and command of a tool. Widgets added before the next call belong to this tool.
  void add_tool(ViewTool& tool, const QString& name, const QString& key, const QString& help);
  QAction* add_of_tool(QWidget* widget);
  void add_roads();
  void add_places();
  void add_masks();
  void add_new_mask();
  void add_brush();
  QAction* add_command(QMainWindow& window, const QString& name, const QKeySequence& key,
                       std::function<void()> does);
  void add_commands(QMainWindow& window);
  void turn_on(ViewTool* tool);
  void escape();
  void remove();
  void fill_lists();
  void fill_roads();
  void fill_types();
  void fill_masks();
  void show_new_mask();

  Document& document_;
  WorldView& view_;
  std::function<void(bool)> set_dragging_;
  QToolBar* bar_;
  QActionGroup* group_;
  QAction* leave_ = nullptr;
  QAction* remove_ = nullptr;
  struct OfTool {
    ViewTool* tool;
    QAction* action;  // of the bar
  };
  std::vector<OfTool> of_tools_;
  std::vector<OfTool> buttons_;
  RoadTool road_;
  PlaceTool place_;
  QComboBox* roads_ = nullptr;
  QComboBox* types_ = nullptr;
  MaskTool mask_;
  QComboBox* masks_ = nullptr;
  QAction* new_mask_ = nullptr;
  QComboBox* new_area_ = nullptr;
  QDoubleSpinBox *new_side_ = nullptr, *new_pixel_ = nullptr;
  QLabel* new_size_ = nullptr;
  std::vector<QAction*> new_mask_parts_, brush_parts_;  // of the bar; only one group is visible
  QDoubleSpinBox* radius_ = nullptr;
  QAction* erase_ = nullptr;
  std::vector<OfTool> commands_;  // enabled while their tool is active
};

}  // namespace psygen::editor
