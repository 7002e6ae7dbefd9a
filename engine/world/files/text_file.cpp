#include "engine/world/files/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace psygen::world {
namespace {
constexpr std::size_t kFirstBytes = 65536;
}  // namespace

core::Result<std::string> read_text_file(const std::filesystem::path& file,
                                         std::size_t limit_bytes) {
  const auto fail = [&file](std::string_view why) {
    return core::fail(core::ErrorCode::kIo, fmt::format("{}: {}", file.string(), why));
  };
  if (file.empty()) return core::fail(core::ErrorCode::kIo, "the file name is empty");
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return fail("there is no such file");
  if (error) return fail(fmt::format("cannot be read ({})", error.message()));
  if (status.type() != std::filesystem::file_type::regular) return fail("this is not a file");
  const auto too_large = [&] {
    return core::fail(
        core::ErrorCode::kOverBudget,
        fmt::format("{}: the file is too large (allowed: {} bytes)", file.string(), limit_bytes));
  };
  if (const auto bytes = std::filesystem::file_size(file, error); !error && bytes > limit_bytes)
    return too_large();
  const auto close = [](std::FILE* f) { std::fclose(f); };
  const std::unique_ptr<std::FILE, decltype(close)> stream(std::fopen(file.string().c_str(), "rb"),
                                                           close);
  if (!stream) return fail(fmt::format("cannot be opened ({})", std::strerror(errno)));

  std::string text;
  std::size_t read = 0;
  do {
    text.resize(std::min(std::max(2 * text.size(), kFirstBytes), limit_bytes + 1));
    read += std::fread(text.data() + read, 1, text.size() - read, stream.get());
  } while (read == text.size() && read <= limit_bytes);
  text.resize(read);
  if (std::ferror(stream.get()) != 0)
    return fail(fmt::format("cannot be read ({})", std::strerror(errno)));
  if (text.size() > limit_bytes) return too_large();
  return text;
}

}  // namespace psygen::world
