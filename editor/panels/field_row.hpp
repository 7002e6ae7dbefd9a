// The control of one field of a world: made from what the schema says of it, so that a type of a
// program's own needs no code here. It shows a value and tells what the person wants; the document
// decides. Main thread.
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

class FieldRow final : public QWidget {
  Q_OBJECT

 public:
  explicit FieldRow(const world::WorldField& field, QWidget* parent = nullptr);

  const world::WorldField& field() const { return field_; }
  // Shows another value of the same field. Tells nobody.
  void show(const world::WorldField& field);
  // What its values would cost.
  void show_cost(std::vector<CostPoint> points);
  // Whether dice leave the field alone; its name is slanted then.
  void set_locked(bool locked);
  bool is_locked() const { return locked_; }

 Q_SIGNALS:
  // A value as TOML.
  void wanted(const world::TextPath& path, const std::string& toml);
  void reset_wanted(const world::TextPath& path);
  // So many steps further, and any value.
  void step_wanted(const world::TextPath& path, int steps);
  void dice_wanted(const world::TextPath& path);
  void drag_began();
  void drag_ended();
  void lock_wanted(const world::TextPath& path, bool locked);
  // The mouse or the keyboard came to this field.
  void attended(const world::TextPath& path);

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
  void want(const std::string& toml) { Q_EMIT wanted(field_.path, toml); }

  world::WorldField field_;
  QLabel* label_;
  QToolButton* reset_;
  bool locked_ = false;
  CostStrip* cost_ = nullptr;  // null: costs do not depend on it
  QVBoxLayout* column_ = nullptr;
  std::vector<NumberEdit*> numbers_;
  std::function<void()> refresh_;  // of the other kinds of controls
};

}  // namespace psygen::editor
