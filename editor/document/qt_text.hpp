// Texts and numbers of the engine as texts of Qt. Numbers are in English, whatever the locale of
// the system. Pure; any thread.
#pragma once

#include <QLocale>
#include <QObject>
#include <QString>
#include <cmath>
#include <string_view>

namespace psygen::editor {

inline const QLocale kEnglish(QLocale::English);

// Converts UTF-8; invalid bytes become replacement characters.
inline QString to_qstring(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size()));
}

// Rounds to a whole number: "118,000".
template <class Number>
QString count_text(Number count) {
  return kEnglish.toString(std::llround(static_cast<double>(count)));
}

// Translates a text of functions and of classes that are no QObject.
inline QString tr(const char* text) {
  return QObject::tr(text);
}

// A number of bytes with this number of decimals: "1.9 MB".
template <class Number>
QString bytes_text(Number bytes, int decimals = 2) {
  return kEnglish.formattedDataSize(std::llround(static_cast<double>(bytes)), decimals);
}

// A duration for people: "31 ms", "0.3 s", "12 s".
inline QString seconds_text(double seconds) {
  if (seconds < 0.0995) return tr("%1 ms").arg(kEnglish.toString(seconds * 1e3, 'g', 2));
  const bool is_short = seconds < 9.5;
  return tr("%1 s").arg(kEnglish.toString(seconds, is_short ? 'g' : 'f', is_short ? 2 : 0));
}

}  // namespace psygen::editor
