// What pictures beside the view must know of it: where its camera is and how large it is.
#pragma once

#include <functional>
#include <optional>

#include "editor/pictures/picture_request.hpp"

namespace psygen::editor {

struct ViewState {
  PicturePlace place;   // as the view stands
  double above_m = 0;   // of its eye over the ground or water below
  double now_s = 0;     // of its clock
  core::Extent size{};  // device pixels
};
// Nothing while there is no view.
using AskView = std::function<std::optional<ViewState>()>;

}  // namespace psygen::editor
