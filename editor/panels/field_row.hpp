// The control of one field of a world, made from its schema, so that model types of a program need
// no code here. It shows a value and emits requests, which the document accepts or rejects. Main
// thread.
#pragma once

#include <QWidget>
#include <functional>
#include <string>
#include <vector>

#include "editor/cost/block_cost.hpp"
#include "engine/world/files/world_schema.hpp"

class QHBoxLayout;
class QLabel;
class QToolButton;
class QVBoxLayout;

namespace psygen::editor {

class CostStrip;
class NumberEdit;

// A label, a control that fits the kind of the field, and a reset button.
class FieldRow final : public QWidget {
  Q_OBJECT

 public:
  // Makes the control and shows the value of the field.
  explicit FieldRow(const world::WorldField& field, QWidget* parent = nullptr);

  const world::WorldField& field() const { return field_; }
  // Shows another value of the same field; emits nothing.
  void show(const world::WorldField& field);
  // Shows the costs of the slider's values.
  void show_cost(std::vector<CostPoint> points);
  // A locked field is excluded from Randomise; its label is italic.
  void set_locked(bool locked);
  bool is_locked() const { return locked_; }

 Q_SIGNALS:
  // The user sets a value, as TOML.
  void change_requested(const world::TextPath& path, const std::string& toml);
  void reset_requested(const world::TextPath& path);
  // The user asks for a value some steps further, or for a random one.
  void step_requested(const world::TextPath& path, int steps);
  void randomise_requested(const world::TextPath& path);
  void drag_began();
  void drag_ended();
  void lock_requested(const world::TextPath& path, bool locked);
  // The pointer or the keyboard focus enters the field.
  void field_focused(const world::TextPath& path);

 protected:
  void enterEvent(QEnterEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  void build(QHBoxLayout& layout);
  void add_number(QHBoxLayout& layout, const QString& name);
  void add_choice(QHBoxLayout& layout);
  void add_text(QHBoxLayout& layout);
  void add_switch(QHBoxLayout& layout);
  void add_colour(QHBoxLayout& layout);
  void add_seed(QHBoxLayout& layout);
  void add_cost();
  void want_numbers(std::size_t changed);
  void choose_colour();
  void want(const std::string& toml) { Q_EMIT change_requested(field_.path, toml); }

  world::WorldField field_;
  QLabel* label_;
  QToolButton* reset_;
  bool locked_ = false;
  CostStrip* cost_ = nullptr;  // null: costs do not depend on the field
  QVBoxLayout* column_ = nullptr;
  std::vector<NumberEdit*> numbers_;
  std::function<void()> refresh_;  // of the other kinds of controls
};

}  // namespace psygen::editor
