#include "engine/gltf/source.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>

#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

using core::ErrorCode;

core::Result<std::filesystem::path> beside(const std::filesystem::path& file,
                                           const std::filesystem::path& name) {
  const auto refuse = [&] {
    return core::invalid_argument(
        fmt::format("names the file \"{}\"; only files in its own folder are read",
                    core::shown(name.string(), kMaxMessage)));
  };
  const std::string& text = name.native();
  const bool has_scheme = text.find(':') != std::string::npos;
  if (text.empty() || text.find('\0') != std::string::npos || name.is_absolute() || has_scheme ||
      std::ranges::find(name, "..") != name.end())
    return refuse();
  std::error_code error;
  const auto folder = std::filesystem::weakly_canonical(file.parent_path() / ".", error);
  const auto target = std::filesystem::weakly_canonical(folder / name, error);
  if (error) return core::fail(ErrorCode::kIo, error.message());
  const auto [end, ignored] = std::ranges::mismatch(folder, target);
  const bool inside = end == folder.end() || end->empty();
  if (!inside) return refuse();
  return target;
}

// False if the decoder does not accept such elements.
bool has_sound_elements(const PackedJson& packed) {
  if (packed.mode == "ATTRIBUTES") {
    const bool sound = packed.stride > 0 && packed.stride <= 256 && packed.stride % 4 == 0;
    if (packed.filter == "OCTAHEDRAL") return packed.stride == 4 || packed.stride == 8;
    if (packed.filter == "QUATERNION") return packed.stride == 8;
    return sound && (packed.filter == "NONE" || packed.filter == "EXPONENTIAL");
  }
  const bool whole = packed.mode == "INDICES" || packed.count % 3 == 0;
  return (packed.mode == "INDICES" || packed.mode == "TRIANGLES") && whole &&
         packed.filter == "NONE" && (packed.stride == 2 || packed.stride == 4);
}

bool decode(const PackedJson& packed, Source::View from, Source::Bytes& out) {
  if (packed.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(out.data(), packed.count, packed.stride, from.data(),
                                     from.size()) == 0;
  if (packed.mode == "INDICES")
    return meshopt_decodeIndexSequence(out.data(), packed.count, packed.stride, from.data(),
                                       from.size()) == 0;
  if (meshopt_decodeVertexBuffer(out.data(), packed.count, packed.stride, from.data(),
                                 from.size()) != 0)
    return false;
  if (packed.filter == "OCTAHEDRAL")
    meshopt_decodeFilterOct(out.data(), packed.count, packed.stride);
  if (packed.filter == "QUATERNION")
    meshopt_decodeFilterQuat(out.data(), packed.count, packed.stride);
  if (packed.filter == "EXPONENTIAL")
    meshopt_decodeFilterExp(out.data(), packed.count, packed.stride);
  return true;
}

}  // namespace

Source::Source(const std::filesystem::path& path, const Document& file, View binary, Model& out,
               std::uint64_t left_bytes)
    : path_(path),
      file_(file),
      binary_(binary),
      out_(out),
      left_bytes_(left_bytes),
      buffers_(file.buffers.size()),
      unpacked_(file.views.size()) {}

core::Result<Source::Bytes> Source::of_uri(const std::string& uri) {
  if (auto data = data_of(uri)) return *std::move(data);
  const std::filesystem::path name = plain_uri(uri);
  return beside(path_, name).and_then([&](const std::filesystem::path& file) {
    auto bytes = core::read_file(file, left_bytes_);
    std::error_code error;
    const bool is_missing = !bytes && !std::filesystem::exists(file, error);
    (is_missing ? out_.missing : out_.files).push_back(path_.parent_path() / name);
    if (bytes) left_bytes_ -= bytes->size();
    return bytes;
  });
}

// True if nothing has asked for this file, and it could not be read.
bool Source::lacks(const std::string& uri) const {
  if (uri.empty() || uri.starts_with("data:")) return false;
  const std::filesystem::path name = plain_uri(uri);
  if (std::ranges::find(out_.missing, path_.parent_path() / name) != out_.missing.end())
    return false;
  const auto file = beside(path_, name);
  std::error_code error;
  return !file || !std::filesystem::exists(*file, error);
}

std::vector<std::string> Source::unused_missing() const {
  constexpr std::size_t kMaxLooks = 1024;  // a look is a walk through folders
  std::vector<std::string> uris;
  const auto add = [&](const auto& described) {
    for (const auto& each : std::span(described).first(std::min(described.size(), kMaxLooks)))
      if (lacks(each.uri)) uris.push_back(each.uri);
  };
  add(file_.images);
  add(file_.buffers);
  return uris;
}

core::Result<Source::View> Source::of_buffer(int buffer, std::string_view what) {
  const auto index = index_in(buffer, file_.buffers.size(), what);
  if (!index) return tl::unexpected(index.error());
  const BufferJson& described = file_.buffers[*index];
  std::string name = fmt::format("buffers[{}]", buffer);
  if (!described.uri.empty() && !described.uri.starts_with("data:"))
    name += fmt::format(" (\"{}\")", core::shown(described.uri, kMaxMessage));
  View bytes = binary_;
  if (!described.uri.empty()) {
    std::optional<Bytes>& known = buffers_[*index];
    if (!known) {
      auto read = of_uri(described.uri);
      if (!read)
        return core::fail(read.error().code, fmt::format("{}: {}", name, read.error().message));
      known = *std::move(read);
    }
    bytes = *known;
  } else if (*index != 0 || binary_.empty()) {
    return wrong(name + " has no bytes: it has no uri, and is not the binary part of a .glb");
  }
  if (described.bytes > bytes.size())
    return wrong(fmt::format("{} has {} of its {} bytes", name, bytes.size(), described.bytes));
  return bytes.first(described.bytes);
}

core::Result<Source::View> Source::part_of(int buffer, std::uint64_t offset, std::uint64_t bytes,
                                           const std::string& what) {
  return of_buffer(buffer, "buffer of " + what).and_then([&](View whole) -> core::Result<View> {
    if (offset > whole.size() || bytes > whole.size() - offset)
      return wrong(fmt::format("{} has {} bytes from {} on, but its buffer has {}", what, bytes,
                               offset, whole.size()));
    return whole.subspan(offset, bytes);
  });
}

core::Result<Source::View> Source::of_view(int view, std::string_view what) {
  const auto index = index_in(view, file_.views.size(), fmt::format("bufferView of {}", what));
  if (!index) return tl::unexpected(index.error());
  const ViewJson& described = file_.views[*index];
  if (described.packed) return unpack(*described.packed, *index);
  return part_of(described.buffer, described.offset, described.bytes,
                 fmt::format("bufferViews[{}]", view));
}

core::Result<Source::View> Source::unpack(const PackedJson& packed, std::size_t view) {
  if (unpacked_[view]) return View(*unpacked_[view]);
  const std::string name = fmt::format("EXT_meshopt_compression of bufferViews[{}]", view);
  const auto from = part_of(packed.buffer, packed.offset, packed.bytes, name);
  if (!from) return from;
  if (!has_sound_elements(packed))
    return wrong(fmt::format(
        "{} cannot have {} elements of {} bytes with mode \"{}\", filter \"{}\"", name,
        packed.count, packed.stride, core::shown(packed.mode, 20), core::shown(packed.filter, 20)));
  if (packed.count > left_bytes_ / packed.stride)
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("{} has {} elements of {} bytes; {} bytes are left for it", name,
                                  packed.count, packed.stride, left_bytes_));
  Bytes out(packed.count * packed.stride);
  if (!decode(packed, *from, out)) return wrong(name + " is damaged or cut short");
  left_bytes_ -= out.size();
  unpacked_[view] = std::move(out);
  return View(*unpacked_[view]);
}

}  // namespace psygen::gltf
