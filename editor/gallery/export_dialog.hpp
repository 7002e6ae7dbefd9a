// Asks what of the world is to be exported: the selected model or a block, at which level of
// detail, into which file; and shows the command that does the same. Main thread.
#pragma once

#include <QString>
#include <optional>

#include "editor/document/document.hpp"
#include "editor/pictures/picture_request.hpp"
#include "editor/view/picking.hpp"

class QWidget;

namespace psygen::editor {

// A request of kind kExportModel or kExportBlock; nothing if the person does not want it after all.
// `selection` may be empty; `block` is offered then.
std::optional<PictureRequest> ask_export(QWidget* parent, const Document& document,
                                         const std::optional<Selection>& selection,
                                         core::BlockCoord block);

// The command for a block or a model, as a person types it. Unsaved changes are not in it.
QString export_command(const std::filesystem::path& world_file, const PictureRequest& request,
                       const models::Registry& registry, const std::optional<Selection>& selection);

}  // namespace psygen::editor
