#include "editor/view/world_view.hpp"

#include <QGuiApplication>
#include <QPlatformSurfaceEvent>
#include <QScreen>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/core/task.hpp"
#include "engine/render/hud_drawing.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

// Times between frames. Idle: another program is in front.
constexpr int kIdleMs = 100, kBackgroundWorkMs = 150;
constexpr int kPreparedMs = 10;  // a frame waits for the next world at most this long
constexpr double kMaxStepS = 0.1;
constexpr int kLostAgainMs = 60'000;  // a device lost again within this time stays closed

}  // namespace

WorldView::WorldView(app::SessionOptions options) : options_(std::move(options)), surface_(*this) {
  setSurfaceType(QSurface::VulkanSurface);
  connect(&timer_, &QTimer::timeout, this, &WorldView::tick);
  // Emitted before Qt destroys the window's side of the surface.
  connect(this, &QWindow::visibleChanged, this, [this](bool visible) {
    if (!visible && runs_on_wayland()) close();
  });
}

WorldView::~WorldView() {
  close();
}

void WorldView::show_world(std::string text, std::string file, bool new_session,
                           handmade::MemoryPicturesPtr pictures) {
  text_ = std::move(text);
  file_ = std::move(file);
  pictures_ = std::move(pictures);
  text_is_new_ = true;
  failed_ = false;
  since_text_.start();
  if (timer_.isActive()) timer_.start(busy_ms());  // draws the next frame at once
  if (new_session) close();
  if (!session_ && is_shown()) open();
}

void WorldView::open() {
  app::SessionOptions options = options_;
  options.world_text = text_;
  options.world_file = file_;
  options.files = handmade::files_with(file_, pictures_);
  options.surface = &surface_;
  options.size = surface_.framebuffer_size();
  options.vsync = options.vsync && !runs_on_wayland();
  text_is_new_ = false;
  auto session = app::Session::create(std::move(options));
  if (!session) {
    failed_ = true;
    Q_EMIT opened(QString::fromStdString(session.error().message));
    return;
  }
  session_ = std::move(*session);
  select(std::nullopt);
  apply_camera_placement();
  Q_EMIT opened({});
  since_tick_.start();
  timer_.start(busy_ms());
}

void WorldView::close() {
  timer_.stop();
  if (prepared_.valid()) {
    *cancelled_ = true;
    prepared_.wait();  // the preparation uses the session
  }
  prepared_ = {};
  has_hung_ = has_hung();
  if (session_ && session_->has_hung_modelers()) (void)session_.release();
  session_.reset();
}

bool WorldView::event(QEvent* event) {
  if (input_.take(*event, devicePixelRatio(), tool_ != nullptr)) return true;
  switch (event->type()) {
    case QEvent::Expose:
      // After the event, because opening a session is slow.
      if (is_shown() && !session_ && !failed_ && !text_.empty())
        QTimer::singleShot(0, this, [this] {
          if (!session_ && is_shown()) open();
        });
      break;
    case QEvent::FocusOut:
      input_.release_all();
      break;
    case QEvent::PlatformSurface:
      if (static_cast<QPlatformSurfaceEvent*>(event)->surfaceEventType() ==
          QPlatformSurfaceEvent::SurfaceAboutToBeDestroyed)
        close();
      break;
    default:
      break;
  }
  return QWindow::event(event);
}

// The time between frames in which something moves. Without vertical sync, the timer keeps the rate
// of the screen.
int WorldView::busy_ms() const {
  if (!runs_on_wayland()) return 0;
  return static_cast<int>(1'000 / std::max(screen()->refreshRate(), 1.0));
}

// Opens a new device after the device was lost; the camera keeps its pose. Returns false if the
// device was lost a short time ago too, because it would be lost again.
bool WorldView::reopen() {
  if (since_lost_.isValid() && since_lost_.elapsed() < kLostAgainMs) return false;
  since_lost_.start();
  close();
  const CameraPlacement kept{camera_.pose(), camera_.pivot()};
  Q_EMIT lost();
  open();
  camera_.set_pose(kept.pose);
  camera_.set_pivot(kept.pivot);
  return true;
}

// Starts to prepare the newest text, unless the previous one is still in preparation.
void WorldView::take_text() {
  if (prepared_.valid() || !std::exchange(text_is_new_, false)) return;
  since_prepared_ = since_text_;
  session_->set_files(handmade::files_with(session_->options().world_file, pictures_));
  cancelled_ = std::make_shared<std::atomic<bool>>(false);
  prepared_ = core::start_task(session_->prepare_world(text_, cancelled_));
  // Most worlds are ready before a frame of the previous world would be.
  prepared_.wait_for(std::chrono::milliseconds(kPreparedMs));
  take_prepared();
}

void WorldView::take_prepared() {
  if (!core::is_ready(prepared_)) return;
  auto prepared = prepared_.get();
  const auto ok = prepared ? session_->show_world(std::move(*prepared))
                           : core::Result<void>(tl::unexpected(prepared.error()));
  if (!ok) {
    since_text_.invalidate();
    Q_EMIT world_rejected(QString::fromStdString(ok.error().message));
    return;
  }
  since_taken_ = since_prepared_;
  has_new_mesh_ = false;
  apply_camera_placement();
  if (selection_) select(relocate_selection(*selection_, session_->scene()));
}

void WorldView::tick() {
  if (!session_ || !is_shown()) return;
  const double dt_s = std::min(static_cast<double>(since_tick_.nsecsElapsed()) * 1e-9, kMaxStepS);
  since_tick_.start();
  take_prepared();
  if (!paused_) take_text();
  const platform::InputState input = input_.take_frame();
  const bool moved = camera_.update(input, dt_s);
  if (const auto click = input_.take_click()) {
    const scene::Scene& scene = session_->scene();
    select(pick(
        scene, camera_.pose(),
        direction_of(*click, session_->picture_size(), camera_.pose(), scene.camera().projection)));
    if (selection_) Q_EMIT picked();
  }
  serve_tool();
  write_overlays();
  scene::Scene& scene = session_->scene();
  // The first frame after a change is coarse, so that it comes soon.
  scene.input().draft = draft_ || since_taken_.isValid();
  scene.input().lines = lines_;
  QElapsedTimer spent;
  spent.start();
  const bool over = !session_->poll();
  const auto ok = over ? core::Result<void>{} : session_->tick(camera_.pose(), dt_s);
  if (over || !ok) {
    const bool is_lost = !ok && ok.error().code == core::ErrorCode::kDeviceLost;
    if (is_lost && reopen()) return;
    close();
    failed_ = true;
    Q_EMIT opened(QString::fromStdString(ok ? "The view was closed." : ok.error().message));
    return;
  }
  Q_EMIT drawn(static_cast<double>(spent.nsecsElapsed()) * 1e-6);
  note_answered();
  note_settled();
  const bool in_front = QGuiApplication::applicationState() == Qt::ApplicationActive;
  const bool busy = input_.busy();
  const bool yields = background_work_.any() && !moved && !busy && !since_text_.isValid();
  timer_.setInterval(yields                                      ? kBackgroundWorkMs
                     : in_front || busy || since_text_.isValid() ? busy_ms()
                                                                 : kIdleMs);
}

// Places the camera in the world that the view shows from now on.
void WorldView::apply_camera_placement() {
  grid_.note_world();
  overlay_.note_world();
  ground_.note_world();
  probe_.note_world();
  const scene::Scene& scene = session_->scene();
  camera_.set_block_size(scene.world().block_size_m());
  const PlaceCamera place_camera = std::exchange(place_camera_, nullptr);
  const auto placement = place_camera ? place_camera(scene) : std::nullopt;
  if (!placement) return;
  camera_.set_pose(placement->pose);
  camera_.set_pivot(placement->pivot);
}

// Colours change at once. If nothing near changes, the first finished mesh is the answer.
void WorldView::note_answered() {
  if (!since_taken_.isValid()) return;
  const scene::Scene& scene = session_->scene();
  has_new_mesh_ = has_new_mesh_ || scene.statistics().meshes.completed > 0;
  if ((!has_new_mesh_ && scene.meshes().outstanding() > 0) || scene.shows_replaced_world()) return;
  Q_EMIT answered(static_cast<double>(since_taken_.nsecsElapsed()) * 1e-6);
  since_taken_.invalidate();
}

void WorldView::note_settled() {
  if (!since_text_.isValid() || text_is_new_ || prepared_.valid() || draft_) return;
  const scene::Scene& scene = session_->scene();
  const scene::Statistics statistics = scene.statistics();
  if (statistics.drawn.awaited > 0 || scene.meshes().outstanding() > 0 || scene.quality().draft ||
      statistics.impostors_missing)
    return;
  Q_EMIT settled(static_cast<double>(since_text_.nsecsElapsed()) * 1e-6);
  since_text_.invalidate();
}

void WorldView::write_overlays() {
  render::HudDrawing& hud = session_->hud();
  hud = {};
  const scene::Scene& scene = session_->scene();
  const auto grid = grid_.lines(scene.world(), camera_.pose().position);
  lines_.assign(grid.begin(), grid.end());
  const ViewProjection seen = view_projection();
  rivers_.follow(scene.world(), seen.pose.position);
  if (rivers_.map() != nullptr) {
    const double pixel =
        2 * std::tan(double{seen.projection.vertical_fov} / 2) / std::max(1U, seen.size.height);
    add_river_lines(*rivers_.map(), seen.pose.position, seen.block_m, pixel, lines_);
  }
  write_selection_box(seen);
  if (tool_ == nullptr) return;
  overlay_.set(tool_->marks(), scene.world());
  overlay_.add_lines(seen.pose.position, seen.block_m, lines_);
  overlay_.add_handles(seen, hud);
}

// Draws a rectangle around the selected model.
void WorldView::write_selection_box(const ViewProjection& seen) {
  if (!selection_ || selection_->kind != query::HitKind::kModel) return;
  const glm::dvec3 base =
      core::offset_m(selection_->at.block, seen.pose.position, seen.block_m) + selection_->at.local;
  glm::vec2 low{1e9F}, high{-1e9F};
  for (int corner = 0; corner < 8; ++corner) {
    const core::Bounds& box = selection_->box;
    const glm::vec3 at{(corner & 1) != 0 ? box.max.x : box.min.x,
                       (corner & 2) != 0 ? box.max.y : box.min.y,
                       (corner & 4) != 0 ? box.max.z : box.min.z};
    const auto px = seen.pixel_of(glm::vec3(base) + at);
    if (!px) return;
    low = glm::min(low, *px);
    high = glm::max(high, *px);
  }
  const glm::vec4 colour{1.0F, 0.78F, 0.25F, 0.9F};
  const glm::vec2 extent = high - low;
  const auto bar = [&](glm::vec2 at, glm::vec2 of) {
    session_->hud().areas.push_back({{{}, at}, {{}, of}, colour});
  };
  bar(low, {extent.x, 2});
  bar({low.x, high.y}, {extent.x + 2, 2});
  bar(low, {2, extent.y});
  bar({high.x, low.y}, {2, extent.y});
}

void WorldView::select(std::optional<Selection> selection) {
  selection_ = std::move(selection);
  camera_.set_pivot(selection_ ? std::optional(selection_->at) : std::nullopt);
  Q_EMIT selected();
}

void WorldView::focus() {
  if (!session_) return;
  if (!selection_) return camera_.set_pose(session_->home());
  const float radius_m = glm::length(selection_->box.half_extent());
  core::WorldPosition middle = selection_->at;
  middle.local += glm::dvec3(selection_->box.centre());
  camera_.set_pivot(middle);
  camera_.focus(std::max(2.5 * static_cast<double>(radius_m), 3.0));
}

void WorldView::set_tool(ViewTool* tool) {
  if (tool == tool_) return;
  if (tool_ != nullptr) {
    tool_->cancel();
    tool_->leave();
  }
  tool_ = tool;
  input_.forget_tool();
  if (tool_ != nullptr) select(std::nullopt);
}

ViewProjection WorldView::view_projection() const {
  const scene::Scene& scene = session_->scene();
  return {camera_.pose(), scene.camera().projection, session_->picture_size(),
          scene.world().block_size_m()};
}

std::optional<QPointF> WorldView::pixel_of(glm::dvec2 at_m) const {
  if (!session_) return std::nullopt;
  const auto pixel = view_projection().pixel_of(on_surface(at_m, session_->scene().world()));
  if (!pixel) return std::nullopt;
  return QPointF(static_cast<double>(pixel->x), static_cast<double>(pixel->y)) / devicePixelRatio();
}

world::WaterPoint WorldView::water_under_pointer() {
  const auto pointer = input_.pointer();
  if (!session_ || !pointer) return {};
  const ViewProjection seen = view_projection();
  probe_.ask(session_->scene(), seen.pose,
             direction_of(*pointer, seen.size, seen.pose, seen.projection));
  return probe_.answer();
}

ToolPoint WorldView::point_at(const ToolEvent& event) {
  const scene::Scene& scene = session_->scene();
  const ViewProjection seen = view_projection();
  ToolPoint point;
  point.fine = event.fine;
  point.ground_m =
      ground_.at(scene, seen.pose, direction_of(event.at, seen.size, seen.pose, seen.projection));
  overlay_.set(tool_->marks(), scene.world());
  overlay_.hit(event.at, seen, point);
  return point;
}

// Sends the events since the last frame to the tool.
void WorldView::serve_tool() {
  if (tool_ == nullptr) return;
  using Kind = ToolEvent::Kind;
  for (const ToolEvent& event : input_.take_tool_events()) {
    if (tool_ == nullptr) return;  // an event may exit the tool
    switch (event.kind) {
      case Kind::kPress:
        tool_->press(point_at(event));
        break;
      case Kind::kMove:
        event.held ? tool_->drag(point_at(event)) : tool_->hover(point_at(event));
        break;
      case Kind::kRelease:
        tool_->release();
        break;
      case Kind::kClickRight:
        tool_->click_right(point_at(event));
        break;
      case Kind::kWheel:
        if (!tool_->wheel(point_at(event), event.steps)) input_.turn_wheel(event.steps);
        break;
      case Kind::kLeave:
        tool_->leave();
        break;
    }
  }
}

}  // namespace psygen::editor
