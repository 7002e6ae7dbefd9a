#include "engine/world/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace psygen::world {

core::Result<std::string> read_text_file(const std::filesystem::path& file) {
  const auto fail = [&file](std::string_view why) {
    return core::fail(core::ErrorCode::kIo, fmt::format("{}: {}", file.string(), why));
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return fail("there is no such file");
  if (error) return fail(fmt::format("cannot be read ({})", error.message()));
  if (status.type() != std::filesystem::file_type::regular) return fail("this is not a file");
  const auto close = [](std::FILE* f) { std::fclose(f); };
  const std::unique_ptr<std::FILE, decltype(close)> stream(std::fopen(file.c_str(), "rb"), close);
  if (!stream) return fail(fmt::format("cannot be opened ({})", std::strerror(errno)));

  std::string text(kMaxFileBytes + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream.get()));
  if (std::ferror(stream.get()) != 0)
    return fail(fmt::format("cannot be read ({})", std::strerror(errno)));
  if (text.size() > kMaxFileBytes)
    return core::fail(
        core::ErrorCode::kOverBudget,
        fmt::format("{}: the file is too large (allowed: {} bytes)", file.string(), kMaxFileBytes));
  return text;
}

}  // namespace psygen::world
