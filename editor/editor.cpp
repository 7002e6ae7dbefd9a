#include "editor/editor.hpp"

#include <QApplication>
#include <QCommandLineParser>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <memory>
#include <string_view>

#include "editor/document/qt_text.hpp"
#include "editor/pictures/picture_server.hpp"
#include "editor/shell/main_window.hpp"
#include "editor/shell/theme.hpp"
#include "editor/view/window_surface.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/log.hpp"
#include "engine/program/program.hpp"
#include "engine/render/preset.hpp"

namespace psygen::editor {
namespace {

struct Arguments {
  QString file;
  bool safe = false;
  app::SessionOptions session;
};

int usage_error(const QString& message) {
  std::fprintf(stderr, "psygen-editor: %s\n", qPrintable(message));
  return 2;
}

// Sets up the parser, and returns false after errors. Prints help or version and exits if asked to.
bool parse(QCommandLineParser& parser, const QStringList& arguments) {
  parser.setApplicationDescription("Edits a world while psygen renders it.");
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument("world", "A world file, or the name of a world of psygen.",
                               "[world]");
  parser.addOptions({{"safe", "Open with synthesis paused, for a world that hangs."},
                     {"preset", "Quality: low, medium, high, ultra.", "preset"},
                     {"device", "Vulkan device: index, UUID or part of its name.", "device"},
                     {"validation", "Enable Vulkan validation."}});
  const bool is_good = parser.parse(arguments);
  if (parser.isSet("help")) parser.showHelp(0);
  if (parser.isSet("version")) parser.showVersion();
  return is_good;
}

// Prints help and version, which need no display. Returns the display that must stay open until
// QApplication has connected, or an exit code.
tl::expected<std::shared_ptr<void>, int> open_display(int argc, char** argv) {
  // Only these words: options of Qt such as -reverse look like short options.
  const auto asks = [](const char* argument) {
    constexpr std::string_view kQuestions[] = {"-h", "--help", "--help-all", "-v", "--version"};
    return std::ranges::find(kQuestions, std::string_view(argument)) != std::end(kQuestions);
  };
  if (std::any_of(argv + 1, argv + argc, asks)) {
    const QCoreApplication app(argc, argv);
    QCommandLineParser parser;
    parse(parser, app.arguments());
  }
  auto display = require_display({argv, static_cast<std::size_t>(argc)});
  if (!display) return tl::unexpected(cli::fail_with(display.error()));
  return *display;
}

// Qt reports by a fatal message that it cannot start, and would then abort.
void end_at_fatal(QtMsgType type, const QMessageLogContext& context, const QString& message) {
  if (type == QtFatalMsg) {
    core::log_error("Qt cannot start: " + message.simplified().toStdString());
    std::_Exit(program::kNoDevice);
  }
  std::fprintf(stderr, "%s\n", qPrintable(qFormatLogMessage(type, context, message)));
}

// Returns the exit code of an error, or nullopt.
std::optional<int> read_arguments(const QApplication& app, Arguments& arguments) {
  QCommandLineParser parser;
  if (!parse(parser, app.arguments())) return usage_error(parser.errorText());
  if (parser.positionalArguments().size() > 1) return usage_error("give at most one world");
  if (parser.isSet("preset")) {
    const auto preset = render::preset_from(parser.value("preset").toStdString());
    if (!preset) return usage_error(to_qstring(preset.error().message));
    arguments.session.preset = *preset;
  }
  arguments.file = parser.positionalArguments().value(0);
  arguments.safe = parser.isSet("safe");
  arguments.session.device_name = parser.value("device").toStdString();
  arguments.session.validation = parser.isSet("validation");
  return std::nullopt;
}

int edit(int argc, char** argv, std::vector<app::Plugin> plugins) {
  // The rendering process of the gallery (pictures/picture_server.hpp).
  if (argc > 1 && std::strcmp(argv[1], kPicturesOption) == 0)
    return render_pictures(std::move(plugins), argc > 2 ? argv[2] : "");
  QApplication::setOrganizationName("psygen");
  QApplication::setApplicationName("psygen-editor");
  QApplication::setApplicationVersion(to_qstring(core::version()));
  const auto display = open_display(argc, argv);
  if (!display) return display.error();
  const QtMessageHandler usual = qInstallMessageHandler(end_at_fatal);
  QApplication app(argc, argv);
  qInstallMessageHandler(usual);
  Arguments arguments;
  if (const auto code = read_arguments(app, arguments)) return *code;
  apply_saved_look();

  MainWindowOptions options;
  options.session = std::move(arguments.session);
  options.safe = arguments.safe;
  options.document.register_models = [plugins](models::Registry& registry) {
    return app::register_models(plugins, registry);
  };
  options.session.plugins = std::move(plugins);
  MainWindow window(std::move(options));
  window.show();
  const auto file = cli::find_file(
      cli::Shipped::kWorld, arguments.file.isEmpty() ? kFirstWorld : arguments.file.toStdString());
  if (arguments.file.isEmpty()) window.use_first_pose();
  if (!file) return usage_error(to_qstring(file.error().message));
  const core::Result<void> opened = window.open_file(*file);
  if (!opened && !arguments.file.isEmpty())
    std::fprintf(stderr, "psygen-editor: %s\n", opened.error().message.c_str());
  const int code = QApplication::exec();
  // A modeler that hangs may still write into memory, so the process ends without destructors.
  if (window.view().has_hung()) std::_Exit(code);
  return code;
}

}  // namespace

int run(int argc, char** argv, std::vector<app::Plugin> plugins) {
  return program::run("psygen-editor", [&] { return edit(argc, argv, std::move(plugins)); });
}

}  // namespace psygen::editor
