#include "engine/program/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "engine/core/log.hpp"
#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"
#include "engine/program/program.hpp"

namespace psygen::program {
namespace {

constexpr std::size_t kMaxShownBytes = 80;      // of an argument
constexpr const char* kRestOfLine = "COMMAND";  // another program and its options, after "--"
constexpr std::size_t kMaxSaidBytes = 400;      // of a message of CLI11 that includes an argument

std::string in_quotes(std::string_view argument) {
  return fmt::format("'{}'", core::shown(argument, kMaxShownBytes));
}

// Options of an app and of its option groups, which are apps without a name.
std::vector<CLI::Option*> options_of(CLI::App& app) {
  std::vector<CLI::Option*> options = app.get_options();
  for (CLI::App* group : app.get_subcommands([](CLI::App* a) { return a->get_name().empty(); })) {
    const auto more = options_of(*group);
    options.insert(options.end(), more.begin(), more.end());
  }
  return options;
}

std::vector<CLI::App*> commands_of(CLI::App& cli) {
  return cli.get_subcommands([](CLI::App* app) { return !app->get_name().empty(); });
}

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return (parent != nullptr ? full_name(*parent) + " " : "") + command.get_name();
}

// The command of a command that was named last.
CLI::App& named_command(CLI::App& cli) {
  const auto chosen = cli.get_subcommands();
  return chosen.empty() ? cli : named_command(*chosen.front());
}

std::string check_value(const std::string& text) {
  if (text.empty()) return "the value is empty";
  if (text.starts_with("--"))
    return fmt::format("a value is missing before {0} (for a file of that name, write ./{0})",
                       core::shown(text, kMaxShownBytes));
  return {};
}

// CLI11 would take the next argument as the value of "--name=" and of "--name --other".
void refuse_missing_values(CLI::App& app) {
  for (CLI::App* command : commands_of(app))
    refuse_missing_values(*command);
  for (CLI::Option* option : options_of(app)) {
    if (option->get_items_expected_max() == 0)
      option->disable_flag_override();
    else if (option->get_name() != kRestOfLine)
      option->transform(CLI::Validator([](std::string& text) { return check_value(text); }, ""));
  }
}

// Accepts "help" and "help fly" for "--help" and "fly --help".
void read_help(CLI::App& cli, std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front() != "help" || commands_of(cli).empty()) return;
  arguments.erase(arguments.begin());
  const auto is_next = [&](const CLI::App* app) { return app->get_name() == arguments.front(); };
  if (arguments.empty())
    arguments = {"--help"};
  else if (std::ranges::any_of(commands_of(cli), is_next))
    arguments = {arguments.front(), "--help"};
}

// In reverse order, as CLI11 expects.
std::vector<std::string> reversed_arguments(CLI::App& cli, int argc, char** argv) {
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    arguments.emplace_back(argv[i]);
    std::string& argument = arguments.back();
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1) {
      argument.pop_back();
      arguments.emplace_back();
    }
  }
  read_help(cli, arguments);
  std::ranges::reverse(arguments);
  return arguments;
}

std::string about_command(CLI::App& cli, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(cli))
    names.push_back(command->get_name());
  return fmt::format("unknown command {}{}", in_quotes(word), core::suggestion(word, names));
}

std::string about_option(CLI::App& command, const std::string& argument) {
  const std::string word = argument.substr(0, argument.find('='));
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command))
    names.push_back(option->get_name());
  return fmt::format("{} has no option {}{}", full_name(command), in_quotes(word),
                     core::suggestion(word, names));
}

// Error message for an unexpected argument of the program.
std::string about_extra(CLI::App& cli) {
  const std::string first = cli.remaining().front();
  if (first.starts_with('-')) {
    const std::string near =
        core::suggestion(first, std::vector<std::string>{"--version", "--help"});
    return near.empty()
               ? in_quotes(first) + " precedes the command; options follow it"
               : fmt::format("{} has no option {}{}", cli.get_name(), in_quotes(first), near);
  }
  if (cli.get_subcommands().empty()) return about_command(cli, first);
  return fmt::format("unexpected argument {}", in_quotes(first));
}

// Error message for an unexpected argument of a command.
std::string about_extra_of(CLI::App& command) {
  const std::vector<std::string> extras = command.remaining();
  // The argument after an unknown option may be its value.
  const auto option =
      std::ranges::find_if(extras, [](const std::string& text) { return text.starts_with('-'); });
  if (option != extras.end()) return about_option(command, *option);
  return fmt::format("unexpected argument {}: only options may follow {}",
                     in_quotes(extras.front()),
                     command.get_parent() != nullptr ? "the command" : command.get_name());
}

// Error message for a repeated option, an option without a value, or a flag with one.
std::string about_count(CLI::App& command, const CLI::ParseError& error) {
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_items_expected_max() == 1 && option->count() > 1)
      return fmt::format("{} is given {} times; once is allowed", option->get_name(),
                         option->count());
  }
  const std::string said = error.what();  // begins with the option
  const std::string name = said.substr(0, said.find_first_of(": "));
  return name.starts_with('-') ? fmt::format("{} needs a value", name)
                               : fmt::format("--{} takes no value", name);
}

std::string sentence_of(CLI::App& cli, CLI::App& command, const CLI::ParseError& error) {
  const auto kind = static_cast<CLI::ExitCodes>(error.get_exit_code());
  const bool has_commands = !commands_of(cli).empty();
  if (has_commands && !cli.remaining().empty()) return about_extra(cli);
  if (!commands_of(command).empty()) {
    const auto rest = command.remaining();
    if (rest.empty()) return "a command is missing";
    if (!rest.front().starts_with('-')) return about_command(command, rest.front());
  }
  if (kind == CLI::ExitCodes::ArgumentMismatch) return about_count(command, error);
  // A missing option may be present under a misspelt name.
  const bool wrong_value = kind == CLI::ExitCodes::ValidationError;
  if (!wrong_value && !command.remaining().empty()) return about_extra_of(command);
  return core::shown(error.what(), kMaxSaidBytes);
}

int refuse(CLI::App& cli, const CLI::ParseError& error) {
  CLI::App& command = named_command(cli);
  core::log_error(sentence_of(cli, command, error));
  const std::string more = commands_of(cli).empty() || &command != &cli
                               ? fmt::format("{} --help lists its options\n", full_name(command))
                               : "\n" + cli.help();
  std::fputs(more.c_str(), stderr);
  return kUsage;
}

}  // namespace

std::optional<int> read_command_line(CLI::App& cli, int argc, char** argv) {
  refuse_missing_values(cli);
  std::vector<std::string> arguments = reversed_arguments(cli, argc, argv);
  try {
    cli.parse(arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refuse(cli, error);
    std::ostringstream text;  // --help, --version
    cli.exit(error, text, text);
    return print(text.str());
  }
  return std::nullopt;
}

}  // namespace psygen::program
