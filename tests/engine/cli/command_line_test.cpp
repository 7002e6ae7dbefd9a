// Tests the commands as processes: exit codes and the contents of both streams. usage_test.cpp
// tests the messages for wrong command lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

TEST(CommandLine, HelpAndVersionGoToStdoutAndAreNoFailure) {
  const Outcome help = run_psygen("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_TRUE(mentions(help.out, "fly"));
  EXPECT_TRUE(mentions(help.out, "models"));
  EXPECT_TRUE(mentions(help.out, "picture"));
  const Outcome version = run_psygen("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_TRUE(mentions(version.out, "psygen "));
  const Outcome fly = run_psygen("fly --help");
  EXPECT_EQ(fly.code, 0);
  EXPECT_EQ(run_psygen("help").out, help.out);
  EXPECT_EQ(run_psygen("help fly").out, fly.out);
  EXPECT_EQ(run_psygen("help flie").code, 2);
  const Outcome picture = run_psygen("picture --help");
  EXPECT_EQ(picture.code, 0);
  // As CLI11 2.3 and 2.4 write it.
  EXPECT_TRUE(mentions(picture.out, "=1.7") || mentions(picture.out, "[1.7]"))
      << "help shows defaults";
}

TEST(CommandLine, AUsageErrorReturnsTwoWithAMessageOnStderrOnly) {
  for (const char* arguments : {"",
                                "walk",
                                "fly --no-such-option",
                                "fly --world",
                                "fly --world ''",
                                "fly --size 0x0",
                                "fly --budget 1K",
                                "fly --paradigm eager",
                                "fly --policy random",
                                "fly --hour 25",
                                "fly --cluster",
                                "fly --send-above 5",
                                "picture",
                                "picture --out a.jpg",
                                "picture --out a.png --at 1",
                                "picture --out a.png --at nan,0",
                                "picture --out a.png --height 0.4",
                                "picture --out a.png --height inf",
                                "picture --out a.png --yaw north",
                                "picture --out a.png --pitch -91",
                                "picture --out a.png --hour -1",
                                "picture --out a.png --size 0x1",
                                "picture --out a.png --preset best",
                                "picture --out a.png --view depth",
                                "picture --out a.png --error 0",
                                "picture --out a.png --budget 1K",
                                "picture --out a.png --seconds 3",
                                "amplify --region 0,0,0,1",
                                "amplify --simd mmx",
                                "amplify --sample 1,1 --region 0,0,1,1",
                                "amplify --format stl --out /tmp",
                                "export",
                                "export --out a.glb",
                                "export --model rock --out noend",
                                "export --model pyramid --out a.glb",
                                "export --model rock --set size=3 --out a.glb",
                                "export --model rock --set subdivisions=x --out a.glb",
                                "export --model rock --set subdivisions=40 --out a.glb",
                                "export --model rock --set subdivisions --out a.glb",
                                "export --model rock --set '' --out a.glb",
                                "export --model rock --set seed=1 --set seed=1 --out a.glb",
                                "export --model rock --level 9 --out a.glb",
                                "export --model rock --block 1,1 --out a.glb",
                                "export --model oak --out a.glb",
                                "calibrate --ranges --world game/worlds/paper.toml"}) {
    const Outcome outcome = run_psygen(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << arguments;
    EXPECT_TRUE(outcome.out.empty()) << arguments;
  }
}

TEST(CommandLine, ModelsListsEveryModelWithUnitsAndRanges) {
  const Outcome outcome = run_psygen("models");
  EXPECT_EQ(outcome.code, 0);
  for (const char* words :
       {"terrain", "rock", "tree", "grass", "octaves", "subdivisions", "iterations", "radius_m"}) {
    EXPECT_TRUE(mentions(outcome.out, words)) << words;
  }
  EXPECT_TRUE(mentions(run_psygen("models --json").out, "\"unit\""));
}

TEST(CommandLine, DevicesListsEveryDeviceAndTheOneThatIsChosen) {
  const Outcome table = run_psygen("devices");
  EXPECT_EQ(table.code, 0) << table.err;
  for (const char* words : {"0  ", "(chosen by default)", "UUID", "MiB", "render path", "preset"})
    EXPECT_TRUE(mentions(table.out, words)) << words;
  const auto list = nlohmann::json::parse(run_psygen("devices --json").out);
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(list[0]["index"], 0);
  EXPECT_TRUE(mentions(table.out, list[0]["uuid"]));
  const std::string none = "VK_ICD_FILENAMES=/nonexistent.json";
  EXPECT_EQ(run_psygen("devices", none).code, 4);
  const Outcome index = run_psygen("fly --headless --frames 1 --device 77");
  EXPECT_EQ(index.code, 4) << index.err;
  EXPECT_TRUE(mentions(index.err, "index, UUID or name '77'; there is 0 '")) << index.err;
}

TEST(CommandLine, AFileErrorReturnsOneAndNamesTheFile) {
  const Outcome world = run_psygen("fly --headless --frames 1 --world missing.toml");
  EXPECT_EQ(world.code, 1) << world.err;
  EXPECT_TRUE(mentions(world.err, "missing.toml")) << world.err;
  const Outcome folder = run_psygen("fly --headless --frames 1 --out /proc/nowhere");
  EXPECT_EQ(folder.code, 1) << folder.err;
  EXPECT_TRUE(mentions(folder.err, "/proc/nowhere")) << folder.err;
}

TEST(CommandLine, WithoutAGpuOrADisplayTheExitCodeIsFour) {
  const Outcome device =
      run_psygen("fly --headless --frames 1", "VK_ICD_FILENAMES=/nonexistent.json");
  EXPECT_EQ(device.code, 4) << device.err;
  const Outcome name = run_psygen("fly --headless --frames 1 --device 'Voodoo 2'");
  EXPECT_EQ(name.code, 4) << name.err;
  EXPECT_TRUE(mentions(name.err, "Voodoo 2")) << name.err;
  const Outcome display = run_psygen("fly --frames 1", "env -u DISPLAY -u WAYLAND_DISPLAY");
  EXPECT_EQ(display.code, 4) << display.err;
  EXPECT_TRUE(mentions(display.err, "headless")) << display.err;
}

TEST(CommandLine, AFlightPrintsItsSummaryAndNoProgressBarIntoAPipe) {
  const Outcome outcome =
      run_psygen("fly --headless --frames 3 --size 64x36 --view-distance 64 --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.front(), '{');
  EXPECT_TRUE(mentions(outcome.out, "\"frame_ms\""));
  EXPECT_FALSE(mentions(outcome.err, "\r"));
}

const std::string kSmallPicture = "picture --size 96x54 ";

// Returns the bytes of the image for these options; on failure, reports it and returns an empty
// string.
std::string picture(const TemporaryFolder& folder, const std::string& options,
                    const std::string& quick = " --view-distance 200 --preset low") {
  const auto file = folder / "picture.png";
  std::filesystem::remove(file);
  const Outcome outcome = run_psygen(kSmallPicture + options + quick + " --out " + file.string());
  EXPECT_EQ(outcome.code, 0) << options << "\n" << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  EXPECT_TRUE(mentions(outcome.err, file.string())) << outcome.err;
  return read(file);
}

TEST(CommandLine, APictureIsReproducible) {
  const TemporaryFolder folder;
  const std::string others =
      " --world game/worlds/five_species.toml --view-distance 200 --validation";
  const std::string first = picture(folder, "--modelers 1", others);
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(picture(folder, "--modelers 3", others), first);
  EXPECT_EQ(picture(folder, "--modelers 2 --render-path gpu", others), first);
  EXPECT_EQ(picture(folder, "--preset high", others), first) << "still images use it by default";
  EXPECT_NE(picture(folder, "--yaw 40", others), first);
}

TEST(CommandLine, APictureIsTakenAtEyeHeightInTheCentreOfTheWorldByDefault) {
  const TemporaryFolder folder;
  const std::string usual = picture(folder, "");
  // The centre of block 256, 256.
  EXPECT_EQ(picture(folder, "--at 16159.5,16159.5 --height 1.7 --yaw 0 --pitch 0"), usual);
  for (const char* other : {"--at 16160.5,16159.5", "--height 2", "--yaw 1", "--pitch 1",
                            "--error 20", "--view levels"}) {
    EXPECT_NE(picture(folder, other), usual) << other;
  }
  EXPECT_NE(picture(folder, "", " --view-distance 90 --preset low"), usual);
  EXPECT_NE(picture(folder, "", " --view-distance 200 --preset medium"), usual);
}

TEST(CommandLine, APictureAtALakeIsTakenAboveTheWater) {
  const TemporaryFolder folder;
  const std::string flooded = (folder / "flooded.toml").string();
  std::ofstream(flooded) << read(source_file("game/worlds/paper.toml"))
                         << "\n[water]\nlevel_m = 5000\n[sky]\ncloud_cover = 0\n";
  const std::string sky = " --pitch 60 --world " + flooded;
  // The same sky is above any ground.
  EXPECT_EQ(picture(folder, "--at 16159.5,16159.5" + sky),
            picture(folder, "--at 16222.5,16159.5" + sky));
}

TEST(CommandLine, TheHourOfAPictureNeedsAWorldWithADay) {
  const TemporaryFolder folder;
  const std::string day = " --world " + (folder / "day.toml").string();
  std::ofstream(folder / "day.toml") << read(source_file("game/worlds/paper.toml"))
                                     << "\n[sky]\nday_length_s = 3600\nstart_hour = 12\n";
  const std::string noon = picture(folder, "--hour 12" + day);
  EXPECT_EQ(picture(folder, day), noon);
  EXPECT_NE(picture(folder, "--hour 18" + day), noon);
  for (const std::string& command : {kSmallPicture + "--hour 12 --out a.png",
                                     std::string("fly --headless --frames 1 --hour 12")}) {
    const Outcome outcome = run_psygen(command);
    EXPECT_EQ(outcome.code, 1) << command;
    EXPECT_TRUE(mentions(outcome.err, "/worlds/paper.toml: this world has no day")) << outcome.err;
  }
}

TEST(CommandLine, AFailedPictureReportsTheReason) {
  const TemporaryFolder folder;
  const auto failure = [&](const std::string& options, const std::string& environment = "") {
    return run_psygen(kSmallPicture + options, environment);
  };
  const std::string out = " --out " + (folder / "a.png").string();
  for (const auto& [options, words] :
       {std::pair<std::string, std::string>{"--at 5,32256" + out, "Z is 0 to 32256 m"},
        {"--at=-1,5" + out, "outside the world paper"},
        {"--at 1e300,0" + out, "outside the world paper"},
        {"--world missing.toml" + out, "missing.toml"},
        {"--out /proc/nowhere/a.png", "/proc/nowhere"},
        {"--budget 4M --view-distance 1000 --error 0.3" + out, "raise --budget or --error"}}) {
    const Outcome outcome = failure(options);
    EXPECT_EQ(outcome.code, 1) << options << "\n" << outcome.err;
    EXPECT_TRUE(mentions(outcome.err, words)) << outcome.err;
  }
  EXPECT_EQ(failure("--device 'Voodoo 2'" + out).code, 4);
  EXPECT_EQ(failure(out, "VK_ICD_FILENAMES=/nonexistent.json").code, 4);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST(CommandLine, AnInterruptedPictureIsNotWritten) {
  const TemporaryFolder folder;
  // Interrupts the command as soon as one of its modelers works.
  const std::string interrupted =
      "run() { \"$@\" & p=$!; until grep -qs ^modeler /proc/$p/task/*/comm; do kill -0 $p || "
      "break; done; kill -INT $p; wait $p; }; run";
  const auto file = folder / "a.png";
  const Outcome outcome = run_psygen(
      "picture --error 0.1 --budget 4G --preset low --out " + file.string(), interrupted);
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_TRUE(mentions(outcome.err, "interrupted")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(CommandLine, AmplifyingMoreThanTheBudgetFails) {
  const Outcome outcome =
      run_psygen("fly --headless --frames 3 --size 64x36 --paradigm amplify --budget 16M");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_TRUE(mentions(outcome.err, "more than the budget")) << outcome.err;
}

TEST(CommandLine, EachCommandThatReadsAWorldPrintsItsWarningsOnce) {
  const TemporaryFolder folder;
  const std::string world = (folder / "flooded.toml").string(), file = (folder / "b.glb").string();
  std::ofstream(world) << read(source_file("game/worlds/paper.toml"))
                       << "\n[water]\nlevel_m = 5000\n"
                          "[[road]]\npoints_m = [[100, 100], [300, 120]]\n";
  for (const std::string& command : std::vector<std::string>{
           "amplify --region 0,0,1,1", "amplify --sample 1,1", "models",
           "export --block 0,0 --out " + file, "fly --headless --frames 2 --size 64x36"}) {
    const Outcome outcome = run_psygen(command + " --world " + world);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string warning = "road 1: it leads into the sea";
    const auto at = outcome.err.find(warning);
    ASSERT_NE(at, std::string::npos) << command << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.find(warning, at + 1), std::string::npos) << command;
  }
}

TEST(CommandLine, ExportWritesModelsAndBlocks) {
  const TemporaryFolder folder;
  for (const std::string arguments : {"--model tree --set seed=7 --set iterations=4 --level 1",
                                      "--model terrain", "--block 5,6 --level 2"}) {
    for (const char* ending : {"glb", "obj"}) {
      const auto file = folder / (std::string("a.") + ending);
      std::filesystem::remove(file);
      const Outcome outcome = run_psygen("export " + arguments + " --out " + file.string());
      EXPECT_EQ(outcome.code, 0) << arguments << "\n" << outcome.err;
      EXPECT_TRUE(std::filesystem::exists(file)) << arguments;
      EXPECT_TRUE(mentions(outcome.err, "triangles")) << outcome.err;
    }
  }
}

TEST(CommandLine, ExportListsTheValidNamesForAnUnknownName) {
  const Outcome model = run_psygen("export --model pyramid --out a.glb");
  EXPECT_TRUE(mentions(model.err, "terrain, rock, tree")) << model.err;
  const Outcome parameter = run_psygen("export --model rock --set size=3 --out a.glb");
  EXPECT_TRUE(mentions(parameter.err, "subdivisions, radius_m")) << parameter.err;
  const Outcome value = run_psygen("export --model terrain --set size=99999999999 --out a.glb");
  EXPECT_TRUE(mentions(value.err, "size = 99999999999 is not allowed")) << value.err;
  const Outcome large = run_psygen("export --model terrain --set size=1e3 --out a.glb");
  EXPECT_TRUE(mentions(large.err, "an integer from 4 to 128, not '1e3'")) << large.err;
  const Outcome block = run_psygen("export --block 600,1 --out a.glb");
  EXPECT_EQ(block.code, 1);
  EXPECT_TRUE(mentions(block.err, "the world has no block 600,1: ")) << block.err;
  EXPECT_TRUE(mentions(block.err, "0 to 511")) << block.err;
  EXPECT_EQ(run_psygen("export --model rock --out /dev/null/a.glb").code, 1);
  const Outcome world = run_psygen("export --model rock --world missing.toml --out a.glb");
  EXPECT_EQ(world.code, 1);
  EXPECT_TRUE(mentions(world.err, "missing.toml")) << world.err;
}

TEST(CommandLine, SeedsOfAll64BitsAreAcceptedAndPrintedAsGiven) {
  const TemporaryFolder folder;
  const auto exported = [&](const std::string& seed) {
    const std::string file = (folder / "seed.obj").string();
    const Outcome outcome = run_psygen("export --model rock --set seed=" + seed + " --out " + file);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read(file);
  };
  EXPECT_NE(exported("15585416654101124857"), exported("15585416654101124856"));
  EXPECT_EQ(exported("18446744073709551615"), exported("-1"));
  const Outcome beyond =
      run_psygen("export --model rock --set seed=18446744073709551616 --out a.glb");
  EXPECT_EQ(beyond.code, 2);
  EXPECT_TRUE(mentions(beyond.err, "from -9223372036854775808 to 18446744073709551615, not"))
      << beyond.err;

  const std::string seed = "15585416654101124857";
  const std::string world = (folder / "world.toml").string();
  std::ofstream(world) << "format = 1\n[world]\nname = \"Größe\"\nseed = \"" << seed
                       << "\"\nblocks = [1, 1]\n";
  const Outcome flight = run_psygen(
      "fly --headless --frames 1 --size 64x36 --view-distance 64 --json --world " + world);
  EXPECT_TRUE(mentions(flight.out, "\"seed\": " + seed)) << flight.out << flight.err;
  const Outcome blocks =
      run_psygen("amplify --world " + world + " --out " + (folder / "b").string());
  EXPECT_EQ(blocks.code, 0) << blocks.err;
  EXPECT_TRUE(mentions(read(folder / "b/world.toml"), "seed = \"" + seed + "\"\n"));
}

TEST(CommandLine, ExportWritesASpeciesOfAWorld) {
  const TemporaryFolder folder;
  const std::string file = (folder / "oak.glb").string();
  const std::string command = "export --world game/worlds/five_species.toml --model ";
  const Outcome oak = run_psygen(command + "oak --set seed=7 --set season=2 --out " + file);
  EXPECT_EQ(oak.code, 0) << oak.err;
  EXPECT_TRUE(mentions(oak.err, "1 object,")) << oak.err;
  EXPECT_GT(std::filesystem::file_size(file), 10'000u);
  const Outcome elm = run_psygen(command + "elm --out " + file);
  EXPECT_EQ(elm.code, 2);
  EXPECT_TRUE(mentions(elm.err, "oak, birch, spruce, palm, bush, dead_tree")) << elm.err;
}

TEST(CommandLine, ExportColoursTerrainLikeTheWorld) {
  const TemporaryFolder folder;
  const auto exported = [&](const std::string& options) {
    const std::string file = (folder / "ground.obj").string();
    const Outcome outcome = run_psygen("export --model terrain --level 3 --out " + file + options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read(file);
  };
  std::ofstream(folder / "flooded.toml")
      << read(source_file("game/worlds/paper.toml")) << "\n[water]\nlevel_m = 5000\n";
  const std::string flooded = exported(" --world " + (folder / "flooded.toml").string());
  EXPECT_FALSE(flooded.empty());
  EXPECT_NE(flooded, exported(""));
}

TEST(CommandLine, CalibrateWritesFitsAndPlots) {
  const TemporaryFolder folder;
  const Outcome outcome = run_psygen("calibrate --samples 4 --out " + folder.path().string());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* words : {"c·m·n²", "c·n·4^(n−1)", "c·mⁿ", "R²", "p95"})
    EXPECT_TRUE(mentions(outcome.out, words)) << words << "\n" << outcome.out;
  EXPECT_TRUE(mentions(read(folder / "calibration.html"), "<svg"));
  EXPECT_TRUE(mentions(read(folder / "calibration.json"), "\"r_squared\""));
  EXPECT_EQ(run_psygen("calibrate --samples 4 --out /proc/nowhere").code, 1);
}

TEST(CommandLine, CalibrateNamesTheSpeciesOfAWorld) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_psygen("calibrate --samples 4 --world game/worlds/five_species.toml --out " +
                 folder.path().string());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string json = read(folder / "calibration.json");
  for (const std::string name : {"oak", "birch", "spruce", "palm", "bush", "dead_tree"}) {
    EXPECT_TRUE(mentions(outcome.out, name + " ")) << outcome.out;
    EXPECT_TRUE(mentions(json, "\"model\": \"" + name + "\"")) << name;
    EXPECT_TRUE(mentions(read(folder / "calibration.html"), name + " level 0")) << name;
  }
  EXPECT_TRUE(mentions(outcome.out, "c·branches")) << outcome.out;
  const auto samples_of = [&json](const std::string& name) {
    const std::size_t fits = json.find("\"fits\""), end = json.find("\"held_out\"");
    const std::size_t model = json.find("\"model\": \"" + name + "\"", fits);
    const std::size_t at = json.find("\"samples\": ", model);
    return at < end ? std::stoi(json.substr(at + 11)) : -1;
  };
  for (const std::string name : {"terrain", "oak", "birch", "spruce", "palm", "bush", "dead_tree"})
    EXPECT_GT(samples_of(name), 0) << name;
  EXPECT_EQ(samples_of("tree"), 0) << "this world has no trees";
  EXPECT_TRUE(mentions(outcome.out, "tree      level 0  not measured")) << outcome.out;
}

TEST(CommandLine, TheRequestsOfAFlightAreRecordedAndScheduled) {
  const TemporaryFolder folder;
  const std::string file = (folder / "requests").string();
  const Outcome flight = run_psygen(
      "fly --headless --frames 3 --size 64x36 --view-distance 64 --record-requests " + file);
  EXPECT_EQ(flight.code, 0) << flight.err;
  const Outcome table = run_psygen("schedule --modelers 3 --requests " + file);
  EXPECT_EQ(table.code, 0) << table.err;
  for (const char* row : {"\nfifo ", "\nplp ", "\nshortest ", "\nlongest ", "\ndeadline "})
    EXPECT_TRUE(mentions(table.out, row)) << table.out;
  EXPECT_TRUE(mentions(table.out, "of the capacity of 3 modelers\n")) << table.out;
  for (const std::string& text : {table.out, run_psygen("schedule --help").out})
    EXPECT_TRUE(mentions(text, "\nlateness  lateness of those requests")) << text;
  EXPECT_TRUE(mentions(run_psygen("schedule --json --requests " + file).out, "\"late_percent\""));
  const Outcome missing = run_psygen("schedule --requests nowhere.requests");
  EXPECT_EQ(missing.code, 1);
  EXPECT_TRUE(mentions(missing.err, "nowhere.requests")) << missing.err;
  std::ofstream(folder / "empty");
  const Outcome empty = run_psygen("schedule --requests " + (folder / "empty").string());
  EXPECT_EQ(empty.code, 1);
  EXPECT_TRUE(mentions(empty.err, "the file has no requests")) << empty.err;
  EXPECT_EQ(run_psygen("schedule --requests /dev/zero").code, 1);
}

}  // namespace
}  // namespace psygen::cli
