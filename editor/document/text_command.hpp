// One undo step: the texts before and after, with their worlds. Steps of one drag merge. It does
// not validate texts (document.hpp does). Main thread.
#pragma once

#include <QUndoCommand>
#include <functional>
#include <memory>
#include <string>

#include "editor/document/parsed_world.hpp"

namespace psygen::editor {

// A text, shared and immutable.
using TextPtr = std::shared_ptr<const std::string>;

// A text and its world at the time of the step. Parsing the text again may give another world if
// its resources have changed, or an error if they are missing.
struct ShownText {
  TextPtr text;
  ParsedWorldPtr world;
};

// An undo step of a document's QUndoStack.
class TextCommand : public QUndoCommand {
 public:
  // `drag`: steps with the same number merge; 0: none. `show` sets the text of the document.
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
  // A drag that ends at its first text is no step.
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
