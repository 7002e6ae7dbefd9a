// A playing sound, its voice (the OpenAL source that it has while it is audible), and the device
// that plays it. Free functions on the values of one sound; Audio decides which sounds have voices.
// Private to engine/audio. Main thread, with the context of the output in use.
#pragma once

#include <AL/al.h>
#include <AL/alc.h>

#include <cstddef>
#include <deque>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/audio/audio.hpp"
#include "engine/audio/clip.hpp"
#include "engine/audio/sound_file.hpp"

namespace psygen::audio {

// A piece of a stream that is queued in OpenAL: a quarter of a second.
struct Piece {
  ALuint buffer = 0;
  std::size_t frames = 0;
};

struct Sound {
  SoundId id = SoundId::kNone;
  std::shared_ptr<const Clip> clip;  // or `file`
  std::optional<SoundFile> file;
  Play how;
  double frame = 0;  // position of a clip without a voice, or of a stream's first piece
  bool ended = false;
  double gain = 0;  // at the listener, in this update
  bool chosen = false;
  ALuint source = 0;  // 0: no voice
  std::deque<Piece> pieces;
  bool file_ended = false;

  // The rate and the length of the clip or file.
  double rate_hz() const { return clip ? clip->rate_hz : file->rate_hz(); }
  double frames() const {
    return static_cast<double>(clip ? clip->frames() : static_cast<std::size_t>(file->frames()));
  }
};

// Gives a sound a voice that is not started yet. `buffer` has the samples of a clip. Does nothing
// if the device has no more voices.
void give_voice(Sound& sound, ALuint buffer);
// Removes the voice, if any; the sound keeps its position in time.
void take_voice(Sound& sound);
// Sets the voice's gain, pitch and position, in metres from the listener.
void set_source(const Sound& sound, const glm::vec3& place);
// Starts a new voice, detects ends, and decodes the next piece of a stream, or two if few are left.
void follow(Sound& sound);
// Advances a sound without a voice. 0 <= dt_s, finite.
void pass_silently(Sound& sound, double dt_s);

// A device of OpenAL with its context and listener.
inline constexpr int kRenderRate = 48'000;  // rate of a rendered output in Hz

class Output {
 public:
  // Null if there is no device, or no device that can render.
  static std::unique_ptr<Output> open(bool rendered);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  // Makes this output the target of the calls below and of all calls of OpenAL.
  void use();
  // False after the device was unplugged.
  bool connected() const;
  // The orientation of the listener, who is at the origin, as unit vectors.
  void set_listener(const glm::vec3& forward, const glm::vec3& up);
  std::vector<float> render(std::size_t frames);

 private:
  Output(ALCdevice* device, ALCcontext* context, bool rendered);
  ALCdevice* device_;
  ALCcontext* context_;
  bool rendered_;
};

// A buffer with these samples; 0 if out of memory.
ALuint make_buffer(std::span<const std::int16_t> samples, std::uint32_t channels,
                   std::uint32_t rate_hz);

}  // namespace psygen::audio
