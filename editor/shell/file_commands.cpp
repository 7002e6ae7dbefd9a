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
#include <QVBoxLayout>

#include "editor/document/recent_files.hpp"

namespace psygen::editor {
namespace {

const char* const kFilter = "Worlds (*.toml);;All files (*)";

QString shown(const std::filesystem::path& file) {
  return QString::fromStdString(file.string());
}

}  // namespace

FileCommands::FileCommands(const EditorContext& context)
    : QObject(&context.window),
      window_(context.window),
      document_(context.document),
      messages_(context.messages),
      recent_menu_(new QMenu(&context.window)) {
  recent_menu_->setTitle(tr("Open &recent"));
  fill_recent_files();
  connect(&document_, &Document::file_changed, this, &FileCommands::on_file_changed);
  connect(&document_, &Document::disk_changed, this, &FileCommands::on_disk_changed);
  connect(&document_, &Document::autosave_failed, &messages_, &MessageLog::show_message);
}

void FileCommands::add_to_menu(QMenu& menu) {
  menu.addAction(tr("&New world"), QKeySequence(QKeySequence::New), this, [this] {
    if (may_discard()) messages_.check(document_.make_new());
  });
  menu.addAction(tr("&Open …"), QKeySequence::Open, this, &FileCommands::choose_file);
  menu.addMenu(recent_menu_);
  menu.addSeparator();
  menu.addAction(tr("&Save"), QKeySequence::Save, this, &FileCommands::save);
  menu.addAction(tr("Save &as …"), QKeySequence::SaveAs, this, &FileCommands::save_as);
  menu.addAction(tr("Show &changes …"), tr("Ctrl+D"), this, &FileCommands::show_diff);
  menu.addAction(tr("Re&vert to the saved file"), this,
                 [this] { messages_.check(document_.revert()); });
}

core::Result<void> FileCommands::open(const std::filesystem::path& file) {
  const core::Result<void> opened = document_.open(file);
  if (messages_.check(opened)) offer_recovery();
  return opened;
}

void FileCommands::on_file_changed() {
  if (document_.file().empty()) return;
  if (document_.is_read_only())
    messages_.show_message(tr("%1 or its folder is read-only. Save your changes in another folder.")
                               .arg(shown(document_.file())));
  QSettings settings;
  note_recent_file(settings, document_.file());
  fill_recent_files();
}

void FileCommands::fill_recent_files() {
  recent_menu_->clear();
  const QSettings settings;
  for (const std::filesystem::path& file : recent_files(settings)) {
    recent_menu_->addAction(shown(file), this, [this, file] {
      if (may_discard()) open(file);
    });
  }
  recent_menu_->setEnabled(!recent_menu_->isEmpty());
}

void FileCommands::choose_file() {
  if (!may_discard()) return;
  const QString file = QFileDialog::getOpenFileName(&window_, tr("Open a world"),
                                                    shown(document_.file().parent_path()), kFilter);
  if (!file.isEmpty()) open(file.toStdString());
}

bool FileCommands::save() {
  if (document_.file().empty()) return save_as();
  const bool saved = messages_.check(document_.save());
  if (saved) messages_.show_message(tr("Saved %1.").arg(shown(document_.file())));
  return saved;
}

bool FileCommands::save_as() {
  const QString file = QFileDialog::getSaveFileName(&window_, tr("Save the world as"),
                                                    shown(document_.file()), kFilter);
  if (file.isEmpty()) return false;
  const auto copied = document_.save_as(file.toStdString());
  if (!copied) return messages_.check(tl::unexpected(copied.error()));
  QString message = tr("Saved %1.").arg(file);
  QStringList names;
  for (const std::string& name : *copied)
    names += QString::fromStdString(name);
  if (!names.isEmpty()) message += " " + tr("Copied with it: %1.").arg(names.join(", "));
  messages_.show_message(message);
  return true;
}

bool FileCommands::may_discard() {
  if (!document_.is_modified()) return true;
  const auto answer = QMessageBox::question(
      &window_, tr("Unsaved changes"), tr("The world has unsaved changes."),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

void FileCommands::show_diff() {
  QDialog dialog(&window_);
  dialog.setWindowTitle(tr("Unsaved changes"));
  dialog.resize(720, 480);
  auto* text = new QPlainTextEdit;
  text->setReadOnly(true);
  text->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  text->setAccessibleName(tr("Unsaved changes"));
  const std::string diff = document_.unsaved_diff();
  text->setPlainText(diff.empty() ? tr("There are no unsaved changes.")
                                  : QString::fromStdString(diff));
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
    return messages_.show_message(tr("The file was removed. Save writes it again."));
  if (!conflict) {
    if (messages_.check(document_.reload()))
      messages_.show_message(tr("Another program changed the file. The editor reloaded it."));
    return;
  }
  QMessageBox box(QMessageBox::Warning, tr("The file has changed"),
                  tr("Another program changed this file, and you have unsaved changes. You can "
                     "undo either choice until you save."),
                  QMessageBox::NoButton, &window_);
  QAbstractButton* reload = box.addButton(tr("Reload the file"), QMessageBox::AcceptRole);
  box.addButton(tr("Keep my version"), QMessageBox::RejectRole);
  box.exec();
  if (box.clickedButton() == reload) {
    messages_.check(document_.reload());
  } else {
    document_.keep_editor_version();
  }
}

void FileCommands::offer_recovery() {
  for (const Recovery& recovery : document_.recoveries()) {
    if (recovery.world_file != document_.file() && !recovery.world_file.empty()) continue;
    const QString name = recovery.world_file.empty() ? tr("an unnamed world")
                                                     : shown(recovery.world_file.filename());
    QMessageBox box(QMessageBox::Question, tr("Recover unsaved changes?"),
                    tr("psygen closed unexpectedly. Recover your changes to %1, last saved "
                       "automatically on %2?")
                        .arg(name, QLocale(QLocale::English).toString(recovery.time)),
                    QMessageBox::NoButton, &window_);
    QAbstractButton* recover = box.addButton(tr("Recover"), QMessageBox::AcceptRole);
    QAbstractButton* discard = box.addButton(tr("Discard"), QMessageBox::DestructiveRole);
    box.addButton(tr("Ask again later"), QMessageBox::RejectRole);
    box.exec();
    if (box.clickedButton() == recover) {
      messages_.check(document_.recover(recovery));
      return;
    }
    if (box.clickedButton() == discard) discard_recovery(recovery);
  }
}

}  // namespace psygen::editor
