#include "editor/shell/file_commands.hpp"

#include <QAction>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFontDatabase>
#include <QMenu>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSettings>
#include <QStandardPaths>
#include <QVBoxLayout>

#include "editor/document/line_diff.hpp"
#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

const char* const kFilter = "Worlds (*.toml);;All files (*)";
const char* const kRecentKey = "recent_files";
constexpr qsizetype kMaxRecentFiles = 12;

}  // namespace

FileCommands::FileCommands(const EditorContext& context)
    : QObject(&context.window), context_(context), recent_menu_(new QMenu(&context.window)) {
  recent_menu_->setTitle(tr("Open &recent"));
  fill_recent_files();
  connect(&context_.document, &Document::file_changed, this, &FileCommands::on_file_changed);
  connect(&context_.document, &Document::disk_changed, this, &FileCommands::on_disk_changed);
  connect(&context_.document, &Document::autosave_failed, &context_.messages,
          &MessageLog::show_message);
}

void FileCommands::add_to_menu(QMenu& menu) {
  menu.addAction(tr("&New world"), QKeySequence(QKeySequence::New), this, [this] {
    if (may_discard() && context_.messages.check(context_.document.make_new())) offer_recovery();
  });
  menu.addAction(tr("&Open …"), QKeySequence::Open, this, &FileCommands::choose_file);
  menu.addMenu(recent_menu_);
  menu.addSeparator();
  menu.addAction(tr("&Save"), QKeySequence::Save, this, &FileCommands::save);
  menu.addAction(tr("Save &as …"), QKeySequence::SaveAs, this, &FileCommands::save_as);
  menu.addAction(tr("Show &changes …"), tr("Ctrl+D"), this, &FileCommands::show_diff);
  menu.addAction(tr("Re&vert to the saved file"), this,
                 [this] { context_.messages.check(context_.document.revert()); });
}

core::Result<void> FileCommands::open(const std::filesystem::path& file) {
  const core::Result<void> opened = context_.document.open(file);
  if (context_.messages.check(opened)) offer_recovery();
  return opened;
}

void FileCommands::on_file_changed() {
  if (context_.document.file().empty()) return;
  if (context_.document.is_template())
    context_.messages.show_message(
        tr("%1 comes with psygen and stays as it is. The first save asks for a file of your own.")
            .arg(to_qstring(context_.document.file().filename().string())));
  if (context_.document.is_read_only())
    context_.messages.show_message(
        tr("%1 or its folder is read-only. Save your changes in another folder.")
            .arg(to_qstring(context_.document.file().string())));
  std::error_code error;
  const auto whole = std::filesystem::absolute(context_.document.file(), error);
  const QString name =
      to_qstring((error ? context_.document.file() : whole.lexically_normal()).string());
  QSettings settings;
  QStringList names = settings.value(kRecentKey).toStringList();
  names.removeAll(name);
  names.prepend(name);
  settings.setValue(kRecentKey, names.mid(0, kMaxRecentFiles));
  fill_recent_files();
}

void FileCommands::fill_recent_files() {
  recent_menu_->clear();
  // Missing files stay in the list, because a disk may be mounted again.
  for (const QString& file : QSettings().value(kRecentKey).toStringList()) {
    recent_menu_->addAction(file, this, [this, file] {
      if (may_discard()) open(file.toStdString());
    });
  }
  recent_menu_->setEnabled(!recent_menu_->isEmpty());
}

void FileCommands::choose_file() {
  if (!may_discard()) return;
  const QString file = QFileDialog::getOpenFileName(
      &context_.window, tr("Open a world"),
      to_qstring(context_.document.file().parent_path().string()), kFilter);
  if (!file.isEmpty()) open(file.toStdString());
}

bool FileCommands::save() {
  if (context_.document.file().empty() || context_.document.is_template()) return save_as();
  const bool saved = context_.messages.check(context_.document.save());
  if (saved)
    context_.messages.show_message(
        tr("Saved %1.").arg(to_qstring(context_.document.file().string())));
  return saved;
}

bool FileCommands::save_as() {
  QString suggested = to_qstring(context_.document.file().string());
  if (context_.document.is_template())
    suggested = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation) + "/" +
                to_qstring(context_.document.file().filename().string());
  const QString file =
      QFileDialog::getSaveFileName(&context_.window, tr("Save the world as"), suggested, kFilter);
  if (file.isEmpty()) return false;
  const auto copied = context_.document.save_as(file.toStdString());
  if (!copied) return context_.messages.check(tl::unexpected(copied.error()));
  QString message = tr("Saved %1.").arg(file);
  QStringList names;
  for (const std::string& name : *copied)
    names += to_qstring(name);
  if (!names.isEmpty()) message += " " + tr("Copied with it: %1.").arg(names.join(", "));
  context_.messages.show_message(message);
  return true;
}

bool FileCommands::may_discard() {
  if (!context_.document.is_modified()) return true;
  const auto answer = QMessageBox::question(
      &context_.window, tr("Unsaved changes"), tr("The world has unsaved changes."),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

void FileCommands::show_diff() {
  QDialog dialog(&context_.window);
  dialog.setWindowTitle(tr("Unsaved changes"));
  dialog.resize(720, 480);
  auto* text = new QPlainTextEdit;
  text->setReadOnly(true);
  text->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  text->setAccessibleName(tr("Unsaved changes"));
  const std::string diff = context_.document.unsaved_diff();
  text->setPlainText(diff.empty() ? tr("There are no unsaved changes.") : to_qstring(diff));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  auto* layout = new QVBoxLayout(&dialog);
  layout->addWidget(text);
  layout->addWidget(buttons);
  if (dialog.exec() == QDialog::Accepted) save();
}

void FileCommands::on_disk_changed(DiskState state, bool conflict) {
  if (state == DiskState::kSame) return;
  if (state == DiskState::kRemoved)
    return context_.messages.show_message(tr("The file was removed. Save writes it again."));
  if (!conflict) {
    if (context_.messages.check(context_.document.reload()))
      context_.messages.show_message(
          tr("Another program changed the file. The editor reloaded it."));
    return;
  }
  QMessageBox box(QMessageBox::Warning, tr("The file has changed"),
                  tr("Another program changed this file, and you have unsaved changes. You can "
                     "undo either choice until you save."),
                  QMessageBox::NoButton, &context_.window);
  QAbstractButton* reload = box.addButton(tr("Reload the file"), QMessageBox::AcceptRole);
  box.addButton(tr("Keep my version"), QMessageBox::RejectRole);
  box.exec();
  if (box.clickedButton() == reload) {
    context_.messages.check(context_.document.reload());
  } else {
    context_.document.keep_editor_version();
  }
}

// A file gets its own recoveries. A new world gets those of worlds without a file, and of files
// that are gone: these become the document only by a choice that is not the default.
void FileCommands::offer_recovery() {
  const std::filesystem::path& file = context_.document.file();
  for (const Recovery& recovery : context_.document.recoveries()) {
    std::error_code error;
    const bool has_file = std::filesystem::exists(recovery.world_file, error);
    if (file.empty() ? has_file : !same_file(recovery.world_file, file)) {
      if (recovery.world_file.empty())
        context_.messages.show_message(
            tr("Unsaved changes to a new world are kept. \"New world\" offers them."));
      continue;
    }
    const bool is_current = context_.document.text() == recovery.saved_text;
    QMessageBox box(
        QMessageBox::Question, tr("Recover unsaved changes?"),
        tr("psygen closed unexpectedly. Recover your changes to %1?")
            .arg(recovery.world_file.empty() ? tr("a new world")
                                             : to_qstring(recovery.world_file.string())),
        QMessageBox::NoButton, &context_.window);
    QString about = tr("Last saved automatically on %1. Changed lines: %2. Painted masks: %3.")
                        .arg(kEnglish.toString(recovery.time.toLocalTime()))
                        .arg(changed_lines(recovery.saved_text, recovery.text))
                        .arg(recovery.pictures.size());
    if (has_file && !is_current) about += " " + tr("The file has changed since then.");
    if (!has_file) about += " " + tr("They replace the new world in this window.");
    box.setInformativeText(about);
    QPushButton* recover = box.addButton(tr("Recover"), QMessageBox::AcceptRole);
    QPushButton* discard = box.addButton(tr("Discard"), QMessageBox::DestructiveRole);
    QPushButton* later = box.addButton(tr("Ask again later"), QMessageBox::RejectRole);
    box.setDefaultButton(has_file && is_current ? recover : later);
    box.setEscapeButton(later);
    box.exec();
    if (box.clickedButton() == recover) {
      context_.messages.check(context_.document.recover(recovery));
      return;
    }
    if (box.clickedButton() == discard) discard_recovery(recovery);
  }
}

}  // namespace psygen::editor
