// The dialog "Export": exports the selected model or a block, at a level of detail, to a file.
// Shows the equivalent command. Main thread.
#pragma once

#include <optional>

#include "editor/document/document.hpp"
#include "editor/pictures/picture_request.hpp"
#include "editor/view/picking.hpp"

class QWidget;

namespace psygen::editor {

// Returns a request of kind kExportModel or kExportBlock; nullopt if the user cancels. `selection`
// may be empty; the dialog then offers `block`.
std::optional<PictureRequest> ask_export(QWidget* parent, const Document& document,
                                         const std::optional<Selection>& selection,
                                         core::BlockCoord block);

}  // namespace psygen::editor
