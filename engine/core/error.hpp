// Errors as values. A function that can fail for outside reasons returns `Result<T>`; our code
// throws nothing. Not for broken contracts of a caller: those are PSYGEN_ASSERT (assert.hpp). Any
// thread.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

namespace psygen::core {

// What went wrong, for programs to decide on.
enum class ErrorCode : std::uint8_t {
  kInvalidArgument,  // a value outside its documented range
  kParse,            // text that violates its format; the message has file, line, field
  kIo,               // a file could not be read or written
  kOverBudget,       // legal, but larger than a limit that was set
  kOutOfMemory,      // host or device memory
  kNotYet,           // the result is not ready yet; ask again
  kNoDevice,         // no usable Vulkan device or no display
  kDeviceLost,
  kSynthesisFailed,  // a model's synthesis threw or was abandoned
  kInterrupted,      // cancelled at the caller's request
  kInternal,
};

// A code for programs and one sentence for people. The sentence names file, line and field when
// there are any, says what is allowed, and starts with a lower-case letter.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;
};

// A T or an Error.
template <class T>
using Result = tl::expected<T, Error>;

// An Error to return from a function with a Result of any type.
inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

}  // namespace psygen::core
