#include "game/show/sounds.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "engine/audio/tones.hpp"
#include "engine/core/hash.hpp"

namespace cairns {
namespace {

constexpr double kFadePerS = 0.8;  // change of a loop's gain per second
constexpr double kTitleWind = 0.15;

using audio::add, audio::add_tone, audio::looped, audio::noise, audio::shape;
using audio::Samples, audio::samples_of;

ClipPtr clip(std::span<const float> left, std::span<const float> right = {}) {
  return std::make_shared<const audio::Clip>(audio::clip_of(left, right));
}

Samples shaped(Samples samples, const std::function<float(float)>& gain) {
  shape(samples, gain);
  return samples;
}

ClipPtr fire_sound() {
  Samples out = shaped(noise(4, 80, 700, 4), [](float) { return 0.5F; });
  core::RandomStream random(5, 0, 0, 0, core::Purpose::kStructure);
  for (int i = 0; i < 60; ++i) {
    const Samples crack = noise(0.02, 800, 6000, 100 + static_cast<std::uint64_t>(i));
    const double at_s = random.next_real(0, 3.9);
    add(out, at_s, crack, static_cast<float>(random.next_real(0.3, 1.4)), 0);
  }
  return clip(looped(out, 0.4));
}

// Slow chords of a pentatonic scale with a few notes above each, in stereo.
ClipPtr music_sound(std::uint64_t seed) {
  constexpr std::array<double, 5> kScale{1, 9.0 / 8, 5.0 / 4, 3.0 / 2, 5.0 / 3};
  constexpr double kSeconds = 64, kChordS = 8;
  core::RandomStream random(seed, 0, 0, 0, core::Purpose::kColour);
  const double root = 98 * std::pow(2.0, static_cast<double>(random.next_integer(0, 4)) / 12);
  std::array<Samples, 2> sides{Samples(samples_of(kSeconds)), Samples(samples_of(kSeconds))};
  for (int chord = 0; chord < static_cast<int>(kSeconds / kChordS); ++chord) {
    const double at = chord * kChordS;
    const auto base = static_cast<std::size_t>(random.next_integer(0, 4));
    for (std::size_t voice = 0; voice < 3; ++voice) {
      const std::size_t note = base + 2 * voice;
      const double hz = root * kScale[note % 5] * (1 + static_cast<double>(note / 5));
      for (std::size_t side = 0; side < 2; ++side)
        add_tone(sides[side], at + 0.35 * static_cast<double>(voice), hz * (side == 0 ? 1 : 1.003),
                 0.05F, 2.6, {0.25F, 0.1F});
    }
    for (int note = 0; note < 3; ++note) {
      if (random.next_unit() < 0.35) continue;
      const auto step = static_cast<std::size_t>(random.next_integer(0, 9));
      const double hz = 4 * root * kScale[step % 5] * (step > 4 ? 2 : 1);
      const auto side = static_cast<std::size_t>(random.next_integer(0, 1));
      add_tone(sides[side], at + random.next_real(0.5, 5), hz, 0.035F, 1.3, {0.3F});
    }
  }
  return clip(sides[0], sides[1]);
}

// `hardness` is 0 (snow) to 1 (rock).
ClipPtr step_sound(float hardness) {
  return clip(shaped(noise(0.16, 120 + 500 * hardness, 900 + 3500 * hardness, 7),
                     [&](float t) { return 2.2F * std::exp(-t * (22 + 30 * hardness)); }));
}

ClipPtr chop_sound() {
  Samples out = shaped(noise(0.22, 200, 2500, 9), [](float t) { return 1.1F * std::exp(-38 * t); });
  add_tone(out, 0, 190, 0.7F, 0.035, {0.5F, 0.3F});
  return clip(out);
}

ClipPtr stone_sound() {
  Samples out(samples_of(0.3));
  add_tone(out, 0, 1250, 0.5F, 0.02, {0.6F, 0.4F});
  add_tone(out, 0.07, 980, 0.3F, 0.02, {0.6F, 0.3F});
  return clip(out);
}

ClipPtr bird_sound(int which) {
  Samples out(samples_of(0.9));
  core::RandomStream random(40 + static_cast<std::uint64_t>(which), 0, 0, 0,
                            core::Purpose::kColour);
  float phase = 0;
  for (int call = 0; call < 3 + which; ++call) {
    const std::size_t from = samples_of(0.13 * call + 0.02), length = samples_of(0.08);
    const auto hz = static_cast<float>(random.next_real(2600, 4600));
    const auto bend = static_cast<float>(random.next_real(-900, 1200));
    for (std::size_t i = 0; i < length && from + i < out.size(); ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(length);
      phase += 2 * std::numbers::pi_v<float> * (hz + bend * t) / audio::kToneRateHz;
      out[from + i] += 0.35F * std::sin(std::numbers::pi_v<float> * t) * std::sin(phase);
    }
  }
  return clip(out);
}

// A discovered cairn.
ClipPtr chime_sound() {
  Samples out(samples_of(4));
  int i = 0;
  for (const double ratio : {1.0, 1.25, 1.5, 2.0, 2.5})
    add_tone(out, 0.16 * i++, 392 * ratio, 0.16F, 0.9, {0.3F, 0.12F});
  return clip(out);
}

}  // namespace

Clips make_clips() {
  Clips made;
  const auto swelling = [](float t) {
    return 2.2F + 0.9F * std::sin(0.9F * t) * std::sin(0.57F * t + 1);
  };
  made.wind = clip(looped(shaped(noise(11, 60, 480, 1), swelling), 1.5));
  made.rain = clip(looped(shaped(noise(5, 900, 7000, 2), [](float) { return 0.8F; }), 0.6));
  const auto lapping = [](float t) {
    return 1.0F + 0.8F * std::sin(1.8F * t) * std::sin(1.1F * t);
  };
  made.water = clip(looped(shaped(noise(7, 150, 900, 3), lapping), 1));
  made.stream = clip(looped(
      shaped(noise(6, 300, 4200, 5), [](float t) { return 0.9F + 0.15F * std::sin(7.3F * t); }),
      0.8));
  made.fire = fire_sound();
  made.music = music_sound(1);
  made.splash = clip(shaped(noise(0.9, 250, 3500, 8), [](float t) {
    return 1.4F * std::min(t * 40, 1.0F) * std::exp(-4 * t);
  }));
  made.chop = chop_sound();
  made.fall = clip(shaped(noise(2.2, 70, 1600, 10), [](float t) {
    const float creak = t < 1.5F ? 0.3F * t * (0.6F + 0.4F * std::sin(70 * t)) : 0;
    return creak + (t > 1.5F ? 2.6F * std::exp(-5 * (t - 1.5F)) : 0);
  }));
  made.stone = stone_sound();
  made.chime = chime_sound();
  for (int i = 0; i < 3; ++i) {
    made.steps[static_cast<std::size_t>(i)] = step_sound(0.5F * static_cast<float>(i));
    made.birds[static_cast<std::size_t>(i)] = bird_sound(i);
  }
  return made;
}

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
    const auto water = world::water_surface(play->world(), feet);
    const double nearness =
        water ? std::clamp(1 - (feet.local.y - water->surface_m) / 6, 0.0, 1.0) : 0.0;
    hold(water_, clips_->water, 0.4 * nearness, dt_s);
    flow(*play, dt_s);
    const Fire* fire = play->fire_near(30);
    hold(fire_, clips_->fire, fire != nullptr ? 0.9 : 0, dt_s,
         fire != nullptr ? std::optional(fire->at) : std::nullopt);
    sing(*play, dt_s);
  } else if (clips_) {
    hold(wind_, clips_->wind, kTitleWind, dt_s);
    hold(rain_, clips_->rain, 0, dt_s);
    hold(water_, clips_->water, 0, dt_s);
    hold(stream_, clips_->stream, 0, dt_s);
    hold(fire_, clips_->fire, 0, dt_s);
  }
  audio_.update(ears, dt_s);
}

// Rivers and falls sound from where they are loudest.
void Sounds::flow(Play& play, double dt_s) {
  constexpr double kBetweenS = 0.25;
  until_look_s_ -= dt_s;
  if (until_look_s_ <= 0) {
    until_look_s_ = kBetweenS;
    heard_ = loudest_stream(play.query(), play.progress().feet);
  }
  hold(stream_, clips_->stream, heard_ ? heard_->gain : 0, dt_s,
       heard_ ? std::optional(heard_->at) : std::nullopt);
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
