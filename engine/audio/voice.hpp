// A sound that plays, and its voice: the source of OpenAL that it has while it is heard. Free
// functions on the values of one sound; Audio decides which sounds have voices. Private to
// engine/audio. Main thread, with the context of the output in use.
#pragma once

#include <AL/al.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

#include "engine/audio/audio.hpp"
#include "engine/audio/sound_file.hpp"

namespace psygen::audio {

// A piece of a stream that OpenAL has: a quarter of a second.
struct Piece {
  ALuint buffer = 0;
  std::size_t frames = 0;
};

struct Sound {
  SoundId id = SoundId::kNone;
  std::shared_ptr<const Clip> clip;  // or
  std::optional<SoundFile> file;
  Play how;
  double frame = 0;  // of a clip without a voice, or of the stream's first piece
  bool ended = false;
  double gain = 0;  // as heard, in this update
  bool chosen = false;
  ALuint source = 0;  // 0: no voice
  std::deque<Piece> pieces;
  bool file_ended = false;

  double rate_hz() const { return clip ? clip->rate_hz : file->rate_hz(); }
  double frames() const {
    return static_cast<double>(clip ? clip->frames() : static_cast<std::size_t>(file->frames()));
  }
};

// Gives a sound a voice that is not started yet. `buffer` has the samples of a clip. Nothing where
// the device has no more voices.
void give_voice(Sound& sound, ALuint buffer);
// Takes the voice, if there is one; the sound keeps its place in time.
void take_voice(Sound& sound);
// Tells the voice the sound's gain, pitch and place, in metres from the listener.
void set_source(const Sound& sound, const glm::vec3& place);
// Starts a new voice, notices ends, and decodes the next piece of a stream, or two where few are
// left.
void follow(Sound& sound);
// Lets time pass for a sound without a voice. 0 <= dt_s, finite.
void pass_silently(Sound& sound, double dt_s);

}  // namespace psygen::audio
