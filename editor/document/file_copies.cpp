#include "editor/document/file_copies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "engine/core/hash.hpp"

namespace psygen::editor {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunkBytes = std::size_t{64} << 10;

// The next bytes of a file; fewer, or none, at its end.
std::string_view next_chunk(std::ifstream& file, std::array<char, kChunkBytes>& bytes) {
  file.read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(file.gcount())};
}

core::Result<void> cannot_copy(const fs::path& from, const fs::path& to, std::string_view why) {
  return core::fail(core::ErrorCode::kIo,
                    fmt::format("{}: cannot be copied to {}: {}", from.string(), to.string(), why));
}

}  // namespace

FileCopies::~FileCopies() {
  files_.clear();
  std::error_code error;
  for (auto at = made_.rbegin(); at != made_.rend(); ++at)
    fs::remove(*at, error);  // removes folders only if they are empty
}

core::Result<void> FileCopies::add(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::is_regular_file(from, error))
    return cannot_copy(from, to, error ? error.message() : "not a regular file");
  std::ifstream source(from, std::ios::binary);
  if (!source) return cannot_copy(from, to, std::strerror(errno));
  make_folders(to);
  auto file = std::make_unique<core::FileReplacement>(to);
  std::array<char, kChunkBytes> bytes;
  for (auto chunk = next_chunk(source, bytes); !chunk.empty(); chunk = next_chunk(source, bytes))
    file->write(chunk);
  if (source.bad()) return cannot_copy(from, to, "reading stopped before the end of the file");
  if (auto flushed = file->flush(); !flushed) return flushed;
  files_.push_back(std::move(file));
  targets_.push_back(to);
  return {};
}

void FileCopies::expect(const fs::path& file) {
  make_folders(file);
  std::error_code error;
  if (!fs::exists(file, error)) made_.push_back(file);
}

// Ignores errors: writing the file reports them.
void FileCopies::make_folders(const fs::path& file) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path folder = file.parent_path(); !folder.empty() && !fs::exists(folder, error);
       folder = folder.parent_path())
    missing.push_back(folder);
  for (auto folder = missing.rbegin(); folder != missing.rend(); ++folder)
    if (fs::create_directory(*folder, error)) made_.push_back(*folder);
}

core::Result<void> FileCopies::commit() {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    std::error_code error;
    const bool is_new = !fs::exists(targets_[i], error);
    if (auto done = files_[i]->commit(); !done) return done;
    if (is_new) made_.push_back(targets_[i]);
  }
  return {};
}

bool same_content(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  if (!fs::is_regular_file(a, error) || !fs::is_regular_file(b, error)) return false;
  if (fs::file_size(a, error) != fs::file_size(b, error)) return false;
  std::ifstream one(a, std::ios::binary), other(b, std::ios::binary);
  if (!one || !other) return false;
  std::array<char, kChunkBytes> of_one, of_other;
  for (;;) {
    const std::string_view x = next_chunk(one, of_one), y = next_chunk(other, of_other);
    if (x != y || one.bad() || other.bad()) return false;
    if (x.empty()) return true;
  }
}

std::uint64_t stamp_of(const fs::path& file) {
  std::error_code error;
  const auto time = fs::last_write_time(file, error).time_since_epoch().count();
  return core::combine(static_cast<std::uint64_t>(time), fs::file_size(file, error));
}

}  // namespace psygen::editor
