// A text on the HUD and a menu with Dear ImGui. Escape opens the menu and pauses the game. With the
// name of a PNG file, it saves an image with both instead of opening a window.
//   example_hud [picture.png]
#include <imgui/imgui.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/data_file.hpp"
#include "engine/platform/input.hpp"
#include "engine/program/program.hpp"
#include "engine/scene/scene.hpp"

using namespace psygen;

namespace {

struct Menu {
  bool open = false;
  float speed = 0.1F;  // radians per second
};

void draw_menu(app::Session& session, Menu& menu) {
  if (!menu.open) return;
  ImGui::SetNextWindowPos({40, 40}, ImGuiCond_Once);
  ImGui::SetNextWindowSize({360, 150}, ImGuiCond_Once);
  ImGui::Begin("Menu");
  ImGui::SliderFloat("turning", &menu.speed, 0, 1);
  if (ImGui::Button("Resume")) {
    menu.open = false;
    session.set_paused(false);
  }
  if (ImGui::Button("Quit")) session.close();
  ImGui::End();
}

void draw_hud(app::Session& session, double time_s) {
  char clock[32];
  std::snprintf(clock, sizeof(clock), "%.1f s", time_s);
  render::HudText text;
  text.text = clock;
  text.at = {{0.5F, 0}, {0, 16}};  // top centre, 16 pixels below the edge
  text.align = render::HudAlign::kCentre;
  text.size_px = 48;
  text.outline_px = 2;
  session.hud().texts = {text};
}

core::Result<void> play(int argc, char** argv) {
  const auto world = core::data_file("worlds/lakes.toml");
  if (!world) return tl::unexpected(world.error());
  Menu menu{.open = argc > 1};
  app::Plugin plugin;
  plugin.name = "menu";
  plugin.on_gui = [&menu](app::Session& session) { draw_menu(session, menu); };
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = argc > 1;
  options.plugins.push_back(plugin);
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  core::CameraPose pose = (*session)->home();
  if (auto ok = (*session)->prepare(pose); !ok) return tl::unexpected(ok.error());

  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  double dt_s = 1.0 / 60;
  for (int frame = 0; (*session)->poll() && (argc == 1 || frame < 3); ++frame) {
    if ((*session)->input().was_pressed(platform::Key::kEscape)) {
      menu.open = !menu.open;
      (*session)->set_paused(menu.open);
    }
    draw_hud(**session, (*session)->now_s());
    if (!menu.open) pose.yaw += double{menu.speed} * dt_s;
    if (auto ok = (*session)->tick(pose, dt_s); !ok) return tl::unexpected(ok.error());
    const Clock::time_point now = Clock::now();
    dt_s = std::chrono::duration<double>(now - std::exchange(last, now)).count();
  }
  if (argc == 1) return {};
  if (auto ok = (*session)->save_picture(argv[1]); !ok) return tl::unexpected(ok.error());
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  return program::run("example_hud", [&] { return play(argc, argv); });
}
