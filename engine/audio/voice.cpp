#include "engine/audio/voice.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace psygen::audio {
namespace {

// Maximum number of queued pieces of a stream, and the number below which slow frames need another.
constexpr std::size_t kPieces = 4, kFewPieces = 3;

// Decodes the next quarter of a second and queues it; detects the end.
void queue_piece(Sound& sound) {
  const std::uint32_t channels = sound.file->channels();
  std::vector<std::int16_t> samples(std::size_t{sound.file->rate_hz()} / 4 * channels);
  std::size_t filled = 0;
  for (bool rewound = false; filled < samples.size();) {
    const std::size_t read = sound.file->read(std::span(samples).subspan(filled)) * channels;
    filled += read;
    if (read > 0) rewound = false;
    if (read > 0) continue;
    if (!sound.how.loop || rewound) break;
    sound.file->seek(0);
    rewound = true;
  }
  sound.file_ended = filled == 0;
  if (sound.file_ended) return;
  ALuint buffer = 0;
  alGenBuffers(1, &buffer);
  alBufferData(buffer, channels == 2 ? AL_FORMAT_STEREO16 : AL_FORMAT_MONO16, samples.data(),
               static_cast<ALsizei>(filled * sizeof(std::int16_t)),
               static_cast<ALsizei>(sound.file->rate_hz()));
  alSourceQueueBuffers(sound.source, 1, &buffer);
  sound.pieces.push_back({buffer, filled / channels});
}

// Drops the pieces that have been played and decodes new ones.
void feed(Sound& sound) {
  ALint played = 0;
  for (alGetSourcei(sound.source, AL_BUFFERS_PROCESSED, &played); played > 0; --played) {
    ALuint buffer = 0;
    alSourceUnqueueBuffers(sound.source, 1, &buffer);
    alDeleteBuffers(1, &buffer);
    sound.frame += static_cast<double>(sound.pieces.front().frames);
    sound.pieces.pop_front();
  }
  if (sound.pieces.size() < kPieces && !sound.file_ended) queue_piece(sound);
  if (sound.pieces.size() < kFewPieces && !sound.file_ended) queue_piece(sound);
}

}  // namespace

void give_voice(Sound& sound, ALuint buffer) {
  alGetError();
  alGenSources(1, &sound.source);
  if (alGetError() != AL_NO_ERROR) {
    sound.source = 0;
    return;
  }
  alSourcef(sound.source, AL_MAX_GAIN, 4);
  if (sound.clip) {
    alSourcei(sound.source, AL_BUFFER, static_cast<ALint>(buffer));
    alSourcei(sound.source, AL_SAMPLE_OFFSET, static_cast<ALint>(sound.frame));
    return;
  }
  sound.file->seek(static_cast<std::uint64_t>(sound.frame));
  sound.file_ended = false;
}

void take_voice(Sound& sound) {
  if (sound.source == 0) return;
  ALint offset = 0, state = AL_INITIAL;
  alGetSourcei(sound.source, AL_SAMPLE_OFFSET, &offset);
  alGetSourcei(sound.source, AL_SOURCE_STATE, &state);
  if (sound.clip && state == AL_STOPPED) sound.ended = true;  // it ended since the last update
  sound.frame = sound.clip ? offset : sound.frame + offset;
  if (sound.how.loop && sound.frames() > 0) sound.frame = std::fmod(sound.frame, sound.frames());
  alSourceStop(sound.source);
  alSourcei(sound.source, AL_BUFFER, 0);
  alDeleteSources(1, &sound.source);
  for (const Piece& piece : sound.pieces)
    alDeleteBuffers(1, &piece.buffer);
  sound.pieces.clear();
  sound.source = 0;
}

void set_source(const Sound& sound, const glm::vec3& place) {
  alSource3f(sound.source, AL_POSITION, place.x, place.y, place.z);
  alSourcei(sound.source, AL_SOURCE_RELATIVE, sound.how.at ? AL_FALSE : AL_TRUE);
  alSourcef(sound.source, AL_GAIN, static_cast<float>(sound.gain));
  alSourcef(sound.source, AL_PITCH, static_cast<float>(sound.how.pitch));
  if (sound.clip) alSourcei(sound.source, AL_LOOPING, sound.how.loop ? AL_TRUE : AL_FALSE);
}

void follow(Sound& sound) {
  if (sound.file) feed(sound);
  ALint state = AL_INITIAL;
  alGetSourcei(sound.source, AL_SOURCE_STATE, &state);
  if (state == AL_PLAYING) return;
  if (sound.clip ? state == AL_INITIAL : !sound.pieces.empty()) {
    alSourcePlay(sound.source);  // a new voice, or a stream whose queue ran empty
  } else {
    sound.ended = true;
  }
}

void pass_silently(Sound& sound, double dt_s) {
  sound.frame += dt_s * sound.rate_hz() * sound.how.pitch;
  if (sound.frame < sound.frames()) return;
  sound.ended = !sound.how.loop || sound.frames() <= 0;
  if (!sound.ended) sound.frame = std::fmod(sound.frame, sound.frames());
}

}  // namespace psygen::audio
