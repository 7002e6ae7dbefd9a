// The command that makes again what is on the screen. Pure.
#pragma once

#include <QString>
#include <filesystem>

#include "engine/core/camera.hpp"

namespace psygen::app {
class Session;
}

namespace psygen::editor {

// `psygen picture` with the view's place, preset and error. Unsaved changes are not in it.
QString picture_command(app::Session& session, const std::filesystem::path& world_file,
                        const core::CameraPose& pose);

}  // namespace psygen::editor
