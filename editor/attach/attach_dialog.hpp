// Chooses a running game or flight that can be inspected. The list follows what runs. Main thread.
#pragma once

#include <QDialog>
#include <QTimer>
#include <optional>
#include <vector>

#include "engine/inspect/client.hpp"

class QLabel;
class QListWidget;
class QPushButton;

namespace psygen::editor {

class AttachDialog final : public QDialog {
  Q_OBJECT

 public:
  explicit AttachDialog(QWidget* parent);
  // The one that was chosen, once the dialog is accepted.
  std::optional<inspect::Endpoint> chosen() const;

 private:
  void list();

  std::vector<inspect::Endpoint> endpoints_;
  QListWidget* list_;
  QLabel* hint_;
  QPushButton* attach_;
  QTimer timer_;
};

}  // namespace psygen::editor
