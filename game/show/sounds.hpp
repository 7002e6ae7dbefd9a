// Synthesises and plays the sounds of a game: wind by height, footsteps by ground, water, rain,
// fire, birds by the hour, and music. Without an audio device it stays silent and does not fail.
// Main thread only.
#pragma once

#include <array>
#include <future>
#include <memory>
#include <optional>

#include "engine/audio/audio.hpp"
#include "game/play/play.hpp"
#include "game/play/streams.hpp"

namespace cairns {

using ClipPtr = std::shared_ptr<const audio::Clip>;

// All clips of the game. The first four are loops; the music is a minute of slow chords.
struct Clips {
  ClipPtr wind, rain, water, stream, fire, music, splash, chop, fall, stone, chime;
  std::array<ClipPtr, 3> steps, birds;  // steps from snow to rock
};

// Synthesises all clips; no file is read. Each takes a few milliseconds, and the music about 0.1 s.
Clips make_clips();

class Sounds {
 public:
  explicit Sounds(double block_m, audio::Destination destination);

  // Sets the volumes, 0 to 1 each.
  void set_volumes(double effects, double music);
  // Call once a frame. `play` is null on the title screen.
  void update(Play* play, const core::CameraPose& ears, double dt_s);
  void tell(const Happening& happening, Play& play);

 private:
  struct Loop {
    audio::SoundId sound = audio::SoundId::kNone;
    double gain = 0;
    std::optional<core::WorldPosition> at = {};
  };
  void hold(Loop& loop, const ClipPtr& clip, double gain, double dt_s,
            const std::optional<core::WorldPosition>& at = {});
  void flow(Play& play, double dt_s);
  void sing(Play& play, double dt_s);

  audio::Audio audio_;
  Loop wind_, rain_, water_, stream_, fire_;
  std::optional<Stream> heard_;  // the loudest stream at the last look
  double until_look_s_ = 0;
  std::future<Clips> coming_;   // from a worker thread
  std::optional<Clips> clips_;  // empty until generated
  double until_song_s_ = 4;
  std::uint64_t songs_ = 0;
};

}  // namespace cairns
