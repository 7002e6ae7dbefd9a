// The files of the window: opening, saving, what is on the disk, what a crash left.
#include <QDialog>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFontDatabase>
#include <QMenu>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

#include "editor/document/recent_files.hpp"
#include "editor/shell/main_window.hpp"

namespace psygen::editor {
namespace {

const char* const kFilter = "Worlds (*.toml);;All files (*)";

}  // namespace

bool MainWindow::open_file(const std::filesystem::path& file) {
  if (!tell(document_.open(file))) return false;
  offer_recovery();
  return true;
}

void MainWindow::note_file() {
  fit_title();
  if (document_.file().empty()) return;
  if (document_.is_read_only())
    say(tr("%1 or its folder cannot be written: save changes under another name, in another "
           "folder.")
            .arg(QString::fromStdString(document_.file().string())));
  QSettings settings;
  note_recent_file(settings, document_.file());
  fill_recent_files();
}

void MainWindow::fill_recent_files() {
  recent_menu_->clear();
  const QSettings settings;
  for (const std::filesystem::path& file : recent_files(settings)) {
    recent_menu_->addAction(QString::fromStdString(file.string()), this, [this, file] {
      if (may_discard()) open_file(file);
    });
  }
  recent_menu_->setEnabled(!recent_menu_->isEmpty());
}

void MainWindow::choose_file() {
  if (!may_discard()) return;
  const QString folder = QString::fromStdString(document_.file().parent_path().string());
  const QString file = QFileDialog::getOpenFileName(this, tr("Open a world"), folder, kFilter);
  if (!file.isEmpty()) open_file(file.toStdString());
}

bool MainWindow::save() {
  if (document_.file().empty()) return save_as();
  const bool saved = tell(document_.save());
  if (saved) say(tr("Saved %1.").arg(QString::fromStdString(document_.file().string())));
  return saved;
}

bool MainWindow::save_as() {
  const QString file = QFileDialog::getSaveFileName(
      this, tr("Save the world as"), QString::fromStdString(document_.file().string()), kFilter);
  if (file.isEmpty()) return false;
  const auto copied = document_.save_as(file.toStdString());
  if (!copied) return tell(tl::unexpected(copied.error()));
  QString sentence = tr("Saved %1.").arg(file);
  QStringList names;
  for (const std::string& name : *copied)
    names += QString::fromStdString(name);
  if (!names.isEmpty()) sentence += " " + tr("Copied with it: %1.").arg(names.join(", "));
  say(sentence);
  return true;
}

bool MainWindow::may_discard() {
  if (!document_.is_modified()) return true;
  const auto answer = QMessageBox::question(
      this, tr("Unsaved changes"), tr("The world has changes that are not saved."),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

void MainWindow::show_diff() {
  QDialog dialog(this);
  dialog.setWindowTitle(tr("Changes that are not saved"));
  dialog.resize(720, 480);
  auto* text = new QPlainTextEdit;
  text->setReadOnly(true);
  text->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  text->setAccessibleName(tr("Changes that are not saved"));
  const std::string diff = document_.unsaved_diff();
  text->setPlainText(diff.empty() ? tr("Nothing has changed.") : QString::fromStdString(diff));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  auto* layout = new QVBoxLayout(&dialog);
  layout->addWidget(text);
  layout->addWidget(buttons);
  if (dialog.exec() == QDialog::Accepted) save();
}

void MainWindow::disk_changed(DiskState state, bool conflict) {
  if (state == DiskState::kSame) return;
  if (state == DiskState::kRemoved) return say(tr("The file was removed. Save writes it again."));
  if (!conflict) {
    if (tell(document_.reload())) say(tr("The file has changed on the disk and was read again."));
    return;
  }
  QMessageBox box(QMessageBox::Warning, tr("The file has changed"),
                  tr("Another program has changed this file, and it has changes here that are not "
                     "saved. Whatever you choose can be undone until you save."),
                  QMessageBox::NoButton, this);
  QAbstractButton* reload = box.addButton(tr("Read the file again"), QMessageBox::AcceptRole);
  box.addButton(tr("Keep my text"), QMessageBox::RejectRole);
  box.exec();
  if (box.clickedButton() == reload) {
    tell(document_.reload());
  } else {
    document_.keep_mine();
  }
}

void MainWindow::offer_recovery() {
  for (const Recovery& recovery : document_.recoveries()) {
    if (recovery.world_file != document_.file() && !recovery.world_file.empty()) continue;
    const QString name = recovery.world_file.empty()
                             ? tr("a world without a name")
                             : QString::fromStdString(recovery.world_file.filename().string());
    QMessageBox box(QMessageBox::Question, tr("Changes from before"),
                    tr("The editor ended without saving changes of %1, %2.")
                        .arg(name, QLocale(QLocale::English).toString(recovery.time)),
                    QMessageBox::NoButton, this);
    QAbstractButton* take = box.addButton(tr("Restore the changes"), QMessageBox::AcceptRole);
    QAbstractButton* discard = box.addButton(tr("Discard them"), QMessageBox::DestructiveRole);
    box.addButton(tr("Ask again later"), QMessageBox::RejectRole);
    box.exec();
    if (box.clickedButton() == take) {
      tell(document_.recover(recovery));
      return;
    }
    if (box.clickedButton() == discard) discard_recovery(recovery);
  }
}

}  // namespace psygen::editor
