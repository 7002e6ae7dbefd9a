#include "editor/attach/attach_dialog.hpp"

#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <vector>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

constexpr int kListMs = 1000;

// The command without the folder of its program.
QString command_text(const std::string& command) {
  const std::size_t end = command.find(' ');
  const std::size_t slash = command.rfind('/', end);
  return to_qstring(slash == std::string::npos ? command : command.substr(slash + 1));
}

class AttachDialog final : public QDialog {
 public:
  explicit AttachDialog(QWidget* parent);

  // The chosen program, after the dialog was accepted.
  std::optional<inspect::Endpoint> chosen() const {
    const int row = list_->currentRow();
    if (row < 0 || row >= static_cast<int>(endpoints_.size())) return std::nullopt;
    return endpoints_[static_cast<std::size_t>(row)];
  }

 private:
  void list();

  std::vector<inspect::Endpoint> endpoints_;
  QListWidget* list_;
  QLabel* hint_;
  QPushButton* attach_;
  QTimer timer_;
};

AttachDialog::AttachDialog(QWidget* parent)
    : QDialog(parent), list_(new QListWidget), hint_(new QLabel) {
  setWindowTitle(tr("Attach to a running game or flight"));
  resize(620, 300);
  list_->setAccessibleName(tr("Programs that can be inspected"));
  list_->setTextElideMode(Qt::ElideRight);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  hint_->setWordWrap(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  attach_ = buttons->addButton(tr("Attach"), QDialogButtonBox::AcceptRole);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(list_, 1);
  layout->addWidget(hint_);
  layout->addWidget(buttons);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(list_, &QListWidget::itemActivated, this, &QDialog::accept);
  connect(&timer_, &QTimer::timeout, this, &AttachDialog::list);
  timer_.start(kListMs);
  list();
}

void AttachDialog::list() {
  const auto found = inspect::endpoints();
  std::vector<inspect::Endpoint> now = found ? *found : std::vector<inspect::Endpoint>{};
  const bool same = std::ranges::equal(now, endpoints_, {}, &inspect::Endpoint::socket,
                                       &inspect::Endpoint::socket);
  if (!same) {
    const auto before = chosen();
    endpoints_ = std::move(now);
    list_->clear();
    for (const inspect::Endpoint& endpoint : endpoints_) {
      auto* item = new QListWidgetItem(
          tr("process %1:  %2").arg(endpoint.pid).arg(command_text(endpoint.command)), list_);
      item->setToolTip(to_qstring(endpoint.command));
      if (before && before->socket == endpoint.socket) list_->setCurrentItem(item);
    }
    if (list_->currentRow() < 0) list_->setCurrentRow(0);
  }
  attach_->setEnabled(!endpoints_.empty());
  hint_->setText(!found ? to_qstring(found.error().message)
                 : endpoints_.empty()
                     ? tr("No program can be inspected now. Start a flight with <b>psygen fly "
                          "--inspect</b>, or a game with the plugin inspect.")
                     : tr("The attached program gets your changes. Detaching restores its original "
                          "state."));
}

}  // namespace

std::optional<inspect::Endpoint> ask_endpoint(QWidget* parent) {
  AttachDialog dialog(parent);
  return dialog.exec() == QDialog::Accepted ? dialog.chosen() : std::nullopt;
}

}  // namespace psygen::editor
