#include "engine/core/read_file.hpp"

#include <fmt/format.h>

#include <fstream>
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
  std::ifstream file(path, std::ios::binary);
  if (!file) return refuse(ErrorCode::kIo, "cannot be opened for reading");
  std::vector<std::uint8_t> bytes(size);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    return refuse(ErrorCode::kIo, "cannot be read to its end");
  return bytes;
}

}  // namespace psygen::core
