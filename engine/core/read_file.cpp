#include "engine/core/read_file.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

namespace psygen::core {

Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path,
                                            std::uint64_t max_bytes) {
  const auto refuse = [&](ErrorCode code, const std::string& sentence) {
    return fail(code, fmt::format("{}: {}", path.string(), sentence));
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return refuse(ErrorCode::kIo, error ? error.message() : "is not a regular file");
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) return refuse(ErrorCode::kIo, error.message());
  if (size > max_bytes) {
    return refuse(ErrorCode::kOverBudget, fmt::format("the file has {} bytes; at most {} are "
                                                      "allowed",
                                                      size, max_bytes));
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return refuse(ErrorCode::kIo, "cannot be opened for reading");
  std::vector<std::uint8_t> bytes(size);
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
    return refuse(ErrorCode::kIo, "cannot be read to its end");
  return bytes;
}

}  // namespace psygen::core
