// Tests the messages for wrong command lines, with the real commands of psygen.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/core/utf8.hpp"
#include "engine/program/command_line.hpp"

namespace psygen::cli {
namespace {

struct Program {
  CLI::App cli{"psygen", "psygen"};
  std::vector<std::unique_ptr<Command>> commands = make_commands(cli);
  Program() {
    cli.require_subcommand(1);
    cli.footer("For example");
  }
};

using Arguments = std::vector<std::string>;

struct Told {
  std::optional<int> code;
  std::string out, err;
};

Told told(Arguments arguments) {
  Program program;
  arguments.insert(arguments.begin(), "psygen");
  std::vector<char*> argv;
  for (std::string& argument : arguments)
    argv.push_back(argument.data());
  argv.push_back(nullptr);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Told result;
  result.code =
      program::read_command_line(program.cli, static_cast<int>(arguments.size()), argv.data());
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

std::string text_of(const Arguments& arguments) {
  std::string text;
  for (const std::string& argument : arguments)
    text += " '" + core::shown(argument) + "'";
  return text;
}

// Expects a usage error that contains `words`, in printable lines.
void expect_refused(const Arguments& arguments, const std::string& words) {
  const Told result = told(arguments);
  EXPECT_EQ(result.code, kUsage) << text_of(arguments) << "\n" << result.err;
  EXPECT_TRUE(result.out.empty()) << text_of(arguments);
  EXPECT_TRUE(result.err.starts_with("psygen: error: ")) << result.err;
  EXPECT_NE(result.err.find(words), std::string::npos) << text_of(arguments) << "\n" << result.err;
  std::istringstream lines(result.err);
  for (std::string line; std::getline(lines, line);)
    EXPECT_EQ(core::shown(line), line) << text_of(arguments);
}

std::vector<CLI::App*> commands_of(Program& program) {
  return program.cli.get_subcommands([](CLI::App* app) { return !app->get_name().empty(); });
}

TEST(Usage, AMissingOrMisspeltCommandListsTheCommands) {
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{}, "error: a command is missing\n"},
      {{"fyl"}, "unknown command 'fyl'; did you mean fly?\n"},
      {{"calibarte", "--samples", "4"}, "did you mean calibrate?\n"},
      {{"walk", "there"}, "unknown command 'walk'\n"},
      {{"--frobnicate"}, "'--frobnicate' precedes the command"},
      {{""}, "unknown command ''\n"}};
  Program program;
  for (const auto& [arguments, words] : cases) {
    expect_refused(arguments, words);
    const std::string err = told(arguments).err;
    for (const CLI::App* command : commands_of(program))
      EXPECT_NE(err.find("\n  " + command->get_name() + "  "), std::string::npos) << err;
    EXPECT_NE(err.find("For example"), std::string::npos) << err;
  }
}

TEST(Usage, AMisspeltOptionSuggestsTheNearestOfItsCommand) {
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"fly", "--wrold", "paper"}, "psygen fly has no option '--wrold'; did you mean --world?\n"},
      {{"fly", "--seconds", "3", "--heedless"}, "did you mean --headless?"},
      {{"fly", "-world", "paper"}, "did you mean --world?"},
      {{"models", "--jsn"}, "did you mean --json?"},
      {{"amplify", "--regoin=0,0,1,1"}, "no option '--regoin'; did you mean --region?"},
      {{"export", "--modle", "rock"}, "did you mean --model?"},
      {{"calibrate", "--sample", "4"}, "did you mean --samples?"},
      {{"schedule", "--modeler", "3"}, "did you mean --modelers?"},
      {{"fly", "--set", "seed=3"}, "psygen fly has no option '--set'\n"},
      {{"fly", "--preset", "hihg"}, "allowed are low, medium, high, ultra; did you mean high?\n"},
      {{"fly", "--view", "levls"}, "did you mean levels?\n"},
      {{"fly", "--policy", "deadlien"}, "did you mean deadline?\n"},
      {{"--versoin"}, "psygen has no option '--versoin'; did you mean --version?\n"},
      {{"fly", "--frobnicate"}, "psygen fly has no option '--frobnicate'\n"}};
  for (const auto& [arguments, words] : cases)
    expect_refused(arguments, words);
}

TEST(Usage, EveryOptionOfEveryCommandRejectsAnEmptyOrMissingValue) {
  Program program;
  std::size_t values = 0, flags = 0;
  for (CLI::App* command : commands_of(program)) {
    for (const CLI::Option* option : command->get_options()) {
      const std::string name = option->get_name(), in = command->get_name();
      if (name == "--help" || !name.starts_with("--")) continue;
      if (option->get_items_expected_max() == 0) {
        ++flags;
        expect_refused({in, name + "=1"}, name + " takes no value");
        continue;
      }
      ++values;
      for (const Arguments& empty :
           {Arguments{in, name, ""}, {in, name + "="}, {in, name + "=", "a"}})
        expect_refused(empty, name + ": the value is empty");
      expect_refused({in, name, "--world"}, name + ": a value is missing before --world");
      expect_refused({in, name}, name + " needs a value");
    }
  }
  EXPECT_GT(values, 40u);
  EXPECT_GT(flags, 8u);
}

TEST(Usage, OptionsOfAGroupBehaveLikeOthers) {
  const auto told_of = [](Arguments arguments) {
    CLI::App cli("psygen", "psygen");
    cli.require_subcommand(1);
    std::string where;
    CLI::App* picture = cli.add_subcommand("picture");
    picture->add_option_group("shared")->add_option("--where", where);
    arguments.insert(arguments.begin(), {"psygen", "picture"});
    std::vector<char*> argv;
    for (std::string& argument : arguments)
      argv.push_back(argument.data());
    testing::internal::CaptureStderr();
    EXPECT_EQ(program::read_command_line(cli, static_cast<int>(argv.size()), argv.data()), kUsage);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(told_of({"--where", ""}).find("--where: the value is empty"), std::string::npos);
  EXPECT_NE(told_of({"--hwere", "a"}).find("did you mean --where?"), std::string::npos);
  EXPECT_NE(told_of({"--where", "a", "--where", "b"}).find("--where is given 2 times"),
            std::string::npos);
}

TEST(Usage, MisplacedArgumentsAreNamed) {
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"--headless", "fly"}, "'--headless' precedes the command; options follow it"},
      {{"fly", "models"}, "unexpected argument 'models': only options may follow the command"},
      {{"fly", ""}, "unexpected argument ''"},
      {{"fly", "-"}, "psygen fly has no option '-'"},
      {{"models", "--", "x"}, "unexpected argument 'x'"},
      {{"fly", "--seconds", "3", "--size", "64x36", "--seconds", "4"},
       "--seconds is given 2 times"},
      {{"schedule"}, "one of --requests and --ranks is required"},
      {{"amplify", "--format", "obj"}, "--format requires --out"},
      {{"fly", "--seconds", "-3"}, "\npsygen fly --help lists its options\n"}};
  for (const auto& [arguments, words] : cases)
    expect_refused(arguments, words);
}

TEST(Usage, NumbersAreDecimalAndErrorsListTheAllowedValues) {
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"fly", "--frames", "1.5"}, "'1.5' is not a whole number from 0 to 1000000000"},
      {{"fly", "--frames", "0x10"}, "'0x10' is not a whole number"},
      {{"fly", "--frames", " 5"}, "' 5' is not a whole number"},
      {{"fly", "--frames", "5 "}, "'5 ' is not a whole number"},
      {{"fly", "--frames", "1e3"}, "'1e3' is not a whole number"},
      {{"fly", "--frames", "99999999999999999999"}, "from 0 to 1000000000"},
      {{"fly", "--modelers", "-1"}, "'-1' is not a whole number from 0 to 256"},
      {{"fly", "--seconds", "nan"}, "'nan' is not a number from 0 to 86400"},
      {{"fly", "--seconds", "inf"}, "'inf' is not a number"},
      {{"fly", "--seconds", "1e400"}, "'1e400' is not a number"},
      {{"fly", "--seconds", "0x1p3"}, "'0x1p3' is not a number"},
      {{"fly", "--target-fps", "0.05"}, "'0.05' is not a number from 0.1 to 1000"},
      {{"fly", "--min-resolution", "0.1"}, "'0.1' is not a number from 0.25 to 1"},
      {{"fly", "--budget", "0"}, "'0' is not allowed: it must be between 4M and 1T"},
      {{"fly", "--budget", "1K"}, "it must be between 4M and 1T"},
      {{"fly", "--budget", "4194303"}, "it must be between 4M and 1T"},
      {{"fly", "--budget", "2T"}, "it must be between 4M and 1T"},
      {{"fly", "--lod", "of"}, "'of' is unknown; allowed are on, off"},
      {{"fly", "--occlusion", "ON"}, "'ON' is unknown; allowed are on, off"},
      {{"fly", "--policy", "fast"}, "allowed are fifo, plp, shortest, longest, deadline"},
      {{"amplify", "--out", "a", "--format", "stl"},
       "'stl' is unknown; allowed are glb, obj, none"},
      {{"amplify", "--out", "a", "--format", "none"}, "--format none needs --shard"},
      {{"export", "--region", "0,0,2,2", "--out", "a", "--levels", "5-1"},
       "is not FINEST-COARSEST"},
      {{"export", "--out", "a.glb", "--levels", "1-2", "--model", "tree"},
       "--levels requires --region"},
      {{"schedule", "--ranks", "4", "--cores", "0"}, "from 1 to 1024"},
      {{"schedule", "--cores", "4", "--requests", "a"}, "--cores requires --ranks"},
      {{"amplify", "--out", "a", "--shard", "9/8"}, "'9/8' is not a shard I/N"},
      {{"amplify", "--shard", "1/8"}, "--shard requires --out"},
      {{"amplify", "--simd", "mmx"}, "'mmx' is unknown; allowed are "},
      {{"amplify", "--threads", "0"}, "from 1 to 256"},
      {{"export", "--model", "rock", "--level", "1.0"}, "from 0 to 31"},
      {{"calibrate", "--samples", "4.5"}, "from 4 to 10000"},
      {{"schedule", "--requests", "a", "--slower", "-0"}, "from 0.001 to 1000000"}};
  for (const auto& [arguments, words] : cases)
    expect_refused(arguments, words);
  const Told sound = told({"fly", "--warmup", "-0", "--frames", "010", "--seconds", "+1.5",
                           "--budget", "4M", "--target-fps", "0.0"});
  EXPECT_FALSE(sound.code.has_value()) << sound.err;
}

TEST(Usage, ALeadingZeroIsNotOctal) {
  CLI::App cli("psygen", "psygen");
  int number = 0;
  cli.add_subcommand("a")->add_option("--number", number)->transform(integer_between(-20, 20));
  std::string arguments[] = {"psygen", "a", "--number", "010"};
  char* argv[] = {arguments[0].data(), arguments[1].data(), arguments[2].data(),
                  arguments[3].data()};
  EXPECT_FALSE(program::read_command_line(cli, 4, argv).has_value());
  EXPECT_EQ(number, 10);
}

TEST(Usage, MessagesForHostileArgumentsArePrintableAndShort) {
  for (const char* text : {"\x1B[31m", "a\nb", "\xFF\xFE", "\xC3", "\xE2\x80\xAE", "\x7F"}) {
    const std::string hostile = text;
    expect_refused({hostile}, core::shown(hostile));
    expect_refused({"fly", "--" + hostile}, core::shown(hostile));
    expect_refused({"fly", "--" + hostile + "=1"}, core::shown(hostile));
    expect_refused({"fly", hostile}, core::shown(hostile));
    expect_refused({"fly", "--size", hostile}, core::shown(hostile));
    expect_refused({"fly", "--seconds", hostile}, core::shown(hostile));
    expect_refused({"fly", "--lod", hostile}, core::shown(hostile));
    expect_refused({"amplify", "--region", hostile}, core::shown(hostile));
    expect_refused({"export", "--model", "rock", "--out", hostile}, core::shown(hostile));
  }
  const std::string longest(100'000, 'a');
  for (const Arguments& arguments : {Arguments{longest},
                                     {"fly", longest},
                                     {"fly", "--" + longest},
                                     {"fly", "--size", longest},
                                     {"fly", "--seconds", longest},
                                     {"fly", "--view", longest}})
    EXPECT_LT(told(arguments).err.size(), 2000u) << arguments.size();
}

TEST(Usage, HelpGoesToStdoutAndSucceeds) {
  Program program;
  for (const CLI::App* command : commands_of(program)) {
    const Told help = told({command->get_name(), "--help"});
    EXPECT_EQ(help.code, kOk);
    EXPECT_TRUE(help.err.empty()) << help.err;
    EXPECT_NE(help.out.find("--help"), std::string::npos) << help.out;
  }
  EXPECT_EQ(told({"-h"}).code, kOk);
}

}  // namespace
}  // namespace psygen::cli
