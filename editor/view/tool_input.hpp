// Mouse events of the view for a tool, kept until the next picture: they mean points of the world
// that is drawn. The camera keeps keys, the middle button, and the right one while it is dragged.
// Main thread.
#pragma once

#include <QEvent>
#include <QPointF>
#include <cstdint>
#include <vector>

namespace psygen::editor {

struct ToolEvent {
  enum class Kind : std::uint8_t { kPress, kMove, kRelease, kClickRight, kWheel, kLeave };
  Kind kind = Kind::kMove;
  QPointF at;         // device pixels
  bool held = false;  // the left button, of a move
  bool fine = false;  // Shift
  double steps = 0;   // of the wheel
};

class ToolInput {
 public:
  // Takes an event. True: it is the tool's alone.
  bool take(const QEvent& event, double pixel_ratio);
  // What came since the last call; of moves in a row the last one.
  std::vector<ToolEvent> take_all();
  // Nothing is held and nothing has come.
  void forget();
  bool held() const { return held_; }

 private:
  void add(ToolEvent event);

  std::vector<ToolEvent> events_;
  QPointF last_, right_at_;
  bool held_ = false;
};

}  // namespace psygen::editor
