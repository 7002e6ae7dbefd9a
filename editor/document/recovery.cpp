#include "editor/document/recovery.hpp"

#include <fmt/format.h>

#include <QCryptographicHash>
#include <QDir>
#include <QJsonDocument>
#include <QJsonObject>
#include <QStandardPaths>
#include <QUuid>
#include <algorithm>
#include <cstdlib>
#include <set>

#include "editor/document/paint_change.hpp"
#include "editor/document/qt_text.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::editor {
namespace {

constexpr int kRecoveryFormat = 1;
constexpr std::uint64_t kMaxBytes = std::uint64_t{16} << 20;
constexpr const char* kEnding = ".recovery";
constexpr const char* kPictureEnding = ".png";

// The path of a file without links; it need not exist. Empty for an empty path.
std::filesystem::path without_links(const std::filesystem::path& file) {
  if (file.empty()) return {};
  std::error_code error;
  const auto whole = std::filesystem::absolute(file, error);
  if (error) return file;
  const auto found = std::filesystem::weakly_canonical(whole, error);
  return error ? whole : found;
}

// The image files of a recovery file: ID.HASH.png.
std::filesystem::path picture_file(const std::filesystem::path& recovery_file,
                                   const world::GreyPicture& picture) {
  return recovery_file.parent_path() /
         fmt::format("{}.{:016x}.png", recovery_file.stem().string(), picture.hash);
}

// Removes the image files of a recovery file that are not in `kept`.
void remove_pictures(const std::filesystem::path& recovery_file,
                     const std::set<std::filesystem::path>& kept) {
  const std::string start = recovery_file.stem().string() + ".";
  std::vector<std::filesystem::path> gone;
  std::error_code error;
  for (std::filesystem::directory_iterator it(recovery_file.parent_path(), error), end;
       !error && it != end; it.increment(error)) {
    const bool is_one = it->path().filename().string().starts_with(start) &&
                        it->path().extension() == kPictureEnding;
    if (is_one && !kept.contains(it->path())) gone.push_back(it->path());
  }
  for (const std::filesystem::path& file : gone)
    std::filesystem::remove(file, error);
}

// Reads the images of a recovery. `names`: image names and their files. Skips unreadable files.
handmade::NamedPictures read_pictures(const std::filesystem::path& folder,
                                      const QJsonObject& names) {
  handmade::NamedPictures pictures;
  for (auto it = names.begin(); it != names.end(); ++it) {
    const auto name = std::filesystem::path(it.value().toString().toStdString()).filename();
    if (auto picture = handmade::files().read_grey(folder / name))
      pictures[it.key().toStdString()] = *std::move(picture);
  }
  return pictures;
}

QString lock_name(const std::filesystem::path& recovery_file) {
  return to_qstring(recovery_file.string() + ".lock");
}

std::unique_ptr<QLockFile> locked(const QString& name) {
  auto lock = std::make_unique<QLockFile>(name);
  lock->setStaleLockTime(0);  // a lock becomes stale only by the end of its process
  lock->tryLock(0);
  return lock;
}

core::Error open_elsewhere(const QLockFile& lock, const std::filesystem::path& world_file) {
  qint64 process = 0;
  QString host, program;
  lock.getLockInfo(&process, &host, &program);
  return {core::ErrorCode::kInvalidArgument,
          fmt::format("{}: another editor has this file open (process {} on {})",
                      world_file.string(), process, host.toStdString())};
}

// Returns nullopt if the file is damaged or of a newer version.
std::optional<Recovery> read_recovery(const std::filesystem::path& file) {
  const auto text = world::read_text_file(file, kMaxBytes);
  if (!text) return {};
  const QJsonObject read = QJsonDocument::fromJson(QByteArray::fromStdString(*text)).object();
  if (read["format"].toInt() != kRecoveryFormat) return {};
  Recovery recovery;
  recovery.world_file = read["world_file"].toString().toStdString();
  // Relative to an unknown folder, in files of earlier editors.
  if (recovery.world_file.is_relative()) recovery.world_file.clear();
  recovery.text = read["text"].toString().toStdString();
  recovery.saved_text = read["saved_text"].toString().toStdString();
  recovery.time = QDateTime::fromString(read["time"].toString(), Qt::ISODateWithMs);
  recovery.file = file;
  recovery.pictures = read_pictures(file.parent_path(), read["pictures"].toObject());
  return recovery;
}

}  // namespace

std::filesystem::path default_state_folder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && state[0] == '/') return std::filesystem::path(state) / "psygen-editor";
  return std::filesystem::path(QDir::homePath().toStdString()) / ".local/state/psygen-editor";
}

QString file_key(const std::filesystem::path& world_file) {
  const QByteArray name = QByteArray::fromStdString(without_links(world_file).string());
  return QString::fromLatin1(
      QCryptographicHash::hash(name, QCryptographicHash::Sha1).toHex().left(20));
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  return !a.empty() && !b.empty() && without_links(a) == without_links(b);
}

core::Result<std::unique_ptr<RecoverySession>> RecoverySession::start(
    const std::filesystem::path& state_folder, const std::filesystem::path& world_file,
    bool share) {
  std::unique_ptr<RecoverySession> session(new RecoverySession);
  std::error_code ignored;  // acquiring the locks fails too
  std::filesystem::create_directories(state_folder, ignored);
  const QString id = QUuid::createUuid().toString(QUuid::Id128);
  session->file_ = state_folder / (id.toStdString() + kEnding);
  session->running_ = locked(lock_name(session->file_));
  if (world_file.empty()) return session;
  session->document_ = locked(lock_name(state_folder / file_key(world_file).toStdString()));
  if (session->document_->error() == QLockFile::LockFailedError && !share)
    return tl::unexpected(open_elsewhere(*session->document_, world_file));
  return session;
}

RecoverySession::~RecoverySession() {
  if (!file_.empty()) clear();
}

core::Result<void> RecoverySession::write(const Recovery& recovery) const {
  QJsonObject names;
  std::set<std::filesystem::path> kept;
  for (const auto& [name, picture] : recovery.pictures) {
    const std::filesystem::path file = picture_file(file_, *picture);
    names[to_qstring(name)] = to_qstring(file.filename().string());
    std::error_code error;
    if (!kept.insert(file).second || std::filesystem::exists(file, error)) continue;
    if (auto written = write_picture_file(file, *picture); !written) return written;
  }
  const QJsonObject object{{"format", kRecoveryFormat},
                           {"world_file", to_qstring(without_links(recovery.world_file).string())},
                           {"text", to_qstring(recovery.text)},
                           {"saved_text", to_qstring(recovery.saved_text)},
                           {"pictures", names},
                           {"time", QDateTime::currentDateTimeUtc().toString(Qt::ISODateWithMs)}};
  const QByteArray bytes = QJsonDocument(object).toJson(QJsonDocument::Compact);
  auto written = core::replace_file(
      file_, std::string_view(bytes.constData(), static_cast<std::size_t>(bytes.size())));
  if (written) remove_pictures(file_, kept);
  return written;
}

void RecoverySession::clear() const {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  remove_pictures(file_, {});
}

std::vector<Recovery> left_recoveries(const std::filesystem::path& state_folder) {
  std::vector<Recovery> found;
  std::error_code error;
  for (std::filesystem::directory_iterator it(state_folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().extension() != kEnding) continue;
    const auto lock = locked(lock_name(it->path()));
    if (lock->error() == QLockFile::LockFailedError) continue;  // its session runs
    if (auto recovery = read_recovery(it->path())) found.push_back(*std::move(recovery));
  }
  std::ranges::sort(found, std::greater(), &Recovery::time);
  return found;
}

void discard_recovery(const Recovery& recovery) {
  std::error_code ignored;
  std::filesystem::remove(recovery.file, ignored);
  std::filesystem::remove(lock_name(recovery.file).toStdString(), ignored);
  remove_pictures(recovery.file, {});
}

}  // namespace psygen::editor
