// The toolbars "Image" (quality, time of day, weather) and "Model" (a model alone). Main thread.
#pragma once

#include <QObject>
#include <functional>

#include "editor/shell/main_window.hpp"

class QSlider;
class QToolBar;

namespace psygen::editor {

// One per window.
class ViewBars final : public QObject {
  Q_OBJECT

 public:
  // Adds both toolbars to the window. Edits between set_dragging(true) and set_dragging(false) are
  // one undo step.
  ViewBars(const EditorContext& context, std::function<void(bool)> set_dragging);

  // The bar "Model" is visible only while a model is alone, even if a saved layout shows it.
  void update_model_bar();

 private:
  void add_quality(QToolBar& bar);
  void add_hour(QToolBar& bar);
  void add_weather(QSlider& slider, const world::TextPath& path);
  void add_model_bar(QMainWindow& window);

  const EditorContext context_;
  std::function<void(bool)> set_dragging_;
  QToolBar* model_bar_ = nullptr;
};

}  // namespace psygen::editor
