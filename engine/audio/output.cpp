#include "engine/audio/output.hpp"

#include <AL/alext.h>

namespace psygen::audio {
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
