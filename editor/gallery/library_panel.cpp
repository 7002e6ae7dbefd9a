#include "editor/gallery/library_panel.hpp"

#include <QComboBox>
#include <QCryptographicHash>
#include <QDesktopServices>
#include <QDir>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QPainter>
#include <QSaveFile>
#include <QStandardPaths>
#include <QUrl>
#include <QVBoxLayout>

#include "editor/document/qt_text.hpp"
#include "editor/panels/message_log.hpp"
#include "editor/pictures/model_world.hpp"
#include "editor/pictures/picture_service.hpp"

namespace psygen::editor {
namespace {

constexpr int kIconWidth = 104, kIconHeight = 78;  // three in a row
constexpr int kPictureWidth = 240, kPictureHeight = 180;
constexpr int kPictureVersion = 1;  // images of other versions are rendered again

QString picture_file(const std::string& world_text) {
  QCryptographicHash hash(QCryptographicHash::Sha1);
  hash.addData(QByteArray::number(kPictureVersion));
  hash.addData(QByteArray::fromStdString(world_text));
  return QStandardPaths::writableLocation(QStandardPaths::CacheLocation) + "/library/" +
         QString::fromLatin1(hash.result().toHex()) + ".png";
}

QIcon icon_of(const QImage& image, qreal ratio) {
  QPixmap pixmap =
      QPixmap::fromImage(image.scaled(QSize(kIconWidth, kIconHeight) * ratio,
                                      Qt::KeepAspectRatioByExpanding, Qt::SmoothTransformation));
  pixmap.setDevicePixelRatio(ratio);
  QIcon icon;
  // Not tinted when selected, so that the colours stay true.
  icon.addPixmap(pixmap, QIcon::Normal);
  icon.addPixmap(pixmap, QIcon::Selected);
  return icon;
}

QIcon empty_icon(const QPalette& colours) {
  QPixmap pixmap(kIconWidth, kIconHeight);
  pixmap.fill(colours.color(QPalette::AlternateBase));
  return pixmap;
}

}  // namespace

LibraryPanel::LibraryPanel(Document& document, PictureService& service, MessageLog& messages)
    : document_(document), service_(service), messages_(messages) {
  heading_ = new QComboBox;
  heading_->setAccessibleName(tr("Kind of preset"));
  search_ = new QLineEdit;
  search_->setPlaceholderText(tr("Search"));
  search_->setClearButtonEnabled(true);
  search_->setAccessibleName(tr("Search the library"));
  list_ = new QListWidget;
  list_->setAccessibleName(tr("Presets"));
  list_->setViewMode(QListView::IconMode);
  list_->setIconSize({kIconWidth, kIconHeight});
  list_->setGridSize({kIconWidth + 12, kIconHeight + fontMetrics().height() + 14});
  list_->setResizeMode(QListView::Adjust);
  list_->setMovement(QListView::Static);
  list_->setUniformItemSizes(true);
  list_->setWordWrap(false);
  list_->setFrameShape(QFrame::NoFrame);
  list_->setContextMenuPolicy(Qt::CustomContextMenu);
  auto* line = new QHBoxLayout;
  line->addWidget(heading_);
  line->addWidget(search_, 1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(line);
  layout->addWidget(list_, 1);
  connect(heading_, &QComboBox::activated, this, &LibraryPanel::list);
  connect(search_, &QLineEdit::textChanged, this, &LibraryPanel::list);
  connect(list_, &QListWidget::itemActivated, this,
          [this](QListWidgetItem* item) { apply(*item); });
  connect(list_, &QListWidget::customContextMenuRequested, this, &LibraryPanel::show_menu);
}

void LibraryPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (!loaded_) reload();
}

void LibraryPanel::reload() {
  loaded_ = true;
  std::vector<std::string> problems;
  presets_ = load_library(library_folders(), &problems);
  for (const std::string& problem : problems)
    messages_.show_message(to_qstring(problem));
  const QString chosen = heading_->currentText();
  heading_->clear();
  heading_->addItem(tr("All"));
  for (const Preset& preset : presets_) {
    const QString heading = to_qstring(preset.heading);
    if (heading_->findText(heading) < 0) heading_->addItem(heading);
  }
  heading_->setCurrentIndex(std::max(heading_->findText(chosen), 0));
  list();
}

void LibraryPanel::list() {
  list_->clear();
  const bool all = heading_->currentIndex() <= 0;
  for (std::size_t i = 0; i < presets_.size(); ++i) {
    const Preset& preset = presets_[i];
    const QString name = to_qstring(preset.name);
    const QString doc = to_qstring(preset.doc);
    const QString heading = to_qstring(preset.heading);
    if (!all && heading != heading_->currentText()) continue;
    if (!(name + ' ' + doc + ' ' + heading).contains(search_->text(), Qt::CaseInsensitive))
      continue;
    auto* item = new QListWidgetItem(empty_icon(palette()), name, list_);
    item->setToolTip(doc.isEmpty() ? name : name + "\n" + doc);
    item->setData(Qt::UserRole, static_cast<qulonglong>(i));
  }
  ask_pictures();
}

const Preset& LibraryPanel::preset_of(const QListWidgetItem& item) const {
  return presets_[item.data(Qt::UserRole).toULongLong()];
}

// Loads images from the cache and requests the others, in the order of the list.
void LibraryPanel::ask_pictures() {
  service_.cancel(this);
  const int batch = service_.new_batch();
  awaited_ = 0;
  for (int row = 0; row < list_->count(); ++row) {
    QListWidgetItem* item = list_->item(row);
    const Preset& preset = preset_of(*item);
    const auto text = snippet_world(preset.snippet);
    if (!text) continue;
    const QString kept = picture_file(*text);
    if (QImage image(kept); !image.isNull()) {
      item->setIcon(icon_of(image, devicePixelRatioF()));
      continue;
    }
    PictureRequest request;
    request.kind = is_portrait(preset.snippet) ? PictureKind::kPortrait : PictureKind::kPicture;
    request.text = *text;
    request.file = preset.file.string();
    request.size = {kPictureWidth, kPictureHeight};
    if (request.kind == PictureKind::kPicture) request.place = landscape_viewpoint(preset.snippet);
    ++awaited_;
    service_.ask(std::move(request), batch, row, this,
                 [this, row, kept](const PictureReply& reply) {
                   --awaited_;
                   QListWidgetItem* const of = list_->item(row);
                   if (reply.image.isNull()) {
                     of->setToolTip(of->toolTip() + "\n" + to_qstring(reply.error));
                     return;
                   }
                   of->setIcon(icon_of(reply.image, devicePixelRatioF()));
                   QDir().mkpath(QFileInfo(kept).path());
                   QSaveFile file(kept);
                   if (file.open(QIODevice::WriteOnly) && reply.image.save(&file, "PNG"))
                     file.commit();
                 });
  }
}

void LibraryPanel::apply(const QListWidgetItem& item) {
  const Preset& preset = preset_of(item);
  const QString name = to_qstring(preset.name);
  const bool adds = preset.table == "species" || preset.table == "scatter";
  const auto done =
      document_.edit(adds ? tr("Add %1").arg(name) : tr("Apply %1").arg(name),
                     [&](std::string_view text) { return with_preset(text, preset); });
  if (!messages_.check(done)) return;
  messages_.show_message(adds ? tr("Added %1. Undo removes it.").arg(name)
                              : tr("Applied %1. Undo reverts it.").arg(name));
}

void LibraryPanel::show_menu(const QPoint& at) {
  QMenu menu;
  if (const QListWidgetItem* item = list_->itemAt(at)) {
    const Preset& preset = preset_of(*item);
    const bool adds = preset.table == "species" || preset.table == "scatter";
    menu.addAction(adds ? tr("Add to the world") : tr("Apply to the world"), this,
                   [this, item] { apply(*item); });
    menu.addAction(tr("Open folder"), this, [&preset] {
      QDesktopServices::openUrl(
          QUrl::fromLocalFile(to_qstring(preset.file.parent_path().string())));
    });
    menu.addSeparator();
  }
  menu.addAction(tr("Reload the library"), this, &LibraryPanel::reload);
  menu.exec(list_->viewport()->mapToGlobal(at));
}

}  // namespace psygen::editor
