// Sound: clips and streams, with or without a place in the world, heard by a listener at the
// camera. Most calls only change values, and update() makes them heard, once a frame. The
// constructor and set_destination() open a device, and stream() opens a file. Without a device
// everything works and nothing is heard. Not a mixer of effects (no echo). Main thread only; one
// object that is audible per process, because OpenAL has one current context.
//
// Streams are decoded by update(), in pieces of a quarter of a second: at most two in one update,
// up to one second ahead.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/audio/clip.hpp"
#include "engine/audio/loudness.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"

namespace psygen::audio {

// Groups of sounds with a volume and a pause of their own.
enum class Bus : std::uint8_t { kEffects, kMusic };

// Where the sound goes.
enum class Destination : std::uint8_t {
  kDevice,    // the system's default device; none is no error
  kNowhere,   // time passes, nothing is heard
  kRendered,  // to render(), for recordings and tests
};

struct AudioOptions {
  Destination destination = Destination::kDevice;
  // Metres along a block of the world.
  double block_size_m = 60;
  // How many sounds are heard at once, 1 to 256: the loudest. The others go on silently.
  std::uint32_t max_voices = 32;
};

// How a sound is played.
struct Play {
  // Where it is, for sounds of one channel; without a place it is heard the same everywhere.
  std::optional<core::WorldPosition> at = std::nullopt;
  Range range = {};
  double gain = 1;   // 0 to 4
  double pitch = 1;  // 0.25 to 4
  bool loop = false;
  Bus bus = Bus::kEffects;
};

// A sound that plays. Never used twice.
enum class SoundId : std::uint64_t { kNone = 0 };

class Audio {
 public:
  // Opens the device. A missing one is told once as a warning. Options outside their ranges are
  // clamped.
  explicit Audio(const AudioOptions& options);
  ~Audio();
  Audio(const Audio&) = delete;
  Audio& operator=(const Audio&) = delete;

  // Starts a clip, at the next update(). Fails with kInvalidArgument: check_clip(), values outside
  // of their ranges or not finite, two channels with a place.
  core::Result<SoundId> play(std::shared_ptr<const Clip> clip, const Play& how);
  // Starts a file, decoded while it plays. Fails as play() and read_clip().
  core::Result<SoundId> stream(const std::filesystem::path& file, const Play& how);

  // Changes a sound that plays; nothing where it has ended. Fails as play().
  core::Result<void> change(SoundId sound, const Play& how);
  // Ends a sound. O(sounds).
  void stop(SoundId sound);
  // Whether it has not ended.
  bool plays(SoundId sound) const;
  std::size_t playing() const;
  // How many were given a voice by the last update().
  std::size_t heard() const;

  // Volumes, 0 to 1; values outside are clamped, NaN is 0.
  void set_master_volume(double volume);
  void set_volume(Bus bus, double volume);
  // Sounds of a paused bus keep their place and are silent.
  void set_paused(Bus bus, bool paused);

  // Moves the listener, lets `dt_s` seconds pass for what is not heard, gives voices to the
  // loudest, decodes streams. Where a pose is not finite, the last good one counts; a time above 60
  // s counts as 60 s, and one that is no number or negative as 0. A device that is lost is told
  // once, and looked for again after 2, 4, 8 … 64 seconds, which takes milliseconds each time.
  // O(sounds · log sounds).
  void update(const core::CameraPose& listener, double dt_s);

  // Changes where the sound goes; sounds go on.
  void set_destination(Destination destination);
  // Whether anything can be heard or rendered.
  bool has_output() const;
  // With kRendered: the next frames at 48 kHz, left and right interleaved in −1 to 1. Else silence.
  // At most 2^20 frames a call.
  std::vector<float> render(std::size_t frames);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psygen::audio
