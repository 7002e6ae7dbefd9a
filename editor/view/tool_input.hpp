// Mouse events of the view for a tool, queued until the next frame, because they refer to points of
// the drawn world. The camera gets the keys, the middle button, and drags of the right button. Main
// thread.
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
  // Queues an event. Returns true if only the tool gets it.
  bool take(const QEvent& event, double pixel_ratio);
  // The events since the last call; of consecutive moves only the last one.
  std::vector<ToolEvent> take_all();
  // Drops all events and releases the button.
  void forget();
  bool held() const { return held_; }

 private:
  void add(ToolEvent event);

  std::vector<ToolEvent> events_;
  QPointF last_, right_at_;
  bool held_ = false;
};

}  // namespace psygen::editor
