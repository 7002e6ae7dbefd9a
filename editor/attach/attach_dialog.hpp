// The dialog "Attach": lists the running games and flights that can be inspected, and lets the user
// choose one. Main thread.
#pragma once

#include <optional>

#include "engine/inspect/client.hpp"

class QWidget;

namespace psygen::editor {

// Returns the chosen program; nullopt if the user cancels. Updates the list every second.
std::optional<inspect::Endpoint> ask_endpoint(QWidget* parent);

}  // namespace psygen::editor
