#include "game/show/sounds.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace cairns {
namespace {

constexpr double kFadePerS = 0.8;  // change of a loop's gain per second
constexpr double kTitleWind = 0.15;

}  // namespace

Sounds::Sounds(double block_m, audio::Destination destination)
    : audio_({.destination = destination, .block_size_m = block_m}),
      coming_(std::async(std::launch::async, make_clips)) {}

void Sounds::set_volumes(double effects, double music) {
  audio_.set_volume(audio::Bus::kEffects, effects);
  audio_.set_volume(audio::Bus::kMusic, music);
}

// Fades a loop towards a gain, and starts or stops it.
void Sounds::hold(Loop& loop, const ClipPtr& clip, double gain, double dt_s,
                  const std::optional<core::WorldPosition>& at) {
  const double most = kFadePerS * dt_s;
  loop.gain += std::clamp(gain - loop.gain, -most, most);
  if (at) loop.at = at;  // a fading loop keeps its position
  const audio::Play how{.at = loop.at, .range = {2, 30}, .gain = loop.gain, .loop = true};
  if (loop.sound == audio::SoundId::kNone && loop.gain > 0.01) {
    if (const auto sound = audio_.play(clip, how)) loop.sound = *sound;
  } else if (loop.sound != audio::SoundId::kNone) {
    (void)audio_.change(loop.sound, how);
    if (loop.gain <= 0.01) {
      audio_.stop(loop.sound);
      loop.sound = audio::SoundId::kNone;
    }
  }
}

void Sounds::update(Play* play, const core::CameraPose& ears, double dt_s) {
  using namespace std::chrono_literals;
  if (!clips_ && coming_.wait_for(0s) == std::future_status::ready) {
    clips_ = coming_.get();
    (void)audio_.play(clips_->music, {.gain = 0.9, .loop = true, .bus = audio::Bus::kMusic});
  }
  if (play != nullptr && clips_) {
    const Weather weather = play->weather();
    const core::WorldPosition& feet = play->progress().feet;
    const double height = std::clamp((feet.local.y - 40) / 150, 0.0, 1.0);
    const double speed = play->walker().gait() == Gait::kGlide ? 0.35 : 0;
    hold(wind_, clips_->wind,
         0.12 + 0.35 * height + 0.03 * std::hypot(weather.wind.x, weather.wind.z) + speed, dt_s);
    hold(rain_, clips_->rain, feet.local.y > kSnowLineM ? 0 : 0.5 * weather.wet, dt_s);
    const double above = feet.local.y - play->world().water.level_m;
    hold(water_, clips_->water, 0.4 * std::clamp(1 - above / 6, 0.0, 1.0), dt_s);
    const Fire* fire = play->fire_near(30);
    hold(fire_, clips_->fire, fire != nullptr ? 0.9 : 0, dt_s,
         fire != nullptr ? std::optional(fire->at) : std::nullopt);
    sing(*play, dt_s);
  } else if (clips_) {
    hold(wind_, clips_->wind, kTitleWind, dt_s);
    hold(rain_, clips_->rain, 0, dt_s);
    hold(water_, clips_->water, 0, dt_s);
    hold(fire_, clips_->fire, 0, dt_s);
  }
  audio_.update(ears, dt_s);
}

// Birds sing at their positions, most often in the morning.
void Sounds::sing(Play& play, double dt_s) {
  until_song_s_ -= dt_s;
  if (until_song_s_ > 0) return;
  core::RandomStream random(songs_++, 0, 0, 0, core::Purpose::kSeed);
  const double hour = play.hour();
  const bool morning = hour > 4.5 && hour < 9.5;
  until_song_s_ = random.next_real(1, morning ? 4 : 12);
  if (hour < 4.5 || hour > 20.5 || play.weather().wet > 0.5) return;
  const auto& all = play.creatures().all();
  if (all.empty()) return;
  const auto last = static_cast<std::int64_t>(all.size()) - 1;
  const Creature& c = all[static_cast<std::size_t>(random.next_integer(0, last))];
  if (c.kind != Kind::kBird) return;
  (void)audio_.play(
      clips_->birds[songs_ % clips_->birds.size()],
      {.at = c.at, .range = {6, 120}, .gain = 0.6, .pitch = random.next_real(0.85, 1.2)});
}

void Sounds::tell(const Happening& happening, Play& play) {
  if (!clips_) return;
  const auto here = [&](const ClipPtr& clip, double gain, double pitch = 1) {
    (void)audio_.play(clip, {.at = happening.at, .range = {3, 60}, .gain = gain, .pitch = pitch});
  };
  using enum Happening::Kind;
  const Happening::Kind kind = happening.kind;
  if (kind == kFound) (void)audio_.play(clips_->chime, {.gain = 1});
  if (kind == kGathered || kind == kBuilt) here(clips_->stone, 0.8);
  if (kind == kChopped) here(clips_->chop, 0.8);
  if (kind == kFelled) here(clips_->fall, 1);
  if (kind == kSplashed) here(clips_->splash, 0.8);
  const auto ground = play.query().ground(happening.at);
  if ((kind != kLanded && kind != kStepped) || !ground) return;
  const bool soft = ground->kind == world::GroundKind::kSnow;
  const bool hard = ground->kind == world::GroundKind::kRock;
  const ClipPtr& step = clips_->steps[soft ? 0 : hard ? 2 : 1];
  here(ground->water_depth_m > 0 ? clips_->splash : step, kind == kLanded ? 0.9 : 0.35,
       0.92 + 0.16 * std::fmod(play.walker().walked_m() * 0.731, 1.0));
}

}  // namespace cairns
