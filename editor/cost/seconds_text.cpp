#include "editor/cost/seconds_text.hpp"

#include <QLocale>
#include <QObject>

namespace psygen::editor {

QString seconds_text(double seconds) {
  const QLocale english(QLocale::English);
  if (seconds < 0.0995) return QObject::tr("%1 ms").arg(english.toString(seconds * 1e3, 'g', 2));
  if (seconds < 9.5) return QObject::tr("%1 s").arg(english.toString(seconds, 'g', 2));
  return QObject::tr("%1 s").arg(english.toString(seconds, 'f', 0));
}

}  // namespace psygen::editor
