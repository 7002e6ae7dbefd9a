#include "engine/core/replace_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/file_calls.hpp"
#include "engine/core/hash.hpp"

namespace psygen::core {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{64} << 10;

// Identifies the host and the container, within which process ids are unique.
const std::string& host_mark() {
  static const std::string mark = [] {
    const std::string both = host_identity();
    const std::uint64_t hash = hash_bytes(std::as_bytes(std::span(both)));
    return fmt::format("{:08x}", static_cast<std::uint32_t>(hash));
  }();
  return mark;
}

// Returns the file that a chain of links leads to, whether it exists or not.
std::filesystem::path without_links(std::filesystem::path path) {
  std::error_code error;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(path, error); ++links) {
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;  // replaces the whole path if the link is absolute
  }
  return path;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

// Opens a new file next to `path` and stores its name; returns -1 and sets errno if that fails.
int open_temporary(const std::filesystem::path& path, std::filesystem::path& temporary) {
  int file = -1;
  for (int attempt = 0; attempt < 100 && file < 0; ++attempt) {
    temporary = path.parent_path() / fmt::format(".{}.{}-{}@{}.partial", path.filename().string(),
                                                 this_process(), attempt, host_mark());
    file = create_file(temporary);
    if (file < 0 && errno != EEXIST) break;
  }
  return file;
}

constexpr std::string_view kPartial = ".partial";

// The parts of a temporary file's name, as open_temporary() makes it.
struct Partial {
  std::string file;        // the file that it was to become
  std::int64_t owner = 0;  // a process
  bool ours = false;       // written on this host
};

std::optional<Partial> partial_of(const std::string& name) {
  if (!name.starts_with('.') || !name.ends_with(kPartial)) return std::nullopt;
  const std::string stem = name.substr(0, name.size() - kPartial.size());
  const std::size_t dot = stem.rfind('.'), dash = stem.rfind('-'), at = stem.rfind('@');
  if (dot == 0 || dot == std::string::npos || dash == std::string::npos || dash < dot)
    return std::nullopt;
  Partial partial{stem.substr(1, dot - 1), 0, false};
  const auto parsed = std::from_chars(stem.data() + dot + 1, stem.data() + dash, partial.owner);
  if (parsed.ec != std::errc() || parsed.ptr != stem.data() + dash || partial.owner <= 0)
    return std::nullopt;
  // Files of older versions do not name their host.
  partial.ours = at == std::string::npos || at < dash || stem.substr(at + 1) == host_mark();
  return partial;
}

template <class Unwanted>
void remove_partials_that(const std::filesystem::path& folder, Unwanted unwanted) {
  std::error_code error, ignored;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const auto partial = partial_of(it->path().filename().string());
    if (partial && unwanted(*partial)) std::filesystem::remove(it->path(), ignored);
  }
}

}  // namespace

void remove_stale_partials(const std::filesystem::path& folder) {
  remove_partials_that(
      folder, [](const Partial& partial) { return partial.ours && !is_running(partial.owner); });
}

void remove_partials_of(const std::filesystem::path& folder,
                        const std::function<bool(const std::string& file)>& is_ours) {
  remove_partials_that(folder, [&](const Partial& partial) { return is_ours(partial.file); });
}

Result<void> check_replaceable(const std::filesystem::path& path) {
  const std::filesystem::path target = without_links(path);
  const char* refusal = look_at(target).refusal;
  if (refusal == nullptr && !can_create_in(folder_of(target)))
    refusal = errno == ENOENT ? "its folder is missing" : "cannot create a file in its folder";
  if (refusal == nullptr) return {};
  return fail(ErrorCode::kIo, fmt::format("{}: {}", path.string(), refusal));
}

FileReplacement::FileReplacement(std::filesystem::path path)
    : path_(std::move(path)), target_(without_links(path_)) {
  const ExistingFile before = look_at(target_);
  if (before.refusal != nullptr) {
    failure_ = fmt::format("{}: {}", path_.string(), before.refusal);
    return;
  }
  file_ = open_temporary(target_, temporary_);
  if (file_ < 0) {
    fail_with(errno == ENOENT ? "its folder is missing" : "cannot create a file in its folder",
              errno);
    temporary_.clear();
  } else if (before.exists) {
    keep_owner_and_mode(file_, before);
  }
}

FileReplacement::~FileReplacement() {
  if (file_ >= 0) close_file(file_);
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void FileReplacement::fail_with(const char* action, int error) {
  if (failure_.empty())
    failure_ = fmt::format("{}: {}: {}", path_.string(), action, std::strerror(error));
}

void FileReplacement::write_out(std::string_view bytes) {
  while (!bytes.empty() && failure_.empty()) {
    const std::ptrdiff_t written = write_some(file_, bytes);
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      fail_with("cannot write", errno);
    }
  }
}

void FileReplacement::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > kBufferBytes) {
    write_out(buffer_);
    buffer_.clear();
  }
  if (bytes.size() > kBufferBytes) {
    write_out(bytes);
  } else {
    buffer_ += bytes;
  }
}

Result<void> FileReplacement::flush() {
  write_out(buffer_);
  buffer_.clear();
  if (failure_.empty() && file_ >= 0 && !flush_file(file_)) fail_with("cannot write", errno);
  if (file_ >= 0 && !close_file(std::exchange(file_, -1))) fail_with("cannot write", errno);
  if (!failure_.empty()) return fail(ErrorCode::kIo, failure_);
  return {};
}

Result<void> FileReplacement::commit() {
  if (auto ok = flush(); !ok) return ok;
  if (!replace_name(temporary_, target_)) {
    fail_with("cannot write", errno);
    return fail(ErrorCode::kIo, failure_);
  }
  temporary_.clear();
  flush_folder(folder_of(target_));
  return {};
}

Result<void> replace_file(const std::filesystem::path& path, std::string_view text) {
  FileReplacement file(path);
  file.write(text);
  return file.commit();
}

Result<void> replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  return replace_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace psygen::core
