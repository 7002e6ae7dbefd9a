// Shows one model of the document alone in the view, on plain ground, with a camera that orbits it.
// It follows edits of the document, and has its own seed. The camera returns to its pose in the
// world afterwards. Main thread.
#pragma once

#include <QObject>
#include <cstdint>
#include <optional>

#include "editor/document/document.hpp"
#include "editor/view/world_view.hpp"

namespace psygen::editor {

class MessageLog;

// Switches a view between the world and one model.
class ModelView final : public QObject {
  Q_OBJECT

 public:
  // Document, view and messages outlive this object.
  ModelView(Document& document, WorldView& view, MessageLog& messages, QObject* parent);

  // Gives the view the text of the document, or of its model alone. `new_session` as in
  // WorldView::show_world().
  void show(bool new_session);
  bool is_on() const { return subject_.has_value(); }
  // Shows the species or scatter of a section; shows a message if it has none.
  void open(const world::TextPath& section);
  // Shows the model of another section, but only if a model is shown already and the section has
  // one.
  void follow(const world::TextPath& section);
  // Shows the world again, with the previous pose of the camera.
  void close();
  // Shows the world from this pose.
  void go_to_world(const core::CameraPose& pose);
  std::uint64_t seed() const { return seed_; }
  void set_seed(std::uint64_t seed);
  // The camera's pose in the world, also while a model is shown.
  core::CameraPose world_pose() const { return world_pose_.value_or(view_.camera().pose()); }
  // Name of the shown model.
  QString title() const;

 Q_SIGNALS:
  // The shown model changed: another one, or none.
  void switched();

 private:
  core::Result<std::string> portrait() const;
  void frame_model(bool keep_direction);

  Document& document_;
  WorldView& view_;
  MessageLog& messages_;
  std::optional<world::TextPath> subject_;  // species[i] or scatter[i]
  std::uint64_t seed_ = 7;
  std::optional<core::CameraPose> world_pose_;  // while a model is shown
};

}  // namespace psygen::editor
