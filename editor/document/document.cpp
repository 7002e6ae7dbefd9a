// The text, its file and its recovery. Edits are in document_edits.cpp.
#include "editor/document/document.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "editor/document/line_diff.hpp"
#include "editor/document/qt_text.hpp"
#include "engine/core/assert.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/shaped_ground.hpp"

namespace psygen::editor {
namespace {

constexpr const char* kNewWorld = R"(format = 1

[world]
name = "new world"
seed = 1
blocks = [0, 0]            # endless

[terrain]

[[scatter]]
model = "tree"
count = 20

[[scatter]]
model = "rock"
count = 20
)";

bool same_ground(const world::World& a, const world::World& b) {
  return a.seed == b.seed && a.blocks_x == b.blocks_x && a.blocks_z == b.blocks_z &&
         a.terrain == b.terrain && a.water == b.water &&
         world::shape_hash(a) == world::shape_hash(b);
}

constexpr int kDiskDelayMs = 100;  // after the last change of the file

core::Result<void> ships_with_psygen(const std::filesystem::path& file) {
  return core::fail(
      core::ErrorCode::kInvalidArgument,
      fmt::format("{}: this world comes with psygen; save it as another file", file.string()));
}

}  // namespace

Document::Document(DocumentOptions options, QObject* parent)
    : QObject(parent), options_(std::move(options)) {
  if (options_.state_folder.empty()) options_.state_folder = default_state_folder();
  autosave_timer_.setSingleShot(true);
  autosave_timer_.setInterval(options_.autosave_ms);
  connect(&autosave_timer_, &QTimer::timeout, this, &Document::autosave);
  disk_timer_.setSingleShot(true);
  disk_timer_.setInterval(kDiskDelayMs);
  const auto start = qOverload<>(&QTimer::start);
  connect(&watcher_, &QFileSystemWatcher::fileChanged, &disk_timer_, start);
  connect(&watcher_, &QFileSystemWatcher::directoryChanged, &disk_timer_, start);
  connect(&disk_timer_, &QTimer::timeout, this, [this] {
    const QString file = to_qstring(file_.string());
    if (!file_.empty() && !watcher_.files().contains(file)) watcher_.addPath(file);  // replaced
    check_disk();
  });
  text_ = std::make_shared<const std::string>(kNewWorld);
  const auto made = make_new();
  PSYGEN_CHECK(made.has_value(), "the text of a new world must be valid");
}

Document::~Document() {
  save_locks();
}

std::string Document::name() const {
  return file_.empty() ? "the new world" : file_.string();
}

core::Result<ParsedWorldPtr> Document::parse(const std::string& text,
                                             const handmade::MemoryPicturesPtr& pictures) const {
  if (text.size() > world::kMaxFileBytes)
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("{}: the file would be too large (allowed: {} bytes)", name(),
                                  world::kMaxFileBytes));
  return parse_world_text(text, name(), options_.register_models,
                          handmade::files_with(name(), pictures).get());
}

bool Document::is_shipped(const std::filesystem::path& file) const {
  constexpr auto kSkip = std::filesystem::directory_options::skip_permission_denied;
  for (const std::filesystem::path& folder : options_.shipped_folders) {
    std::error_code error, differ;
    std::filesystem::recursive_directory_iterator it(folder, kSkip, error);
    for (; !error && it != end(it); it.increment(error))
      if (std::filesystem::equivalent(*it, file, differ)) return true;
  }
  return false;
}

core::Result<std::unique_ptr<RecoverySession>> Document::session_of(
    const std::filesystem::path& file, bool share) {
  if (session_ && same_file(file, file_)) return std::move(session_);
  return RecoverySession::start(options_.state_folder, file, share);
}

core::Result<void> Document::open(const std::filesystem::path& file, bool share) {
  auto text = world::read_text_file(file);
  if (!text) return tl::unexpected(std::move(text.error()));
  auto parsed = parse_world_text(*text, file.string(), options_.register_models);
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  auto session = session_of(file, share || is_shipped(file));
  if (!session) return tl::unexpected(std::move(session.error()));
  set_document_text(file, *std::move(text), *std::move(parsed), *std::move(session));
  return {};
}

core::Result<void> Document::make_new(std::string text, handmade::MemoryPicturesPtr pictures) {
  if (text.empty()) text = kNewWorld;
  const handmade::FilesPtr files = handmade::files_with({}, pictures);
  auto parsed = parse_world_text(text, "the new world", options_.register_models, files.get());
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  auto session = session_of({}, false);
  if (!session) return tl::unexpected(std::move(session.error()));
  set_document_text({}, std::move(text), *std::move(parsed), *std::move(session),
                    std::move(pictures));
  return {};
}

void Document::set_document_text(const std::filesystem::path& file, std::string text,
                                 ParsedWorldPtr parsed, std::unique_ptr<RecoverySession> session,
                                 handmade::MemoryPicturesPtr pictures) {
  save_locks();
  autosave_timer_.stop();
  session_ = std::move(session);
  session_->clear();
  file_ = file;
  is_template_ = is_shipped(file);
  locks_ = kept_locks_ =
      file_.empty() ? FieldLocks() : FieldLocks::load(options_.state_folder, file_);
  drag_ = 0;
  discard_proposed_edit();
  text_ = std::make_shared<const std::string>(std::move(text));
  parsed_ = std::move(parsed);
  sections_.reset();
  pictures_ = std::move(pictures);
  before_preview_.reset();
  disk_pictures_.clear();
  refused_files_.clear();
  undo_.clear();
  watch_disk();
  note_saved(*text_);
  Q_EMIT file_changed();
  Q_EMIT changed(Change::kFile);
}

void Document::watch_disk() {
  disk_timer_.stop();
  if (const QStringList all = watcher_.files() + watcher_.directories(); !all.isEmpty())
    watcher_.removePaths(all);
  if (file_.empty()) return;
  const std::filesystem::path folder = file_.parent_path();
  watcher_.addPath(folder.empty() ? "." : to_qstring(folder.string()));
  watcher_.addPath(to_qstring(file_.string()));
}

void Document::note_saved(std::string text) {
  saved_ = std::move(text);
  seen_ = saved_;
  if (!is_modified()) undo_.setClean();
  note_modified();
}

void Document::note_modified() {
  if (is_modified() == was_modified_) return;
  was_modified_ = is_modified();
  Q_EMIT modified_changed(was_modified_);
}

core::Result<void> Document::require_known_disk() const {
  std::error_code error;
  if (!std::filesystem::exists(file_, error)) return {};  // saving overwrites no changes
  const auto text = world::read_text_file(file_);
  if (text && *text == saved_) return {};
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("{}: another program changed the file; reload it, or keep your "
                                "version and save again",
                                name()));
}

core::Result<void> Document::save() {
  if (file_.empty())
    return core::fail(core::ErrorCode::kInvalidArgument, "this world has no file yet");
  if (is_template_) return ships_with_psygen(file_);
  if (auto known = require_known_disk(); !known) return known;
  if (auto known = require_known_pictures(file_); !known) return known;
  if (auto written = write_all(file_); !written) return written;
  note_written();
  return {};
}

void Document::note_written() {
  note_saved(*text_);
  autosave();
  save_locks();
  watch_disk();
}

core::Result<void> Document::write_all(const std::filesystem::path& file) {
  auto written = write_pictures(file).and_then([&] { return core::replace_file(file, *text_); });
  if (written) note_pictures_written();
  return written;
}

core::Result<std::vector<std::string>> Document::save_as(const std::filesystem::path& file,
                                                         bool share) {
  std::vector<std::string> copied;
  if (file.empty()) return core::fail(core::ErrorCode::kInvalidArgument, "the file has no name");
  if (is_shipped(file)) return tl::unexpected(ships_with_psygen(file).error());
  if (auto known = require_known_pictures(file); !known)
    return tl::unexpected(std::move(known.error()));
  if (same_file(file, file_)) {
    if (auto written = write_all(file_); !written)
      return tl::unexpected(std::move(written.error()));
  } else {
    auto session = RecoverySession::start(options_.state_folder, file, share);
    if (!session) return tl::unexpected(std::move(session.error()));
    FileCopies copies;
    auto taken = copy_referenced_files(file, copies);
    if (!taken) return taken;
    for (const std::string& name : unsaved_pictures())
      copies.expect(file.parent_path() / name);
    const auto written = copies.commit().and_then([&] { return write_all(file); });
    if (!written) return tl::unexpected(written.error());
    copies.keep();
    copied = *std::move(taken);
    session_ = *std::move(session);
    file_ = file;
    is_template_ = false;
    Q_EMIT file_changed();
  }
  note_written();
  return copied;
}

core::Result<void> Document::revert() {
  if (unsaved_pictures().empty()) return set_text(saved_, tr("Revert"));
  std::vector<PaintChange> changes;
  for (const auto& [name, painted] : pictures_->in_place)
    changes.emplace_back(name, painted, nullptr);
  return paint(tr("Revert"), std::move(changes), saved_);
}

bool Document::is_read_only() const {
  if (file_.empty() || is_template_) return false;
  const std::filesystem::path folder = file_.parent_path();
  return access(file_.c_str(), W_OK) != 0 ||
         access(folder.empty() ? "." : folder.c_str(), W_OK) != 0;
}

std::string Document::unsaved_diff() const {
  std::string diff = unified_diff(saved_, *text_, name(), name() + " (unsaved)");
  for (const std::string& picture : unsaved_pictures())
    diff += fmt::format("Binary files {0} and {0} (unsaved) differ\n", picture);
  return diff;
}

DiskState Document::check_disk() {
  if (file_.empty()) return DiskState::kSame;
  std::optional<std::string> now;
  std::error_code error;
  if (std::filesystem::exists(file_, error)) {
    auto text = world::read_text_file(file_);
    now = text ? *std::move(text) : text.error().message;
  }
  const DiskState state = !now             ? DiskState::kRemoved
                          : *now == saved_ ? DiskState::kSame
                                           : DiskState::kChanged;
  if (now != seen_) {
    seen_ = std::move(now);
    Q_EMIT disk_changed(state, is_modified() && state != DiskState::kSame);
  }
  return state;
}

core::Result<void> Document::reload() {
  auto text = world::read_text_file(file_);
  if (!text) return tl::unexpected(std::move(text.error()));
  if (auto set = set_text(*text, tr("Reload")); !set) return set;
  note_saved(*std::move(text));
  autosave();
  return {};
}

void Document::keep_editor_version() {
  check_disk();
  saved_ = seen_.value_or("");
  note_modified();
  autosave_timer_.start();
}

const std::vector<world::WorldSection>& Document::sections() const {
  if (!sections_) {
    auto made = world::world_schema(*text_, parsed_->world, parsed_->registry);
    PSYGEN_CHECK(made.has_value(), "the world must match the text");
    sections_ = *std::move(made);
  }
  return *sections_;
}

const world::WorldField* Document::field(const world::TextPath& path) const {
  return world::find_field(sections(), path);
}

void Document::show(const ShownText& shown) {
  const ParsedWorldPtr before = parsed_;
  if (next_parsed_) {
    parsed_ = std::exchange(next_parsed_, nullptr);
  } else {
    end_preview();
    auto parsed = parse(*shown.text);
    parsed_ = parsed ? *std::move(parsed) : shown.world;  // resources may be missing
  }
  text_ = shown.text;
  sections_.reset();
  discard_proposed_edit();
  Q_EMIT changed(same_ground(before->world, world()) ? Change::kText : Change::kGround);
  note_modified();
  if (!autosave_timer_.isActive()) autosave_timer_.start();
}

core::Result<void> Document::write_recovery() {
  if (!is_modified()) {
    session_->clear();
    return {};
  }
  return session_->write({.world_file = file_,
                          .text = *text_,
                          .saved_text = saved_,
                          .time = {},
                          .file = {},
                          .pictures = pictures_ ? pictures_->in_place : handmade::NamedPictures()});
}

void Document::autosave() {
  const auto written = write_recovery();
  if (!written && !autosave_has_failed_)
    Q_EMIT autosave_failed(to_qstring(written.error().message));
  autosave_has_failed_ = !written;
}

void Document::save_locks() const {
  if (!file_.empty() && locks_ != kept_locks_)
    (void)locks_.save(options_.state_folder, file_);  // losing the locks is acceptable
}

core::Result<void> Document::recover(const Recovery& recovery) {
  // The name by which the document has the file: its resources lie beside it.
  const std::filesystem::path file =
      same_file(recovery.world_file, file_) ? file_ : recovery.world_file;
  const auto pictures = std::make_shared<const handmade::InMemoryImages>(
      handmade::InMemoryImages{recovery.pictures, recovery.pictures});
  const auto parsed = parse_world_text(recovery.text, file.string(), options_.register_models,
                                       handmade::files_with(file, pictures).get());
  if (!parsed) return tl::unexpected(parsed.error());
  if (file.empty() || !open(file)) {
    if (auto made = make_new(recovery.text, pictures); !made) return made;
    saved_ = recovery.world_file.empty() ? recovery.saved_text : "";
    note_modified();
  } else {
    std::vector<PaintChange> changes;
    for (const auto& [name, picture] : recovery.pictures)
      changes.emplace_back(name, nullptr, picture);
    const QString step = tr("Recover unsaved changes");
    auto set = changes.empty() ? set_text(recovery.text, step)
                               : paint(step, std::move(changes), recovery.text);
    if (!set) return set;
  }
  if (auto written = write_recovery(); !written) return written;
  discard_recovery(recovery);
  return {};
}

}  // namespace psygen::editor
