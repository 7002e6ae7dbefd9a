#include "engine/core/out_of_memory.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <exception>
#include <utility>

#include "engine/core/process_memory.hpp"

namespace psygen::core {
namespace {

thread_local std::size_t refused_bytes = 0;

constexpr unsigned long kMiB = 1ul << 20;

// A text in a buffer of the caller.
struct Text {
  std::span<char> buffer;
  std::size_t length = 0;

  __attribute__((format(printf, 2, 3))) void add(const char* format, ...) {
    std::va_list list;
    va_start(list, format);
    const int wanted = std::vsnprintf(buffer.data() + length, buffer.size() - length, format, list);
    va_end(list);
    if (wanted > 0) length = std::min(length + static_cast<std::size_t>(wanted), buffer.size() - 1);
  }
};

}  // namespace

void record_failed_allocation(std::size_t bytes) {
  refused_bytes = bytes;
}

std::string_view out_of_memory(std::string_view what, std::span<char> buffer) {
  Text text{buffer};
  if (!what.empty()) text.add("%.*s: ", static_cast<int>(what.size()), what.data());
  text.add("memory ran out (");
  const std::size_t wanted = std::exchange(refused_bytes, 0);
  if (wanted >= 10 * kMiB) {
    text.add("%lu MiB more were wanted; ", static_cast<unsigned long>(wanted / kMiB));
  } else if (wanted > 0) {
    text.add("%lu bytes more were wanted; ", static_cast<unsigned long>(wanted));
  }
  text.add("%lu MiB are in use", memory_in_use_mib());
  for (const MemoryLimit& limit : memory_limits())
    if (limit.name != nullptr) text.add(", %s allows %lu MiB", limit.name, limit.mib);
  text.add(")");
  return {buffer.data(), text.length};
}

std::string out_of_memory(std::string_view what) {
  std::array<char, 512> buffer;
  return std::string(out_of_memory(what, buffer));
}

Error error_of_exception(ErrorCode code, std::string_view subject, std::string_view verb) {
  const auto threw = [&](std::string_view what) {
    return Error{code, std::string(subject).append(" ").append(verb).append(": ").append(what)};
  };
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::kOutOfMemory, out_of_memory(subject)};
  } catch (const std::exception& error) {
    return threw(error.what());
  } catch (...) {
    return threw("an exception of unknown type");
  }
}

}  // namespace psygen::core
