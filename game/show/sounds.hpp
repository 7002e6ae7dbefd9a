// Plays the sounds of a game: wind by height, steps by ground, water, rain, fire, birds by the
// hour, music. Without a device nothing is heard and nothing fails. Main thread.
#pragma once

#include <array>
#include <future>
#include <optional>

#include "engine/audio/audio.hpp"
#include "game/play/play.hpp"
#include "game/show/synth.hpp"

namespace cairns {

class Sounds {
 public:
  explicit Sounds(double block_m, audio::Destination destination);

  // 0 … 1 each.
  void set_volumes(double effects, double music);
  // Once a frame. `play` may be null: a title without a game.
  void update(Play* play, const core::CameraPose& ears, double dt_s);
  void tell(const Happening& happening, Play& play);

 private:
  // All that can be heard. Made in a thread of its own, as the music takes a while.
  struct Clips {
    ClipPtr wind, rain, water, fire, music, splash, chop, fall, stone, chime;
    std::array<ClipPtr, 3> steps, birds;
  };
  static Clips make_clips();
  struct Loop {
    audio::SoundId sound = audio::SoundId::kNone;
    double gain = 0;
    std::optional<core::WorldPosition> at = {};
  };
  void hold(Loop& loop, const ClipPtr& clip, double gain, double dt_s,
            const std::optional<core::WorldPosition>& at = {});
  void sing(Play& play, double dt_s);

  audio::Audio audio_;
  Loop wind_, rain_, water_, fire_;
  std::future<Clips> coming_;
  std::optional<Clips> clips_;  // until then nothing is heard
  double until_song_s_ = 4;
  std::uint64_t songs_ = 0;
};

}  // namespace cairns
