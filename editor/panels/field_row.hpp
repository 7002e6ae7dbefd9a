// The control of one field of a world, made from its schema, so that model types of a program need
// no code here. It edits the document, which accepts or rejects each value. Main thread.
#pragma once

#include <QWidget>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "editor/cost/block_cost.hpp"
#include "editor/document/document.hpp"
#include "editor/document/scale.hpp"
#include "engine/world/files/world_schema.hpp"

class QDoubleSpinBox;
class QHBoxLayout;
class QLabel;
class QSlider;
class QToolButton;

namespace psygen::editor {

class CostStrip;
class MessageLog;

// The objects that the controls edit with. They outlive the controls.
struct FieldHost {
  Document& document;
  MessageLog& messages;  // gets the errors
  // Edits between true and false are one undo step.
  std::function<void(bool)> set_dragging;
  std::mt19937_64 random{std::random_device{}()};
};

// A label, a control that fits the kind of the field, and a reset button.
class FieldRow final : public QWidget {
  Q_OBJECT

 public:
  // Makes the control and shows the value of the field.
  FieldRow(FieldHost& host, const world::WorldField& field);

  const world::WorldField& field() const { return field_; }
  // Shows another value of the same field.
  void show(const world::WorldField& field);
  // Sets a value of the document, as TOML. After an error the row shows the old value again.
  void set_value(const std::string& toml);
  void randomise();
  // A locked field is excluded from Randomise; its label is italic.
  void set_locked(bool locked);
  bool is_locked() const;
  // Shows the costs of the slider's values.
  void show_cost(std::vector<CostPoint> points);

 Q_SIGNALS:
  // The pointer or the keyboard focus enters the field.
  void field_focused(const world::TextPath& path);

 protected:
  void enterEvent(QEnterEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  // The slider has the soft range, the box the hard range. Both always show the same value.
  struct Number {
    QSlider* slider;
    QDoubleSpinBox* box;
  };
  void build(QHBoxLayout& layout);
  void add_number(QHBoxLayout& line, const QString& name);
  int position_of(double value, const QSlider& slider) const;
  void add_choice(QHBoxLayout& layout);
  void add_text(QHBoxLayout& layout);
  void add_switch(QHBoxLayout& layout);
  void add_colour(QHBoxLayout& layout);
  void add_seed(QHBoxLayout& layout);
  void want_numbers(std::size_t changed);
  void choose_colour();
  void reset();
  void show_lock();

  FieldHost& host_;
  world::WorldField field_;
  const Scale scale_;  // of the sliders
  QLabel* label_;
  QToolButton* reset_;
  CostStrip* cost_ = nullptr;  // null: costs do not depend on the field
  std::vector<Number> numbers_;
  std::function<void()> refresh_;  // of the other kinds of controls
};

}  // namespace psygen::editor
