#include "game.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "engine/core/camera.hpp"
#include "engine/core/data_file.hpp"
#include "engine/platform/window.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"
#include "engine/telemetry/marks.hpp"

using namespace psygen;

namespace {
constexpr double kEyesM = 1.65;
}

core::Result<app::SessionOptions> Game::options() {
  const auto world = core::data_file("world.toml");
  if (!world) return tl::unexpected(world.error());
  app::Plugin plugin;
  plugin.name = "my game";
  plugin.add_systems = [this](scene::Systems& systems) { return add_figures(systems); };
  plugin.on_step = [this](app::Session& session, double step_s) { step(session, step_s); };
  plugin.on_gui = [this](app::Session& session) { draw_menu(session); };
  app::SessionOptions options;
  options.world_file = *world;
  options.plugins.push_back(plugin);
  return options;
}

core::Result<void> Game::add_figures(scene::Systems& systems) {
  const auto added =
      systems.figures.add({.name = "physics_ms", .kind = telemetry::FigureKind::kDuration});
  if (!added) return tl::unexpected(added.error());
  physics_ms_ = *added;
  return {};
}

core::Result<void> Game::start(app::Session& session) {
  landed_ = false;
  if (auto added = add_actions(session.actions()); !added) return added;
  const scene::WorldFacts& facts = session.scene().facts();
  query_.emplace(facts.world, facts.registry);
  auto physics = physics::World::create(*query_);
  if (!physics) return tl::unexpected(physics.error());
  physics_.emplace(std::move(*physics));
  const auto walker = physics_->add(physics::CharacterSettings{.feet = session.home().position});
  if (!walker) return tl::unexpected(walker.error());
  walker_ = *walker;
  if (session.window() != nullptr) session.window()->capture_cursor(true);
  return {};
}

core::Result<void> Game::add_actions(input::Actions& actions) {
  using platform::Key;
  using Way = input::MouseDirection;
  const std::pair<input::ActionId*, std::pair<const char*, std::vector<input::Binding>>> all[] = {
      {&ahead_, {"ahead", {{Key::kW}, {Key::kS, -1}}}},
      {&aside_, {"aside", {{Key::kD}, {Key::kA, -1}}}},
      {&run_, {"run", {{Key::kLeftShift}}}},
      {&jump_, {"jump", {{Key::kSpace}}}},
      {&look_x_, {"look_x", {{Way::kRight, 0.002F}, {Way::kLeft, -0.002F}}}},
      {&look_y_, {"look_y", {{Way::kUp, 0.002F}, {Way::kDown, -0.002F}}}},
  };
  for (const auto& [id, action] : all) {
    const auto added = actions.add(action.first, action.second);
    if (!added) return tl::unexpected(added.error());
    *id = *added;
  }
  return {};
}

void Game::step(app::Session& session, double step_s) {
  const auto value = [&](input::ActionId id) { return session.actions().state(id).value; };
  yaw_ += value(look_x_) * mouse_;
  pitch_ = std::clamp(pitch_ + value(look_y_) * mouse_, -1.5, 1.5);
  const double s = std::sin(yaw_), c = std::cos(yaw_);
  physics::CharacterInput wanted;
  wanted.direction = {s * value(ahead_) + c * value(aside_),
                      -c * value(ahead_) + s * value(aside_)};
  wanted.run = session.actions().state(run_).held;
  wanted.jump = session.actions().state(jump_).pressed;
  const core::WorldPosition before = physics_->state(walker_)->feet;
  {
    const telemetry::ScopedTime time(physics_ms_);
    (void)physics_->tell(walker_, wanted);
    (void)physics_->step(step_s);
  }
  if (!landed_ && physics_->state(walker_)->on_ground) {
    landed_ = true;
    session.scene().marks().set("landed");  // a section of the frame tests begins here
  }
  const core::WorldPosition feet = physics_->state(walker_)->feet;
  moved_ = feet.local + core::offset_m(feet.block, before, query_->world().block_size_m());
  way_m_ += std::hypot(moved_.x, moved_.z);
}

// Physics follows when an editor replaces the world, also by one with blocks of another size, so
// this keeps no positions.
core::CameraPose Game::eyes(double share) const {
  core::CameraPose pose;
  pose.position = physics_->state(walker_)->feet;
  pose.position.local -= moved_ * (1 - share);
  pose.position.local.y += kEyesM;
  pose.yaw = yaw_;
  pose.pitch = pitch_;
  return pose;
}

void Game::write_hud(app::Session& session) {
  if (session.input().was_pressed(platform::Key::kEscape)) open_menu(session, !menu_);
  char way[32];
  std::snprintf(way, sizeof(way), "%.0f m", way_m_);
  render::HudText text;
  text.text = way;
  text.at = {{0.5F, 0}, {0, 16}};  // top centre, 16 pixels below the edge
  text.align = render::HudAlign::kCentre;
  text.size_px = 40;
  text.outline_px = 2;
  session.hud().texts = {text};
}

void Game::open_menu(app::Session& session, bool open) {
  menu_ = open;
  session.set_paused(open);
  if (session.window() != nullptr) session.window()->capture_cursor(!open);
}

void Game::draw_menu(app::Session& session) {
  if (!menu_) return;
  ImGui::SetNextWindowPos({40, 40}, ImGuiCond_Once);
  ImGui::SetNextWindowSize({360, 150}, ImGuiCond_Once);
  ImGui::Begin("My game");
  ImGui::SliderFloat("mouse", &mouse_, 0.2F, 5);
  if (ImGui::Button("Resume")) open_menu(session, false);
  if (ImGui::Button("Quit")) session.close();
  ImGui::End();
}
