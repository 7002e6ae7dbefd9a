// The painted images of a document: they stay in memory until the world is saved, which writes them
// beside its file.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "editor/document/document.hpp"
#include "editor/document/paint_change.hpp"
#include "engine/handmade/files.hpp"

namespace psygen::editor {
namespace {

// The mask that a world has under a name; null: none.
PicturePtr picture_of(const world::World& world, const std::string& name) {
  for (const world::Scatter& scatter : world.scatter)
    if (scatter.mask.image == name) return scatter.mask.picture;
  for (const world::Stamp& stamp : world.shaped.stamps)
    if (stamp.mask.image == name) return stamp.mask.picture;
  return nullptr;
}

bool is_named(const world::World& world, const std::string& name) {
  const auto& stamps = world.shaped.stamps;
  return picture_of(world, name) != nullptr ||
         std::ranges::find(stamps, name, &world::Stamp::image) != stamps.end();
}

core::Result<void> write_picture(const std::filesystem::path& file,
                                 const world::GreyPicture& picture) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && access(file.c_str(), W_OK) != 0)
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: the image is read-only; make it writable and save again, "
                                  "or save the world in another folder",
                                  file.string()));
  std::filesystem::create_directories(file.parent_path(), error);  // writing reports errors
  return write_picture_file(file, picture);
}

}  // namespace

PicturePtr Document::picture(const std::string& name) const {
  if (pictures_) {
    const auto found = pictures_->in_place.find(name);
    if (found != pictures_->in_place.end()) return found->second;
  }
  return picture_of(world(), name);
}

// Only images that the world names; undo may restore the others.
std::vector<std::string> Document::unsaved_pictures() const {
  std::vector<std::string> names;
  if (!pictures_) return names;
  for (const auto& [name, painted] : pictures_->in_place)
    if (is_named(world(), name)) names.push_back(name);
  return names;
}

// An image that equals its file is dropped from memory, so that the file is read again.
handmade::MemoryPicturesPtr Document::with_picture(const std::string& name,
                                                   const PicturePtr& picture) const {
  auto next = pictures_ ? std::make_shared<handmade::InMemoryImages>(*pictures_)
                        : std::make_shared<handmade::InMemoryImages>();
  const auto disk = disk_pictures_.find(name);
  const bool is_on_disk = picture && disk != disk_pictures_.end() && disk->second == picture->hash;
  if (picture && !is_on_disk)
    next->in_place[name] = picture;
  else
    next->in_place.erase(name);
  if (picture) next->fallbacks[name] = picture;
  return next;
}

void Document::note_on_disk(const std::string& name) {
  const bool is_painted = pictures_ && pictures_->in_place.contains(name);
  if (const PicturePtr now = picture(name); now && !is_painted) disk_pictures_[name] = now->hash;
}

core::Result<void> Document::preview_picture(const std::string& name, const PicturePtr& picture) {
  note_on_disk(name);
  const handmade::MemoryPicturesPtr next = with_picture(name, picture);
  auto parsed = parse(*text_, next);
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  next_parsed_ = *std::move(parsed);
  if (!before_preview_) before_preview_ = pictures_;
  pictures_ = next;
  show({text_, parsed_});
  return {};
}

core::Result<void> Document::paint(const QString& step, std::vector<PaintChange> changes,
                                   std::string text) {
  const handmade::MemoryPicturesPtr before = pictures_;
  for (const PaintChange& change : changes) {
    note_on_disk(change.name());
    pictures_ = with_picture(change.name(), change.applied(picture(change.name()), true));
  }
  auto parsed = parse(text);
  pictures_ = before;
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  Edit edit{.text = std::move(text), .step = step, .locks = {}, .paint = std::move(changes)};
  apply_edit(std::move(edit), *std::move(parsed));
  return {};
}

// Removes a preview, which is no undo step, before a step is undone.
void Document::end_preview() {
  if (before_preview_) pictures_ = *std::exchange(before_preview_, std::nullopt);
}

void Document::apply_paint(const std::vector<PaintChange>& changes, bool done) {
  end_preview();
  for (const PaintChange& change : changes)
    pictures_ = with_picture(change.name(), change.applied(picture(change.name()), done));
}

core::Result<void> Document::require_known_pictures(const std::filesystem::path& file) {
  const handmade::FilesPtr disk = handmade::files_with(file, nullptr);
  std::error_code error;
  for (const std::string& name : unsaved_pictures()) {
    const std::filesystem::path at = file.parent_path() / name;
    if (!std::filesystem::exists(at, error)) continue;
    const auto now = disk->read_grey(at);
    const std::uint64_t hash = now ? (*now)->hash : 0;  // 0: a file that is no image
    const auto known = disk_pictures_.find(name);
    const bool is_known = known != disk_pictures_.end() && known->second == hash;
    if (is_known || (now && hash == picture(name)->hash)) continue;
    const auto refused = refused_files_.find(at.string());
    if (refused != refused_files_.end() && refused->second == hash) continue;
    refused_files_[at.string()] = hash;
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{}: another program replaced this image; move it away to keep "
                                  "it, or save again to replace it",
                                  at.string()));
  }
  return {};
}

// Fails if files would be replaced, until the next call with the same files.
core::Result<void> Document::require_free(const std::vector<std::filesystem::path>& taken) {
  std::string others;
  bool is_known = true;
  for (const std::filesystem::path& file : taken) {
    const std::uint64_t stamp = stamp_of(file);
    const auto [refused, is_new] = refused_files_.try_emplace(file.string(), stamp);
    is_known = is_known && !is_new && refused->second == stamp;
    refused->second = stamp;
    if (file != taken.front()) others += (others.empty() ? "" : ", ") + file.string();
  }
  if (is_known) return {};
  return core::fail(
      core::ErrorCode::kInvalidArgument,
      fmt::format("{}: another file of this name exists{}; choose another folder, or save again to "
                  "replace it",
                  taken.front().string(),
                  others.empty() ? others : fmt::format(" (also {})", others)));
}

// Copies the files that a world in another folder would lack, under temporary names. Returns their
// final names.
core::Result<std::vector<std::string>> Document::copy_referenced_files(
    const std::filesystem::path& file, FileCopies& copies) {
  const auto names = handmade::files_named_by(world(), file_);
  if (!names) return tl::unexpected(names.error());
  std::vector<std::string> copied;
  std::vector<std::filesystem::path> taken;
  for (const std::filesystem::path& name : *names) {
    const std::filesystem::path from = file_.parent_path() / name, to = file.parent_path() / name;
    const bool is_painted = pictures_ && pictures_->in_place.contains(name.string());
    if (is_painted || same_content(from, to)) continue;
    std::error_code error;
    if (std::filesystem::exists(from, error) && std::filesystem::exists(to, error))
      taken.push_back(to);
    copied.push_back(name.string());
  }
  if (auto free = require_free(taken); !free) return tl::unexpected(free.error());
  for (const std::string& name : copied)
    if (auto done = copies.add(file_.parent_path() / name, file.parent_path() / name); !done)
      return tl::unexpected(done.error());
  return copied;
}

core::Result<void> Document::write_pictures(const std::filesystem::path& file) const {
  for (const std::string& name : unsaved_pictures())
    if (auto ok = write_picture(file.parent_path() / name, *picture(name)); !ok) return ok;
  return {};
}

void Document::note_pictures_written() {
  refused_files_.clear();
  if (!pictures_) return;
  auto written = std::make_shared<handmade::InMemoryImages>(*pictures_);
  for (const std::string& name : unsaved_pictures()) {
    disk_pictures_[name] = picture(name)->hash;
    written->in_place.erase(name);
  }
  pictures_ = std::move(written);
  before_preview_.reset();
}

}  // namespace psygen::editor
