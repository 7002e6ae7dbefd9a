// OpenAL as values: a device with a context, and sources that play clips or queues of pieces. The
// only header of the project that includes OpenAL; it is private to engine/audio. Main thread only.
#pragma once

#include <AL/al.h>
#include <AL/alc.h>

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/audio/clip.hpp"

namespace psygen::audio {

inline constexpr int kRenderRate = 48'000;  // of a rendered output, in Hz

class Output {
 public:
  // Null where there is no device, or none that renders.
  static std::unique_ptr<Output> open(bool rendered);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  // Makes it the target of the calls below and of all calls of OpenAL.
  void use();
  // False once a device was unplugged.
  bool connected() const;
  // Unit vectors of the listener, who is at the origin.
  void set_listener(const glm::vec3& forward, const glm::vec3& up);
  std::vector<float> render(std::size_t frames);

 private:
  Output(ALCdevice* device, ALCcontext* context, bool rendered);
  ALCdevice* device_;
  ALCcontext* context_;
  bool rendered_;
};

// A buffer with these samples; 0 when there is no memory.
ALuint make_buffer(std::span<const std::int16_t> samples, std::uint32_t channels,
                   std::uint32_t rate_hz);

}  // namespace psygen::audio
