// Errors as values. A function that can fail for outside reasons returns `Result<T>`; our code
// throws nothing. Contract violations of a caller are for PSYGEN_ASSERT (assert.hpp). Any thread.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

namespace psygen::core {

// The kind of failure, for programs to decide on.
enum class ErrorCode : std::uint8_t {
  kInvalidArgument,  // a value outside its documented range
  kParse,            // text that violates its format; the message has file, line, field
  kIo,               // a file could not be read or written
  kOverBudget,       // legal, but beyond a configured limit
  kOutOfMemory,      // host or device memory
  kNotReady,         // the result is not ready; try again later
  kNoDevice,         // no usable Vulkan device or no display
  kDeviceLost,
  kSynthesisFailed,  // a model's synthesis threw or was abandoned
  kInterrupted,      // cancelled at the caller's request
  kInternal,
};

// A code for programs and a message for people. The message names file, line and field if they are
// known, states the allowed values, and starts with a lower-case letter.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;
};

// A T or an Error.
template <class T>
using Result = tl::expected<T, Error>;

// Makes an Error to return from a function with a Result of any type.
inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

// Makes an Error for an argument outside its documented range.
inline tl::unexpected<Error> invalid_argument(std::string message) {
  return fail(ErrorCode::kInvalidArgument, std::move(message));
}

}  // namespace psygen::core
