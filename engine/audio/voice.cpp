#include "engine/audio/voice.hpp"

#include <AL/alext.h>

#include <cmath>
#include <cstdint>

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
  const ALuint buffer =
      make_buffer(std::span(samples).first(filled), channels, sound.file->rate_hz());
  if (buffer == 0) return;
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

namespace {

ALCdevice* open_rendered() {
  const auto open = reinterpret_cast<LPALCLOOPBACKOPENDEVICESOFT>(
      alcGetProcAddress(nullptr, "alcLoopbackOpenDeviceSOFT"));
  return open == nullptr ? nullptr : open(nullptr);
}

}  // namespace

std::unique_ptr<Output> Output::open(bool rendered) {
  ALCdevice* device = rendered ? open_rendered() : alcOpenDevice(nullptr);
  if (device == nullptr) return nullptr;
  const ALCint attributes[] = {ALC_FORMAT_CHANNELS_SOFT,
                               ALC_STEREO_SOFT,
                               ALC_FORMAT_TYPE_SOFT,
                               ALC_FLOAT_SOFT,
                               ALC_FREQUENCY,
                               kRenderRate,
                               ALC_HRTF_SOFT,
                               ALC_FALSE,
                               0};
  ALCcontext* context = alcCreateContext(device, rendered ? attributes : nullptr);
  if (context == nullptr) {
    alcCloseDevice(device);
    return nullptr;
  }
  std::unique_ptr<Output> output(new Output(device, context, rendered));
  output->use();
  alDistanceModel(AL_NONE);  // attenuation() does that
  return output;
}

Output::Output(ALCdevice* device, ALCcontext* context, bool rendered)
    : device_(device), context_(context), rendered_(rendered) {}

Output::~Output() {
  alcMakeContextCurrent(nullptr);
  alcDestroyContext(context_);
  alcCloseDevice(device_);
}

void Output::use() {
  if (alcGetCurrentContext() != context_) alcMakeContextCurrent(context_);
}

bool Output::connected() const {
  if (rendered_) return true;
  ALCint connected = ALC_TRUE;
  alcGetIntegerv(device_, ALC_CONNECTED, 1, &connected);
  return connected != ALC_FALSE;
}

void Output::set_listener(const glm::vec3& forward, const glm::vec3& up) {
  const ALfloat both[] = {forward.x, forward.y, forward.z, up.x, up.y, up.z};
  alListenerfv(AL_ORIENTATION, both);
}

std::vector<float> Output::render(std::size_t frames) {
  std::vector<float> samples(frames * 2);
  const auto render =
      reinterpret_cast<LPALCRENDERSAMPLESSOFT>(alcGetProcAddress(device_, "alcRenderSamplesSOFT"));
  if (rendered_ && render != nullptr)
    render(device_, samples.data(), static_cast<ALCsizei>(frames));
  return samples;
}

ALuint make_buffer(std::span<const std::int16_t> samples, std::uint32_t channels,
                   std::uint32_t rate_hz) {
  alGetError();
  ALuint buffer = 0;
  alGenBuffers(1, &buffer);
  alBufferData(buffer, channels == 2 ? AL_FORMAT_STEREO16 : AL_FORMAT_MONO16, samples.data(),
               static_cast<ALsizei>(samples.size_bytes()), static_cast<ALsizei>(rate_hz));
  if (alGetError() == AL_NO_ERROR) return buffer;
  alDeleteBuffers(1, &buffer);
  return 0;
}

}  // namespace psygen::audio
