// Lists the running games and flights that can be inspected, and lets the user choose one. Updates
// the list every second. Main thread.
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

// The dialog "Attach". Modal.
class AttachDialog final : public QDialog {
  Q_OBJECT

 public:
  explicit AttachDialog(QWidget* parent);
  // The chosen program, after the dialog was accepted.
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
