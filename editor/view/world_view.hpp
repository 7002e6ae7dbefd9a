// The engine's own picture of the world, in a window that is embedded in the editor's. Owns the
// session: opens it when the window can first be seen, draws while it can be seen, and follows the
// text of the world: another thread prepares the newest one, and what is drawn stays until the new
// meshes are there.
// It changes no document. Main thread.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <QWindow>
#include <bitset>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "editor/view/ground_grid.hpp"
#include "editor/view/picking.hpp"
#include "editor/view/tool_input.hpp"
#include "editor/view/tool_overlay.hpp"
#include "editor/view/view_camera.hpp"
#include "editor/view/view_input.hpp"
#include "editor/view/view_tool.hpp"
#include "editor/view/window_surface.hpp"
#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/handmade/files.hpp"
#include "engine/scene/facts/prepared_world.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::editor {

// What may work beside the view.
enum class Beside : std::uint8_t { kPictures, kFlight };

class WorldView final : public QWindow {
  Q_OBJECT

 public:
  // `options` say everything but the world, the size and the surface.
  explicit WorldView(app::SessionOptions options);
  ~WorldView() override;

  // Shows the world of a text from the next picture on. `file` is for messages and the folder of
  // its pictures, of which `pictures` are in memory. `anew`: opens another session, as for another
  // file.
  void show_world(std::string text, std::string file, bool anew,
                  handmade::MemoryPicturesPtr pictures = {});
  // Null until the window was seen, and while there is no world that can be drawn.
  app::Session* session() { return session_.get(); }
  ViewCamera& camera() { return camera_; }
  // A model hung in some session: its modeler still writes into memory that must not be torn down.
  bool has_hung() const { return has_hung_ || (session_ && session_->has_hung_modelers()); }

  const std::optional<Selection>& selection() const { return selection_; }
  void select(std::optional<Selection> selection);
  // Looks at what is selected from nearby; without a selection, from the world's usual place.
  void focus();
  // While values are tried out, new meshes are coarse; they get fine when it ends.
  void set_draft(bool draft) { draft_ = draft; }
  // The lines on the ground.
  GroundGrid& grid() { return grid_; }
  // What the left button is for from now on, and draws its marks; null: selecting. The tool before
  // takes back what is only begun. A tool must live as long as it is here.
  void set_tool(ViewTool* tool);
  ViewTool* tool() { return tool_; }
  // The pixel of a place on the ground (x and z in the world), in units of the window; nothing
  // behind the camera, or without a picture.
  std::optional<QPointF> pixel_of(glm::dvec2 at_m) const;
  // Where the camera stands, turning around the pivot.
  struct Stand {
    core::CameraPose pose;
    std::optional<core::WorldPosition> pivot;
  };
  // Asked for with the scene of the text that was given last, when that is taken over; nothing: the
  // camera stays.
  using FindStand = std::function<std::optional<Stand>(const scene::Scene&)>;
  void stand_with_text(FindStand find) { find_stand_ = std::move(find); }
  // Whether something of the text that was given last is still to be made; a draft, which waits for
  // more, counts as made.
  bool awaits_meshes() const { return since_text_.isValid() && !draft_ && !paused_; }
  // Synthesis rests: what is there is drawn.
  void set_paused(bool paused) { paused_ = paused; }
  // Something else works on the same processors: while any of it does, nobody moves here and
  // everything is shown, a few pictures a second do.
  void set_yielding(Beside work, bool on) { beside_.set(static_cast<std::size_t>(work), on); }

 Q_SIGNALS:
  // A session was opened, or could not be: `error` says why.
  void opened(const QString& error);
  // The device was lost; another one is opened now, once. If that fails, or if it is lost again
  // soon, opened() tells it.
  void lost();
  // The present text could not be shown; the world before stays.
  void refused(const QString& error);
  void selected();
  // After every picture, with what it took.
  void drawn(double frame_ms);
  // The first picture in which all that is near, and seen, is that of another text, be it coarse;
  // milliseconds since it came.
  void answered(double ms);
  // The text that was shown last is in the picture with all its meshes; milliseconds since it came.
  void settled(double ms);

 protected:
  bool event(QEvent* event) override;

 private:
  void open();
  void close();
  bool open_again();
  void tick();
  void take_text();
  void take_prepared();
  void take_stand();
  void write_over_picture();
  void write_frame(const Lens& lens);
  Lens lens() const;
  void serve_tool();
  ToolPoint point_at(const ToolEvent& event);
  void note_answered();
  void note_settled();

  app::SessionOptions options_;
  WindowSurface surface_;
  std::unique_ptr<app::Session> session_;
  std::string text_, file_;
  handmade::MemoryPicturesPtr pictures_;
  bool has_landed_ = false;  // a mesh, since a text was taken over
  bool text_is_new_ = false, paused_ = false, failed_ = false, has_hung_ = false, draft_ = false;
  std::bitset<2> beside_;  // by Beside
  ViewCamera camera_;
  ViewInput input_;
  ViewTool* tool_ = nullptr;
  ToolInput tool_input_;
  ToolOverlay overlay_;
  GroundRays ground_;
  std::vector<render::Line> lines_;  // over the picture
  std::optional<Selection> selection_;
  // What another thread makes of the newest text that it has got; invalid: it rests.
  std::future<core::Result<scene::PreparedWorld>> prepared_;
  QTimer timer_;
  QElapsedTimer since_tick_, since_lost_;
  QElapsedTimer since_text_;                    // invalid: everything of the text is drawn
  QElapsedTimer since_prepared_, since_taken_;  // the text that is prepared, and drawn, came
  GroundGrid grid_;
  FindStand find_stand_;
};

}  // namespace psygen::editor
