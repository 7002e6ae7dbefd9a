// Sound: clips and streams, with or without a position in the world, for a listener at the camera.
// Most calls only change values; update(), once a frame, makes them audible. The constructor and
// set_destination() open a device, and stream() opens a file. Without a device everything works
// silently. No effects such as echo. Main thread only; at most one audible object per process,
// because OpenAL has one current context.
//
// update() decodes streams in pieces of a quarter of a second: at most two pieces per update, up to
// one second ahead.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/audio/clip.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"

namespace psygen::audio {

// Groups of sounds with separate volume and pause.
enum class Bus : std::uint8_t { kEffects, kMusic };

// The destination of the sound.
enum class Destination : std::uint8_t {
  kDevice,    // the system's default device; a missing one is no error
  kNowhere,   // silence, but sounds advance
  kRendered,  // to render(), for recordings and tests
};

// Metres. A sound has its full gain up to near_m, falls off as near_m / distance, and is silent
// from far_m on. 0 < near_m < far_m.
struct Range {
  double near_m = 2;
  double far_m = 200;
};

// The remaining fraction of the gain, 0 to 1: near / d · (far − d) / (far − near) between the two.
// Pure; any thread.
double attenuation(double distance_m, const Range& range);

struct AudioOptions {
  Destination destination = Destination::kDevice;
  // Side of a block of the world in metres.
  double block_size_m = 60;
  // Maximum number of audible sounds, 1 to 256: the loudest. Others advance silently.
  std::uint32_t max_voices = 32;
};

// The parameters of a playing sound.
struct Play {
  // The position, for sounds of one channel; without one, the sound is the same everywhere.
  std::optional<core::WorldPosition> at = std::nullopt;
  Range range = {};
  double gain = 1;   // 0 to 4
  double pitch = 1;  // 0.25 to 4
  bool loop = false;
  Bus bus = Bus::kEffects;
};

// Identifies a playing sound. Ids are never reused.
enum class SoundId : std::uint64_t { kNone = 0 };

class Audio {
 public:
  // Opens the device. Logs one warning if there is none. Options outside their ranges are clamped.
  explicit Audio(const AudioOptions& options);
  ~Audio();
  Audio(const Audio&) = delete;
  Audio& operator=(const Audio&) = delete;

  // Starts a clip at the next update(). Fails with kInvalidArgument for clips that check_clip()
  // rejects, for values out of range or not finite, and for two channels with a position.
  core::Result<SoundId> play(std::shared_ptr<const Clip> clip, const Play& how);
  // Starts a file, which is decoded while it plays. Fails like play() and read_clip().
  core::Result<SoundId> stream(const std::filesystem::path& file, const Play& how);

  // Changes a playing sound; does nothing if it has ended. Fails like play().
  core::Result<void> change(SoundId sound, const Play& how);
  // Ends a sound. O(sounds).
  void stop(SoundId sound);
  // True if the sound has not ended.
  bool plays(SoundId sound) const;
  std::size_t playing() const;
  // The number of sounds with a voice since the last update().
  std::size_t heard() const;

  // Volumes, 0 to 1; values outside are clamped, NaN is 0.
  void set_master_volume(double volume);
  void set_volume(Bus bus, double volume);
  // Sounds of a paused bus keep their position in time and are silent.
  void set_paused(Bus bus, bool paused);

  // Moves the listener, advances sounds without a voice by `dt_s` seconds, gives voices to the
  // loudest sounds, decodes streams. A pose that is not finite is replaced by the last valid one; a
  // time above 60 s counts as 60 s; NaN or a negative time counts as 0. A lost device is logged
  // once and searched for after 2, 4, 8 … 64 seconds, which takes milliseconds each time. O(sounds
  // · log sounds).
  void update(const core::CameraPose& listener, double dt_s);

  // Changes the destination; sounds continue.
  void set_destination(Destination destination);
  // True if there is a device or a rendered output.
  bool has_output() const;
  // With kRendered: the next frames at 48 kHz, left and right interleaved, −1 to 1. Otherwise
  // silence. At most 2^20 frames per call.
  std::vector<float> render(std::size_t frames);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psygen::audio
