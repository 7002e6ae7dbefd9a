#include "editor/tools/place_tool.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "editor/document/qt_text.hpp"
#include "editor/tools/tool_host.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

constexpr double kMinExtentM = 0.3;
const glm::vec3 kPlacedColour{1.0F, 0.62F, 0.1F}, kNextColour{0.85F, 0.88F, 0.95F};

std::string toml_point(glm::dvec2 at_m) {
  return world::toml_vector(std::array{at_m.x, at_m.y});
}

// False for the ground, and for types that fail to give a size.
bool is_placeable(const models::ModelType& type) {
  const auto size = synthesis::mesh_size_guarded(type, models::default_parameters(type), 0);
  return size && size->layout == core::VertexLayout::kModel;
}

// Horizontal extent of a model from its base point.
double reach_m(const models::ModelType& type, const models::Parameters& parameters) {
  const core::Bounds box = type.bounds(parameters);
  return std::max(
      {double{-box.min.x}, double{-box.min.z}, double{box.max.x}, double{box.max.z}, kMinExtentM});
}

}  // namespace

const std::vector<std::string>& PlaceTool::types() const {
  if (listed_ == host_.document.parsed()) return types_;
  listed_ = host_.document.parsed();
  types_.clear();
  const models::Registry& registry = listed_->registry;
  for (auto i = static_cast<models::ModelIndex>(registry.size()); i-- > 0;) {
    const models::ModelType& type = registry[i];
    if (i != listed_->world.terrain_model && is_placeable(type)) types_.emplace_back(type.name());
  }
  return types_;
}

std::string PlaceTool::type() const {
  const std::vector<std::string>& all = types();
  if (all.empty() || std::ranges::find(all, type_) != all.end()) return type_;
  return all.front();
}

void PlaceTool::choose(std::optional<std::size_t> place) {
  cancel();
  place_ = place;
  host_.chosen(this->place() ? world::TextPath{"place", *place_} : world::TextPath{});
}

std::optional<std::size_t> PlaceTool::place() const {
  const bool there = place_ && *place_ < host_.document.world().places.all.size();
  return there ? place_ : std::nullopt;
}

void PlaceTool::press(const ToolPoint& at) {
  if (at.handle) {
    choose(*at.handle);
    return drag_.begin();
  }
  if (!at.ground_m) return host_.show_message(tr("There is no ground here. Click on the ground."));
  drag_.begin();
  add(to_decimetres(*at.ground_m));
}

void PlaceTool::add(glm::dvec2 at_m) {
  const std::size_t count = host_.document.world().places.all.size();
  const std::string table =
      "model = " + world::toml_string(type()) + "\nat_m = " + toml_point(at_m) + "\n";
  const QString step = tr("Place %1").arg(to_qstring(type()));
  const auto change = [&](std::string_view text) {
    return world::with_table_appended(text, {"place"}, table);
  };
  if (!host_.check(host_.document.edit(step, change))) {
    drag_.cancel();
    return;
  }
  place_ = count;
  if (place()) host_.chosen({"place", count});
}

void PlaceTool::drag(const ToolPoint& at) {
  hover_m_.reset();
  if (!drag_.active() || !place() || !at.ground_m) return;
  drag_.note(host_.document.edit(tr("Move model %1").arg(*place_ + 1), [&](std::string_view text) {
    return world::with_value(text, {"place", *place_, "at_m"},
                             toml_point(to_decimetres(*at.ground_m)));
  }));
}

void PlaceTool::hover(const ToolPoint& at) {
  hover_m_ = at.handle ? std::nullopt : at.ground_m;
}

void PlaceTool::click_right(const ToolPoint& at) {
  if (!at.handle || drag_.active()) return;
  choose(*at.handle);
  remove();
}

void PlaceTool::remove() {
  if (drag_.active()) return;
  if (!place()) return host_.show_message(tr("Click on a placed model first."));
  if (host_.check(host_.document.remove_table({"place", *place_}))) choose(std::nullopt);
}

bool PlaceTool::wheel(const ToolPoint& at, double steps) {
  if (!at.handle && !drag_.active()) return false;
  if (at.handle && !drag_.active() && place() != at.handle) choose(*at.handle);
  turn(steps * (at.fine ? kFineTurnDeg : kTurnDeg));
  return true;
}

void PlaceTool::turn(double degrees) {
  if (!place()) return host_.show_message(tr("Click on a placed model first."));
  Document& document = host_.document;
  const world::Place& turned = document.world().places.all[*place_];
  const models::ModelType& type = document.parsed()->registry[turned.model];
  const int parameter = models::parameter_index(type, "turn_deg");
  if (parameter < 0)
    return host_.show_message(
        tr("%1 cannot be turned. Only models with the parameter turn_deg can, such as those "
           "from files.")
            .arg(to_qstring(type.name())));
  double now =
      std::fmod(turned.parameters.real(static_cast<std::size_t>(parameter)) + degrees, 360);
  if (now < 0) now += 360;
  // Consecutive turns are one step.
  if (!drag_.active()) {
    if (turned_ == place_ && turn_drag_ != 0)
      document.resume_drag(turn_drag_);
    else
      turn_drag_ = document.begin_drag();
  }
  host_.check(document.edit(tr("Turn model %1").arg(*place_ + 1), [&](std::string_view text) {
    return world::with_value(text, {"place", *place_, "turn_deg"}, world::toml_number(now));
  }));
  if (!drag_.active()) document.end_drag();
  turned_ = place_;
}

const ToolMarks& PlaceTool::marks() {
  marks_ = {};
  const ParsedWorldPtr parsed = host_.document.parsed();
  const std::vector<world::Place>& places = parsed->world.places.all;
  for (std::size_t i = 0; i < places.size(); ++i)
    marks_.handles.push_back({places[i].at_m, place() == i});
  if (place()) {
    const world::Place& chosen = places[*place_];
    const models::ModelType& type = parsed->registry[chosen.model];
    const double radius_m = reach_m(type, chosen.parameters);
    marks_.lines.push_back(circle_mark(chosen.at_m, radius_m, kPlacedColour));
    if (const int turn = models::parameter_index(type, "turn_deg"); turn >= 0) {
      const double angle =
          chosen.parameters.real(static_cast<std::size_t>(turn)) * std::numbers::pi / 180;
      const glm::dvec2 front =
          chosen.at_m + radius_m * glm::dvec2(std::sin(angle), std::cos(angle));
      marks_.lines.push_back({{chosen.at_m, front}, kPlacedColour});
    }
  }
  const int next = parsed->registry.find(type());
  if (hover_m_ && next >= 0) {
    const models::ModelType& type = parsed->registry[static_cast<models::ModelIndex>(next)];
    marks_.lines.push_back(
        circle_mark(*hover_m_, reach_m(type, models::default_parameters(type)), kNextColour));
  }
  return marks_;
}

}  // namespace psygen::editor
