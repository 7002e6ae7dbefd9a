#include "game/show/hud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "game/show/controls.hpp"

namespace cairns {
namespace {

constexpr double kCompassHalf = 0.95;   // radians on each side of its centre
constexpr float kCompassShare = 0.17F;  // half its width, as a fraction of the image
constexpr float kBarPx = 160;

}  // namespace

void Hud::say(std::string line, std::string help, double seconds) {
  line_ = std::move(line);
  help_ = std::move(help);
  left_s_ = seconds;
}

void Hud::tell(const Happening& happening) {
  using enum Happening::Kind;
  if (happening.kind == kFound) {
    const Chapter& chapter = kChapters[happening.number];
    say("“" + std::string(chapter.line) + "”",
        std::string("You have ") + chapter.gift + ". " + chapter.help, 11);
  } else if (happening.kind == kRefused) {
    say(happening.why);
  } else if (happening.kind == kSlept) {
    say("You wake with the birds.");
  } else if (happening.kind == kBuilt) {
    say("A cairn of your own. It is on the map.");
  }
}

void Hud::write(std::string text, const render::HudPlace& at, float size_px, float opacity,
                render::HudAlign align) {
  render::HudText out;
  out.text = std::move(text);
  out.at = {at.share, at.px * size_};
  out.align = align;
  out.vertical = render::HudVertical::kMiddle;
  out.size_px = size_px * size_;
  out.colour.w = opacity;
  out.outline_px = 1.5F * size_;
  out.outline_colour.w = 0.7F * opacity;
  drawing_.texts.push_back(std::move(out));
}

void Hud::bar(const render::HudPlace& at, double share) {
  const auto part = [&](float width_px, const glm::vec4& colour) {
    drawing_.areas.push_back({{at.share, (at.px - glm::vec2(kBarPx / 2, 0)) * size_},
                              {{0, 0}, glm::vec2(width_px, 6) * size_},
                              colour});
  };
  part(kBarPx, {0, 0, 0, 0.45F});
  part(kBarPx * static_cast<float>(std::clamp(share, 0.0, 1.0)), mark_);
}

void Hud::draw_compass(const Play& play, bool zoom) {
  const double yaw = play.walker().yaw();
  const auto place = [&](double heading) {
    const double turn = std::remainder(heading - yaw, 2 * std::numbers::pi);
    return static_cast<float>(std::clamp(turn / kCompassHalf, -1.0, 1.0));
  };
  constexpr std::array<const char*, 8> kNames{"N", "·", "E", "·", "S", "·", "W", "·"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const float x = place(static_cast<double>(i) * std::numbers::pi / 4);
    if (std::abs(x) < 1) write(kNames[i], {{0.5F + kCompassShare * x, 0}, {0, 26}}, 20, 1 - x * x);
  }
  const auto next = play.next_cairn();
  if (!next) return;
  const glm::dvec3 way = way_m(play.progress().feet, play.route().cairns[*next], play.block_m());
  const float x = place(std::atan2(way.x, -way.z));
  std::string mark = x <= -1 ? "◄" : x >= 1 ? "►" : "▲";
  write(mark, {{0.5F + kCompassShare * x, 0}, {0, 50}}, 22);
  drawing_.texts.back().colour = mark_;
  if (zoom)
    write(std::to_string(static_cast<int>(std::hypot(way.x, way.z))) + " m",
          {{0.5F + kCompassShare * x, 0}, {0, 76}}, 20);
}

void Hud::draw_doing(const Play& play, app::Session& session) {
  const input::Actions& actions = session.actions();
  const auto key = [&](Act act) { return "[" + key_of(actions, act, session.window()) + "]  "; };
  const render::HudPlace below{{0.5F, 1}, {0, -70}};
  using enum Target::Kind;
  const Target::Kind target = play.target().kind;
  if (play.felling() > 0) {
    bar(below, play.felling());
  } else if (target == kStone) {
    write(key(Act::kUse) + "take the stone", below, 24);
  } else if (target == kTree) {
    write(key(Act::kUse) + "hold to fell the tree", below, 24, 0.8F);
  } else if (play.fire_near(5) != nullptr && play.is_night()) {
    write(key(Act::kSleep) + "sleep until morning", below, 24);
  } else if (play.progress().stock.stones >= kStonesOfCairn) {
    write(key(Act::kBuild) + "build a cairn", below, 22, 0.55F);
  }
  if (play.walker().breath() < 1) bar({{0.5F, 1}, {0, -44}}, play.walker().breath());
  std::string carried;
  const Stock& stock = play.progress().stock;
  if (stock.stones > 0) carried += "stones " + std::to_string(stock.stones) + "   ";
  if (stock.wood > 0) carried += "wood " + std::to_string(stock.wood) + "   ";
  carried += "cairns " + std::to_string(play.progress().found.count()) + " of 12";
  write(carried, {{0, 1}, {24, -30}}, 20, 0.85F, render::HudAlign::kLeft);
}

void Hud::draw_line(double dt_s) {
  left_s_ -= dt_s;
  if (left_s_ <= 0) return;
  const auto opacity = static_cast<float>(std::min(left_s_, 1.0));
  write(line_, {{0.5F, 0.68F}, {0, 0}}, help_.empty() ? 26 : 30, opacity);
  if (!help_.empty()) write(help_, {{0.5F, 0.68F}, {0, 40}}, 22, opacity);
}

render::HudDrawing Hud::draw(const Play& play, app::Session& session, const Settings& settings,
                             bool zoom, double dt_s) {
  drawing_ = {};
  size_ =
      static_cast<float>(settings.text) * static_cast<float>(session.picture_size().height) / 720;
  mark_ = settings.colour_blind ? glm::vec4(1, 1, 1, 1) : glm::vec4(1, 0.72F, 0.30F, 1);
  draw_compass(play, zoom);
  draw_doing(play, session);
  draw_line(dt_s);
  return std::move(drawing_);
}

}  // namespace cairns
