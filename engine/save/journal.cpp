#include "engine/save/journal.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <string_view>

#include "engine/core/utf8.hpp"

namespace psygen::save {
namespace {

// Both ends of a journal carry these bytes: a header begins with them, and so ends the name of a
// super-journal, a file that SQLite removes after it has rolled the journal back.
constexpr std::array<unsigned char, 8> kMagic{0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
constexpr std::int64_t kHeaderBytes = 28;

bool has_magic(const unsigned char* bytes) {
  return std::memcmp(bytes, kMagic.data(), kMagic.size()) == 0;
}

bool read_at(std::ifstream& file, std::int64_t at, std::span<unsigned char> bytes) {
  file.seekg(at);
  file.read(reinterpret_cast<char*>(bytes.data()), std::ssize(bytes));
  return file.good();
}

}  // namespace

core::Result<void> check_journal(const std::filesystem::path& file, std::int64_t page_bytes) {
  const auto fail = [&](core::ErrorCode code, std::string_view reason) {
    return core::fail(code, fmt::format("{}: {}", file.string(), reason));
  };
  const auto refuse = [&](std::string_view reason) {
    return fail(core::ErrorCode::kParse,
                fmt::format("its journal {}-journal {}; nothing was changed",
                            core::shown(file.filename().string(), 100), reason));
  };
  // SQLite resolves links first: the journal lies beside the file that a link leads to.
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  if (error) return fail(core::ErrorCode::kIo, error.message());
  struct stat status {};
  if (lstat((real.string() + "-wal").c_str(), &status) == 0)
    return fail(core::ErrorCode::kParse,
                "another program left a write-ahead log (-wal) beside it; nothing was changed");
  const std::string journal = real.string() + "-journal";
  if (lstat(journal.c_str(), &status) != 0 && errno == ENOENT) return {};
  if (!S_ISREG(status.st_mode)) return refuse("is not a regular file");
  std::ifstream opened(journal, std::ios::binary);
  if (!opened) return fail(core::ErrorCode::kIo, "its journal cannot be read");
  const std::int64_t bytes = status.st_size;
  std::array<unsigned char, kMagic.size()> end{};
  std::array<unsigned char, kHeaderBytes> header{};
  if (bytes < std::ssize(end)) return {};  // SQLite ignores it
  const bool has_header = bytes >= std::ssize(header);
  if (!read_at(opened, bytes - std::ssize(end), end) || (has_header && !read_at(opened, 0, header)))
    return fail(core::ErrorCode::kIo, "its journal cannot be read");
  // SQLite looks for a name even if the rest of the journal is no journal.
  if (has_magic(end.data()))
    return refuse("names a file for removal, which no journal of this program does");
  if (!has_magic(header.data())) return {};  // invalidated after a complete save
  if (big_endian(&header[24]) != page_bytes) return refuse("has pages of another size");
  const std::int64_t restored = page_bytes * std::int64_t{big_endian(&header[16])};
  const auto saved = static_cast<std::int64_t>(std::filesystem::file_size(real, error));
  if (error || restored > saved + bytes)
    return refuse(fmt::format("restores {} bytes, but it and the save hold only {}", restored,
                              saved + bytes));
  return {};
}

}  // namespace psygen::save
