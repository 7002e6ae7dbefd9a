// The view of the world: a window embedded in the editor's window, rendered by the engine. It owns
// the session, opens it when the window first becomes visible, and renders while it is visible. It
// follows the world's text: another thread prepares the newest text, and old meshes stay until the
// new ones are ready. It changes no document. Main thread.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <QWindow>
#include <atomic>
#include <bitset>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "editor/view/grid_overlay.hpp"
#include "editor/view/picking.hpp"
#include "editor/view/river_overlay.hpp"
#include "editor/view/tool_overlay.hpp"
#include "editor/view/view_camera.hpp"
#include "editor/view/view_input.hpp"
#include "editor/view/view_tool.hpp"
#include "editor/view/water_probe.hpp"
#include "editor/view/window_surface.hpp"
#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/handmade/files.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::editor {

// Work in the background that needs the processors too.
enum class BackgroundWork : std::uint8_t { kPictures, kFlight };

// At most one session at a time.
class WorldView final : public QWindow {
  Q_OBJECT

 public:
  // `options`: everything except the world, the size and the surface.
  explicit WorldView(app::SessionOptions options);
  ~WorldView() override;

  // Shows the world of a text from the next frame on. `file`: for messages and for the folder of
  // its images, of which `pictures` are in memory. `new_session`: opens another session, as for
  // another file.
  void show_world(std::string text, std::string file, bool new_session,
                  handmade::MemoryPicturesPtr pictures = {});
  // Null until the window is visible, and while there is no valid world.
  app::Session* session() { return session_.get(); }
  ViewCamera& camera() { return camera_; }
  // True if a modeler of any session hangs: it may still write into memory, which must stay
  // allocated.
  bool has_hung() const { return has_hung_ || (session_ && session_->has_hung_modelers()); }

  const std::optional<Selection>& selection() const { return selection_; }
  void select(std::optional<Selection> selection);
  // Moves the camera close to the selection; without one, to the world's home.
  void focus();
  // In draft mode, during a drag, new meshes are coarse; afterwards they become fine.
  void set_draft(bool draft) { draft_ = draft; }
  // The grid on the ground.
  GridOverlay& grid() { return grid_; }
  // The river network as lines, in the view and in the cache map.
  RiverOverlay& rivers() { return rivers_; }
  const RiverOverlay& rivers() const { return rivers_; }
  // The water under the pointer, a moment ago; dry: there is none, or the pointer is outside.
  world::WaterPoint water_under_pointer();
  // Gives the left mouse button to a tool and draws its marks; null: the button selects. The
  // previous tool cancels its unfinished action. The caller keeps the tool alive until it is
  // replaced.
  void set_tool(ViewTool* tool);
  ViewTool* tool() { return tool_; }
  // The pixel of a point on the ground (x and z in metres of the world), in units of the window.
  // nullopt behind the camera, or without a session.
  std::optional<QPointF> pixel_of(glm::dvec2 at_m) const;
  // A pose of the camera, and the pivot that it orbits.
  struct CameraPlacement {
    core::CameraPose pose;
    std::optional<core::WorldPosition> pivot;
  };
  // Called once with the scene of the newest text, when the view starts to show it. Returns nullopt
  // to keep the camera.
  using PlaceCamera = std::function<std::optional<CameraPlacement>(const scene::Scene&)>;
  void place_camera_on_load(PlaceCamera find) { place_camera_ = std::move(find); }
  // True if meshes of the newest text are missing. In draft mode, false.
  bool awaits_meshes() const { return since_text_.isValid() && !draft_ && !paused_; }
  // Pauses synthesis; the view draws the present meshes.
  void set_paused(bool paused) { paused_ = paused; }
  // Limits the view to a few frames a second while background work runs, the camera rests and all
  // meshes are ready.
  void set_background_work(BackgroundWork work, bool on) {
    background_work_.set(static_cast<std::size_t>(work), on);
  }

 Q_SIGNALS:
  // A session was opened, or failed to open with this error message.
  void opened(const QString& error);
  // The device was lost; the view now opens another one, once. opened() reports a failure, also of
  // a device that is soon lost again.
  void lost();
  // The newest text cannot be shown; the previous world stays.
  void world_rejected(const QString& error);
  // The selection changed.
  void selected();
  // A click in the view has selected a model or the ground.
  void picked();
  // A frame was rendered, in this time.
  void drawn(double frame_ms);
  // The first frame in which everything near and visible belongs to the newest text, at any level
  // of detail; `ms`: since the text was set.
  void answered(double ms);
  // The first frame with all meshes of the newest text; `ms`: since the text was set.
  void settled(double ms);

 protected:
  bool event(QEvent* event) override;

 private:
  // A hidden window of Wayland stays exposed until the next event.
  bool is_shown() const { return isVisible() && isExposed(); }
  void open();
  void close();
  bool reopen();
  void tick();
  int busy_ms() const;
  void take_text();
  void take_prepared();
  void apply_camera_placement();
  void write_overlays();
  void write_selection_box(const ViewProjection& view);
  ViewProjection view_projection() const;
  void serve_tool();
  ToolPoint point_at(const ToolEvent& event);
  void note_answered();
  void note_settled();

  app::SessionOptions options_;
  WindowSurface surface_;
  std::unique_ptr<app::Session> session_;
  std::string text_, file_;
  handmade::MemoryPicturesPtr pictures_;
  bool has_new_mesh_ = false;  // since the view shows the text
  bool text_is_new_ = false, paused_ = false, failed_ = false, has_hung_ = false, draft_ = false;
  std::bitset<2> background_work_;  // by BackgroundWork
  ViewCamera camera_;
  ViewInput input_;
  ViewTool* tool_ = nullptr;
  ToolOverlay overlay_;
  GroundRays ground_;
  std::vector<render::Line> lines_;  // drawn over the image
  std::optional<Selection> selection_;
  // The world that another thread prepares; invalid: none.
  std::future<core::Result<scene::PreparedWorld>> prepared_;
  std::shared_ptr<std::atomic<bool>> cancelled_;  // of the preparation
  QTimer timer_;
  QElapsedTimer since_tick_, since_lost_;
  QElapsedTimer since_text_;  // since the newest text; invalid: all its meshes are drawn
  // Since the text of the prepared world, and of the drawn world, was set.
  QElapsedTimer since_prepared_, since_taken_;
  GridOverlay grid_;
  RiverOverlay rivers_;
  WaterProbe probe_;
  PlaceCamera place_camera_;
};

}  // namespace psygen::editor
