// Shows one model of the document alone in the view, on plain ground, and lets the camera turn
// around it. Edits of the document change it as they change the world. Its seed is its own. The
// camera comes back to the world where it left it. Main thread.
#pragma once

#include <QObject>
#include <cstdint>
#include <optional>

#include "editor/document/document.hpp"
#include "editor/view/world_view.hpp"

namespace psygen::editor {

class ModelView final : public QObject {
  Q_OBJECT

 public:
  ModelView(Document& document, WorldView& view, QObject* parent = nullptr);

  // Gives the view the text of the document, or of its model alone. `anew`: as
  // WorldView::show_world().
  void show(bool anew);
  bool is_on() const { return subject_.has_value(); }
  // Shows the species or scatter that a section belongs to; tells where there is none.
  void open(const world::TextPath& section);
  // As open(), but only if a model is shown, and of other sections the model stays.
  void follow(const world::TextPath& section);
  // Back to the world, and to where its camera stood.
  void close();
  // The camera stands in the world, here, whatever was shown.
  void stand_in_world(const core::CameraPose& pose);
  std::uint64_t seed() const { return seed_; }
  void set_seed(std::uint64_t seed);
  // Where the camera stands in the world, also while a model is shown.
  core::CameraPose world_pose() const;
  // "Model oak" of what is shown.
  QString title() const;

 Q_SIGNALS:
  void told(const QString& sentence);
  // A model is shown, another one, or none.
  void switched();

 private:
  core::Result<std::string> portrait() const;
  void stand_before(bool keep_direction);

  Document& document_;
  WorldView& view_;
  std::optional<world::TextPath> subject_;  // species[i] or scatter[i]
  std::uint64_t seed_ = 7;
  std::optional<core::CameraPose> world_pose_;  // while a model is shown
};

}  // namespace psygen::editor
