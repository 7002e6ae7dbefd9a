// Errors as values. Whatever can fail for outside reasons returns `Result<T>`; nothing of ours
// throws. A broken contract of the caller is PSYGEN_ASSERT (assert.hpp), not an Error.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

namespace psygen::core {

enum class ErrorCode : std::uint8_t {
  kInvalidArgument,  // a value outside its documented range
  kParse,            // text that is not what its format demands; the message has file, line, field
  kIo,               // a file could not be read or written
  kOverBudget,       // legal, but larger than a limit that was set
  kOutOfMemory,      // host or device memory
  kNotYet,           // what is asked for is on its way; ask again
  kNoDevice,         // no usable Vulkan device or no display
  kDeviceLost,
  kSynthesisFailed,  // a model's synthesis threw or was given up
  kInterrupted,      // given up because the caller asked for it
  kInternal,
};

// A code for programs and one sentence for people. The sentence names file, line and field where
// there are any, says what is allowed, and starts with a lower-case letter.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

}  // namespace psygen::core
