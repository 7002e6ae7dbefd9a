// A device of OpenAL with its context and listener. Sources are in voice.hpp. Private to
// engine/audio. Main thread only.
#pragma once

#include <AL/al.h>
#include <AL/alc.h>

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/audio/clip.hpp"

namespace psygen::audio {

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
