#include "editor/shell/theme.hpp"

#include <QApplication>
#include <QFont>
#include <QMenu>
#include <QPalette>
#include <QSettings>
#include <QStyleFactory>
#include <algorithm>

namespace psygen::editor {
namespace {

constexpr int kScales[] = {80, 100, 125, 150, 200};  // percent

QPalette dark() {
  const QColor window(43, 45, 49), base(30, 31, 34), text(220, 221, 224), dim(126, 128, 134);
  const QColor accent(76, 134, 198);
  QPalette p(window);
  p.setColor(QPalette::WindowText, text);
  p.setColor(QPalette::Base, base);
  p.setColor(QPalette::AlternateBase, QColor(37, 39, 43));
  p.setColor(QPalette::Text, text);
  p.setColor(QPalette::Button, QColor(56, 58, 64));
  p.setColor(QPalette::ButtonText, text);
  p.setColor(QPalette::ToolTipBase, base);
  p.setColor(QPalette::ToolTipText, text);
  p.setColor(QPalette::PlaceholderText, dim);
  p.setColor(QPalette::Highlight, accent);
  p.setColor(QPalette::HighlightedText, Qt::white);
  p.setColor(QPalette::Link, accent.lighter(130));
  for (const QPalette::ColorRole role :
       {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    p.setColor(QPalette::Disabled, role, dim);
  return p;
}

QPalette light() {
  QPalette p(QColor(240, 240, 241));
  p.setColor(QPalette::Highlight, QColor(38, 104, 178));
  p.setColor(QPalette::HighlightedText, Qt::white);
  return p;
}

}  // namespace

void apply_theme(const QString& name) {
  QApplication::setStyle(QStyleFactory::create("Fusion"));
  QApplication::setPalette(name == "light" ? light() : dark());
}

void apply_scale(int percent) {
  static const QFont system_font = QApplication::font();
  QFont font = system_font;
  font.setPointSizeF(system_font.pointSizeF() * std::clamp(percent, 50, 300) / 100);
  QApplication::setFont(font);
}

void apply_saved_look() {
  const QSettings settings;
  apply_theme(settings.value("theme", "dark").toString());
  apply_scale(settings.value("scale", 100).toInt());
}

void add_theme_menus(QMenu& menu) {
  const auto set_theme = [](const QString& name) {
    return [name] {
      apply_theme(name);
      QSettings().setValue("theme", name);
    };
  };
  QMenu* themes = menu.addMenu(QMenu::tr("&Theme"));
  themes->addAction(QMenu::tr("&Dark"), set_theme("dark"));
  themes->addAction(QMenu::tr("&Light"), set_theme("light"));
  QMenu* scales = menu.addMenu(QMenu::tr("Text si&ze"));
  for (const int percent : kScales)
    scales->addAction(QString("%1 %").arg(percent), [percent] {
      apply_scale(percent);
      QSettings().setValue("scale", percent);
    });
}

}  // namespace psygen::editor
