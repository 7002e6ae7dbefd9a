#include "editor/tools/mask_tool.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "editor/document/qt_text.hpp"
#include "editor/tools/tool_host.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

constexpr int kBorderPieces = 32;
constexpr int kTicks = 9;  // on each side of the brush's middle
const glm::vec3 kBrushColour{0.95F, 0.96F, 1.0F}, kEraserColour{1.0F, 0.45F, 0.35F},
    kAreaColour{0.45F, 0.75F, 1.0F}, kPlannedColour{0.25F, 0.45F, 0.65F},
    kFullColour{0.35F, 0.95F, 0.35F}, kEmptyColour{0.95F, 0.25F, 0.2F};

// Divides the sides, because the view limits the pieces between two points of a line.
ToolMarks::Line border(const std::array<double, 4>& area, const glm::vec3& colour) {
  const glm::dvec2 corners[] = {{area[0], area[1]},
                                {area[2], area[1]},
                                {area[2], area[3]},
                                {area[0], area[3]},
                                {area[0], area[1]}};
  ToolMarks::Line line;
  line.colour = colour;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < kBorderPieces; ++i)
      line.points_m.push_back(corners[side] + (corners[side + 1] - corners[side]) *
                                                  (static_cast<double>(i) / kBorderPieces));
  }
  line.points_m.push_back(corners[0]);
  return line;
}

// Short strokes on the ground, coloured by the mask.
void add_ticks(const world::GreyPicture& picture, const std::array<double, 4>& area,
               glm::dvec2 middle_m, double radius_m, std::vector<ToolMarks::Line>& lines) {
  const double step_m = 1.5 * radius_m / kTicks;
  for (int z = -kTicks; z <= kTicks; ++z) {
    for (int x = -kTicks; x <= kTicks; ++x) {
      if (x * x + z * z > kTicks * kTicks) continue;
      const glm::dvec2 at = middle_m + glm::dvec2(x, z) * step_m;
      const double u = (at.x - area[0]) / (area[2] - area[0]);
      const double v = (at.y - area[1]) / (area[3] - area[1]);
      if (u < 0 || u > 1 || v < 0 || v > 1) continue;
      const auto value = static_cast<float>(picture.at(u, v));
      const glm::dvec2 half(step_m * 0.2, 0);
      lines.push_back(
          {{at - half, at + half}, kEmptyColour + (kFullColour - kEmptyColour) * value});
    }
  }
}

bool is_png(const std::string& name) {
  return to_qstring(name).endsWith(QStringLiteral(".png"), Qt::CaseInsensitive);
}

}  // namespace

void MaskTool::choose(std::optional<std::size_t> scatter) {
  cancel();
  scatter_ = scatter;
  host_.chosen(this->scatter() ? world::TextPath{"scatter", *scatter_} : world::TextPath{});
}

std::optional<std::size_t> MaskTool::scatter() const {
  const bool there = scatter_ && *scatter_ < host_.document.world().scatter.size();
  return there ? scatter_ : std::nullopt;
}

const world::ScatterMask& MaskTool::mask() const {
  return host_.document.world().scatter[*scatter_].mask;
}

bool MaskTool::has_picture() const {
  return scatter() && mask().picture != nullptr;
}

QString MaskTool::model_name() const {
  const ParsedWorldPtr parsed = host_.document.parsed();
  const std::string_view name = parsed->registry[parsed->world.scatter[*scatter_].model].name();
  return to_qstring(name);
}

// A file name beside the world file that neither the folder nor the world has yet.
std::string MaskTool::free_name() const {
  const std::filesystem::path& file = host_.document.file();
  const std::string start =
      (file.empty() ? "" : file.stem().string() + "_") + model_name().toStdString() + "_mask";
  for (int number = 1;; ++number) {
    const std::string name = start + (number == 1 ? "" : fmt::format("_{}", number)) + ".png";
    std::error_code error;
    const bool taken = host_.document.picture(name) != nullptr ||
                       std::filesystem::exists(file.parent_path() / name, error);
    if (!taken) return name;
  }
}

NewMask MaskTool::new_mask() const {
  return new_mask_.value_or(default_new_mask(host_.document.world()));
}

void MaskTool::make_mask() {
  cancel();
  if (!scatter()) return host_.show_message(tr("Choose a scatter layer for the mask first."));
  if (has_picture()) return host_.show_message(tr("This layer has a mask. Paint on the ground."));
  const world::World& world = host_.document.world();
  const auto plan = plan_of(new_mask(), world, host_.around(new_mask().side_m));
  if (!plan) return host_.show_message(to_qstring(plan.error().message));
  auto picture = std::make_shared<world::GreyPicture>();
  picture->width = plan->width, picture->height = plan->height;
  picture->pixels.assign(std::size_t{plan->width} * plan->height, 65535);
  picture->hash = world::content_hash(*picture);
  const std::string name = free_name();
  const world::TextPath path{"scatter", *scatter_};
  const auto text =
      world::with_value(host_.document.text(), path.with("mask_image"), world::toml_string(name))
          .and_then([&](const std::string& with_image) {
            return world::with_value(with_image, path.with("mask_area_m"),
                                     world::toml_vector(plan->area_m));
          });
  if (!text) return host_.show_message(to_qstring(text.error().message));
  const auto done = host_.document.paint(tr("New mask of %1").arg(model_name()),
                                         {PaintChange(name, nullptr, picture)}, *text);
  if (!host_.check(done)) return;
  host_.show_message(
      tr("%1 now appears only inside the blue border. Erase to remove it there. Saving the "
         "world writes the mask to %2.")
          .arg(model_name(), to_qstring(name)));
}

void MaskTool::set_radius_m(double radius_m) {
  brush_.radius_m = std::clamp(radius_m, kMinRadiusM, kMaxRadiusM);
}

void MaskTool::press(const ToolPoint& at) {
  hover_m_ = at.ground_m;
  if (!scatter()) return host_.show_message(tr("Choose the mask to paint first."));
  if (!has_picture())
    return host_.show_message(tr("%1 has no mask yet. Click \"New mask\".").arg(model_name()));
  if (!at.ground_m) return host_.show_message(tr("There is no ground here. Paint on the ground."));
  Brush brush = brush_;
  if (at.fine) brush.erases = !brush.erases;
  stroke_.emplace(mask().picture, mask().area_m, brush);
  host_.set_dragging(true);
  drag(at);
  if (stroke_ && !stroke_->has_met())
    host_.show_message(tr("The brush is outside the mask. Paint inside the blue border."));
}

void MaskTool::drag(const ToolPoint& at) {
  hover_m_ = at.ground_m;
  if (!stroke_ || !at.ground_m) return;
  // The mask was undone or replaced during the stroke.
  if (!has_picture() || mask().picture->hash != stroke_->now()->hash) {
    stroke_.reset();
    return host_.set_dragging(false);
  }
  if (stroke_->go_to(*at.ground_m) &&
      !host_.check(host_.document.preview_picture(mask().image, stroke_->now())))
    cancel();
}

void MaskTool::release() {
  if (!stroke_) return;
  const MaskStroke stroke = std::move(*stroke_);
  stroke_.reset();
  if (has_picture() && mask().picture->hash == stroke.now()->hash)
    save_stroke(mask().image, stroke);
  host_.set_dragging(false);
}

void MaskTool::save_stroke(std::string name, const MaskStroke& stroke) {
  if (stroke.now()->hash == stroke.before()->hash) return;
  const QString step = tr("Paint the mask of %1").arg(model_name());
  if (is_png(name)) {
    host_.check(host_.document.paint(
        step, {PaintChange::between(name, *stroke.before(), *stroke.now(), stroke.touched())},
        host_.document.text()));
    return;
  }
  // Other formats are read-only, so the stroke goes to a new image.
  const std::string png = free_name();
  const auto text = world::with_value(host_.document.text(), {"scatter", *scatter_, "mask_image"},
                                      world::toml_string(png));
  host_.check(host_.document.preview_picture(name, stroke.before()));
  if (!text) return host_.show_message(to_qstring(text.error().message));
  if (host_.check(host_.document.paint(step, {PaintChange(png, nullptr, stroke.now())}, *text)))
    host_.show_message(tr("%1 is unchanged. The mask is saved as PNG, in %2.")
                           .arg(to_qstring(name), to_qstring(png)));
}

bool MaskTool::cancel() {
  if (!stroke_) return false;
  const MaskStroke stroke = std::move(*stroke_);
  stroke_.reset();
  host_.set_dragging(false);
  if (has_picture() && mask().picture->hash == stroke.now()->hash)
    host_.check(host_.document.preview_picture(mask().image, stroke.before()));
  return true;
}

const ToolMarks& MaskTool::marks() {
  marks_ = {};
  if (has_picture()) {
    marks_.lines.push_back(border(mask().area_m, kAreaColour));
  } else if (scatter()) {
    const auto area = area_of(new_mask(), host_.document.world(), host_.around(new_mask().side_m));
    marks_.lines.push_back(border(area, kPlannedColour));
  }
  if (!hover_m_) return marks_;
  const glm::vec3 colour = brush_.erases ? kEraserColour : kBrushColour;
  marks_.lines.push_back(circle_mark(*hover_m_, brush_.radius_m, colour));
  if (has_picture())
    add_ticks(*mask().picture, mask().area_m, *hover_m_, brush_.radius_m, marks_.lines);
  return marks_;
}

}  // namespace psygen::editor
