// Masks of what is scattered, painted on the ground: white lets instances stand, black none. A
// stroke is one undo step. The picture is held by the document until the world is saved. Which
// kinds of ground and patches allow instances are fields of the scatter. Main thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "editor/tools/mask_stroke.hpp"
#include "editor/tools/new_mask.hpp"
#include "editor/tools/tool_host.hpp"
#include "editor/view/view_tool.hpp"

namespace psygen::editor {

class MaskTool final : public ViewTool {
 public:
  static constexpr double kMinRadiusM = 0.5, kMaxRadiusM = 500;

  explicit MaskTool(ToolHost host) : host_(std::move(host)) {}

  // The [[scatter]] whose mask is painted; nothing where it is gone.
  void choose(std::optional<std::size_t> scatter);
  std::optional<std::size_t> scatter() const;
  // Whether it has a picture to paint on.
  bool has_picture() const;
  // Area and resolution of the next new mask: those that were set, else the world's default.
  NewMask new_mask() const;
  void set_new_mask(std::optional<NewMask> mask) { new_mask_ = mask; }
  // Gives the chosen scatter a white picture like that, around what the view shows. One undo step.
  void make_mask();

  const Brush& brush() const { return brush_; }
  void set_radius_m(double radius_m);
  void set_strength(double strength) { brush_.strength = strength; }
  void set_erases(bool erases) { brush_.erases = erases; }

  // Shift turns painting into erasing, and the other way round.
  void press(const ToolPoint& at) override;
  void drag(const ToolPoint& at) override;
  void release() override;
  void hover(const ToolPoint& at) override { hover_m_ = at.ground_m; }
  void leave() override { hover_m_.reset(); }
  void click_right(const ToolPoint&) override {}
  bool cancel() override;
  // The brush, what the mask has around it (green to red), and the border of its area, or of the
  // one that a new mask would have.
  const ToolMarks& marks() override;

 private:
  const world::ScatterMask& mask() const;
  QString model_name() const;
  std::string free_name() const;
  void keep(std::string name, const MaskStroke& stroke);

  ToolHost host_;
  std::optional<std::size_t> scatter_;
  std::optional<NewMask> new_mask_;  // as the person has set it
  Brush brush_;
  std::optional<MaskStroke> stroke_;
  std::optional<glm::dvec2> hover_m_;
  ToolMarks marks_;
};

}  // namespace psygen::editor
