// Takes images of an editor's window for the manual.
#pragma once

#include <QAction>
#include <QDeadlineTimer>
#include <QDockWidget>
#include <QImage>
#include <QPainter>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include "editor/panels/properties_panel.hpp"
#include "editor/shell/main_window.hpp"
#include "tests/editor/own_display.hpp"

namespace psygen::editor {

inline constexpr int kLongestMs = 400'000, kRestMs = 700, kQuality = 78;

// Lets the window draw and answer for a while.
inline void rest(int ms = kRestMs) {
  const QDeadlineTimer end(ms);
  wait_until([&] { return end.hasExpired(); }, 2 * ms);
}

// Uses a window by its commands and saves images of its parts. Sentences of what fails go to
// stderr; ok() is false from then on.
class Photographer {
 public:
  Photographer(MainWindow& window, std::filesystem::path folder, QString theme)
      : window_(window), folder_(std::move(folder)), theme_(std::move(theme)) {
    QObject::connect(&window.view(), &WorldView::settled, &window, [this] { ++settled_; });
  }
  bool ok() const { return ok_; }
  Document& document() { return window_.document(); }
  PropertiesPanel& properties() { return *window_.findChild<PropertiesPanel*>(); }

  void fail(const QString& sentence) {
    std::fprintf(stderr, "psygen-editor: %s\n", qPrintable(sentence));
    ok_ = false;
  }
  void command(const QString& name) {
    for (QAction* action : window_.findChildren<QAction*>()) {
      if (action->text().remove('&') == name) return action->trigger();
    }
    fail("there is no command " + name);
  }
  // Makes a change and waits until the view shows it with all meshes.
  void settle(const std::function<void()>& change) {
    const int before = settled_;
    change();
    if (!wait_until([&] { return settled_ > before; }, kLongestMs))
      fail("the view does not settle");
  }
  void set(const world::TextPath& path, const std::string& toml) {
    if (auto done = document().set_value(path, toml); !done)
      fail(QString::fromStdString(done.error().message));
  }

  void save(const QString& name, const QPixmap& picture) {
    const QString file_name = QString("%1-%2-%3.jpg").arg(name, theme_).arg(window_.width());
    const auto file = folder_ / file_name.toStdString();
    if (!picture.save(QString::fromStdString(file.string()), "JPG", kQuality))
      fail("cannot write " + QString::fromStdString(file.string()));
  }
  void widget(const QString& name, QWidget& widget) {
    rest();
    save(name, widget.grab());
  }
  void panel(const QString& dock_name, const QString& name) {
    auto* dock = window_.findChild<QDockWidget*>(dock_name);
    if (dock == nullptr) return fail("there is no panel " + dock_name);
    dock->show();
    dock->raise();
    rest();
    save(name, dock->widget()->grab());
  }
  // The whole window. Qt cannot grab the Vulkan view, so its image is drawn over.
  void window(const QString& name) {
    rest();
    QPixmap picture = window_.grab();
    const auto seen = window_.view().session()->picture();
    if (!seen) return fail(QString::fromStdString(seen.error().message));
    const QImage view(seen->rgba.data(), static_cast<int>(seen->width),
                      static_cast<int>(seen->height), QImage::Format_RGBA8888);
    QPainter painter(&picture);
    painter.drawImage(window_.centralWidget()->geometry(),
                      view.convertToFormat(QImage::Format_RGB32));
    painter.end();
    save(name, picture);
  }

 private:
  MainWindow& window_;
  std::filesystem::path folder_;
  QString theme_;
  int settled_ = 0;
  bool ok_ = true;
};

}  // namespace psygen::editor
