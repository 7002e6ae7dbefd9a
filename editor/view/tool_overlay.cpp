#include "editor/view/tool_overlay.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

namespace psygen::editor {
namespace {

constexpr double kPieceM = 3;   // length of a piece of a line that follows the ground
constexpr int kMaxPieces = 64;  // between two points
constexpr float kHandlePx = 9, kChosenPx = 13, kBorderPx = 2;
constexpr float kReachHandlePx = 12, kReachLinePx = 7;  // of the pointer
// Height of marks above the ground, so that it does not cover them; it grows with the distance.
constexpr double kMarkLiftM = 0.06, kMarkLiftPerM = 0.005;
const glm::vec4 kHandleColour{0.95F, 0.96F, 1.0F, 1.0F}, kChosenColour{1.0F, 0.62F, 0.1F, 1.0F},
    kBorderColour{0.05F, 0.06F, 0.08F, 0.9F};

glm::vec3 lifted(const core::WorldPosition& at, const core::WorldPosition& eye, double block_m) {
  glm::dvec3 from_eye = core::offset_m(at.block, eye, block_m) + at.local;
  from_eye.y += kMarkLiftM + kMarkLiftPerM * glm::length(from_eye);
  return from_eye;
}

}  // namespace

core::WorldPosition on_surface(glm::dvec2 at_m, const world::World& world) {
  core::WorldPosition at = world.position(at_m);
  at.local.y = world::surface_height_m(world, at);
  return at;
}

ViewProjection::ViewProjection(const core::CameraPose& from, const core::Projection& by,
                               core::Extent pixels, double block_size_m)
    : pose(from),
      projection(by),
      size(pixels),
      block_m(block_size_m),
      to_clip_(core::projection_matrix(by) * core::view_rotation(from)) {}

std::optional<glm::vec2> ViewProjection::pixel_of(const glm::vec3& from_eye) const {
  const glm::vec4 clip = to_clip_ * glm::vec4(from_eye, 1);
  if (clip.w <= projection.near_m) return std::nullopt;
  return glm::vec2{(clip.x / clip.w + 1) * 0.5F * static_cast<float>(size.width),
                   (clip.y / clip.w + 1) * 0.5F * static_cast<float>(size.height)};
}

std::optional<glm::vec2> ViewProjection::pixel_of(const core::WorldPosition& at) const {
  return pixel_of(lifted(at, pose.position, block_m));
}

void ToolOverlay::set(const ToolMarks& marks, const world::World& world) {
  if (std::exchange(world_is_new_, false)) take_ground(world);
  if (marks == marks_) return;
  const ToolMarks was = std::exchange(marks_, marks);
  const auto handles = std::exchange(handles_, {});
  auto lines = std::exchange(lines_, {});
  for (std::size_t i = 0; i < marks_.handles.size(); ++i) {
    const glm::dvec2 at_m = marks_.handles[i].at_m;
    const bool same = i < handles.size() && was.handles[i].at_m == at_m;
    handles_.push_back(same ? handles[i] : look_up(at_m, world));
  }
  for (std::size_t i = 0; i < marks_.lines.size(); ++i) {
    const auto& points = marks_.lines[i].points_m;
    const bool same = i < lines.size() && was.lines[i].points_m == points;
    lines_.push_back(same ? std::move(lines[i]) : line_on_ground(points, world));
  }
}

// Recomputes heights where the ground has changed.
void ToolOverlay::take_ground(const world::World& world) {
  const SurfaceShape now(world);
  const auto before = std::exchange(ground_, now);
  if (before == now) return;
  const double block_m = world.block_size_m();
  if (!before || marks_block_m_ != block_m) {  // world positions count in blocks
    marks_block_m_ = block_m;
    marks_ = {}, handles_.clear(), lines_.clear();
    return;
  }
  SurfaceDifference differs(*before, now);
  const auto renew = [&](core::WorldPosition& at) {
    if (!differs.at(at.block)) return;
    at.local.y = world::surface_height_m(world, at);
    ++lookups_;
  };
  std::ranges::for_each(handles_, renew);
  for (auto& line : lines_)
    std::ranges::for_each(line, renew, &OnGround::at);
}

core::WorldPosition ToolOverlay::look_up(glm::dvec2 at_m, const world::World& world) {
  ++lookups_;
  return on_surface(at_m, world);
}

std::vector<ToolOverlay::OnGround> ToolOverlay::line_on_ground(
    const std::vector<glm::dvec2>& points, const world::World& world) {
  std::vector<OnGround> line;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 from = points[i], to = i + 1 < points.size() ? points[i + 1] : from;
    const int pieces =
        std::clamp(static_cast<int>(std::ceil(glm::length(to - from) / kPieceM)), 1, kMaxPieces);
    for (int k = 0; k < pieces; ++k)
      line.push_back({look_up(from + (to - from) * (static_cast<double>(k) / pieces), world), i});
  }
  return line;
}

void ToolOverlay::add_lines(const core::WorldPosition& eye, double block_m,
                            std::vector<render::Line>& lines) const {
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    for (std::size_t i = 1; i < lines_[l].size(); ++i)
      lines.push_back({lifted(lines_[l][i - 1].at, eye, block_m),
                       lifted(lines_[l][i].at, eye, block_m), marks_.lines[l].colour});
  }
}

void ToolOverlay::add_handles(const ViewProjection& view, render::HudDrawing& hud) const {
  const auto square = [&](glm::vec2 middle, float side, const glm::vec4& colour) {
    hud.areas.push_back({{{}, middle - side / 2}, {{}, {side, side}}, colour});
  };
  // The chosen handle covers the others.
  for (const bool chosen : {false, true}) {
    for (std::size_t i = 0; i < handles_.size(); ++i) {
      if (marks_.handles[i].chosen != chosen) continue;
      const auto pixel = view.pixel_of(handles_[i]);
      if (!pixel) continue;
      const float side = chosen ? kChosenPx : kHandlePx;
      square(*pixel, side + 2 * kBorderPx, kBorderColour);
      square(*pixel, side, chosen ? kChosenColour : kHandleColour);
    }
  }
}

void ToolOverlay::hit(QPointF pixel, const ViewProjection& view, ToolPoint& point) const {
  const glm::vec2 mouse(pixel.x(), pixel.y());
  float nearest = kReachHandlePx;
  for (std::size_t i = 0; i < handles_.size(); ++i) {
    const auto at = view.pixel_of(handles_[i]);
    const float away = at ? glm::length(*at - mouse) : nearest;
    if (away < nearest) nearest = away, point.handle = i;
  }
  if (point.handle) return;
  nearest = kReachLinePx;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    std::optional<glm::vec2> before;
    for (std::size_t i = 0; i < lines_[l].size(); ++i) {
      const auto at = view.pixel_of(lines_[l][i].at);
      const float away = before && at ? distance_to_segment(mouse, *before, *at) : nearest;
      if (away < nearest) nearest = away, point.line = {l, lines_[l][i - 1].part};
      before = at;
    }
  }
}

}  // namespace psygen::editor
