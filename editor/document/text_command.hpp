// One undo step: the texts before and after, with their worlds. Steps of one drag become one. It
// does not know whether a text is a world (document.hpp refuses those that are not). Main thread.
#pragma once

#include <QUndoCommand>
#include <functional>
#include <memory>
#include <string>

#include "editor/document/parsed_world.hpp"

namespace psygen::editor {

using TextPtr = std::shared_ptr<const std::string>;

// A text and the world that it was. Read again it may be another one, where files beside it have
// changed, or none, where they are gone.
struct ShownText {
  TextPtr text;
  ParsedWorldPtr world;
};

class TextCommand : public QUndoCommand {
 public:
  // `drag`: steps with the same number merge; 0: none. `show` makes a text the document's.
  TextCommand(const QString& name, ShownText before, ShownText after, int drag,
              std::function<void(const ShownText&)> show)
      : QUndoCommand(name),
        before_(std::move(before)),
        after_(std::move(after)),
        drag_(drag),
        show_(std::move(show)) {}

  void undo() override { show_(before_); }
  void redo() override { show_(after_); }
  int id() const override { return drag_ == 0 ? -1 : drag_; }
  // A drag that ends where it began is no step.
  bool mergeWith(const QUndoCommand* next) override {
    after_ = static_cast<const TextCommand*>(next)->after_;
    setObsolete(*before_.text == *after_.text);
    return true;
  }

 private:
  ShownText before_, after_;
  int drag_;
  std::function<void(const ShownText&)> show_;
};

}  // namespace psygen::editor
