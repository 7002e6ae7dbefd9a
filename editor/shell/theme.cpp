#include "editor/shell/theme.hpp"

#include <QApplication>
#include <QFont>
#include <QPalette>
#include <QStyleFactory>
#include <algorithm>

namespace psygen::editor {
namespace {

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
  static const QFont usual = QApplication::font();
  QFont font = usual;
  font.setPointSizeF(usual.pointSizeF() * std::clamp(percent, 50, 300) / 100);
  QApplication::setFont(font);
}

}  // namespace psygen::editor
