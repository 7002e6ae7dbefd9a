// Paints the masks of scatters on the ground: instances grow where a mask is white, none where it
// is black. A stroke is one undo step. The document keeps the image in memory until the world is
// saved. Ground kinds and patches of a scatter are fields of its section. Main thread.
#pragma once

#include <optional>
#include <string>

#include "editor/tools/mask_stroke.hpp"
#include "editor/tools/new_mask.hpp"
#include "editor/tools/tool_host.hpp"
#include "editor/view/view_tool.hpp"

namespace psygen::editor {

// At most one scatter is chosen, and at most one stroke is active.
class MaskTool final : public ViewTool {
 public:
  static constexpr double kMinRadiusM = 0.5, kMaxRadiusM = 500;

  // The document of the host outlives the tool.
  explicit MaskTool(ToolHost host) : host_(std::move(host)) {}

  // The [[scatter]] whose mask is painted; nullopt also if it no longer exists.
  void choose(std::optional<std::size_t> scatter);
  std::optional<std::size_t> scatter() const;
  // True if the scatter has a mask image.
  bool has_picture() const;
  // Area and resolution of the next new mask: as set, else the world's default.
  NewMask new_mask() const;
  void set_new_mask(std::optional<NewMask> mask) { new_mask_ = mask; }
  // Gives the chosen scatter a white mask of this area and resolution, around the view's middle.
  // One undo step.
  void make_mask();

  // The brush of the next stroke.
  const Brush& brush() const { return brush_; }
  void set_radius_m(double radius_m);
  void set_strength(double strength) { brush_.strength = strength; }
  void set_erases(bool erases) { brush_.erases = erases; }

  // Shift swaps painting and erasing.
  void press(const ToolPoint& at) override;
  void drag(const ToolPoint& at) override;
  void release() override;
  void hover(const ToolPoint& at) override { hover_m_ = at.ground_m; }
  void leave() override { hover_m_.reset(); }
  void click_right(const ToolPoint&) override {}
  bool cancel() override;
  // The brush, the mask's values around it (green to red), and the border of its area, or of the
  // area of a new mask.
  const ToolMarks& marks() override;

 private:
  const world::ScatterMask& mask() const;
  QString model_name() const;
  std::string free_name() const;
  void save_stroke(std::string name, const MaskStroke& stroke);

  ToolHost host_;
  std::optional<std::size_t> scatter_;
  std::optional<NewMask> new_mask_;  // as set by the user
  Brush brush_;
  std::optional<MaskStroke> stroke_;
  std::optional<glm::dvec2> hover_m_;
  ToolMarks marks_;
};

}  // namespace psygen::editor
