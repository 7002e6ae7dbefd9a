// A time as people read it: "31 ms", "0.3 s", "12 s". Pure.
#pragma once

#include <QString>

namespace psygen::editor {

QString seconds_text(double seconds);

}  // namespace psygen::editor
