// docs/limits.md, row by row: an input at the limit loads, and one beyond it is refused with the
// message of the page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>

#include "engine/amplify/ledger.hpp"
#include "engine/captures/capture.hpp"
#include "engine/compare/recorded_run.hpp"
#include "engine/compare/times.hpp"
#include "engine/frametest/cause.hpp"
#include "engine/frametest/frame_test.hpp"
#include "engine/frametest/usual_load.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/handmade/files.hpp"
#include "engine/handmade/triangles.hpp"
#if defined(PSYGEN_LIMITS_OF_HISTORIES)
#include "engine/history/exchange.hpp"
#include "engine/history/store.hpp"
#endif
#include "engine/image/image_io.hpp"
#include "engine/input/actions.hpp"
#include "engine/inspect/scene_answers.hpp"
#include "engine/models/registry.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/world/camera_path.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/files/document.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/gltf/sample.hpp"
#include "tests/limits/page.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"
#if defined(PSYGEN_LIMITS_OF_SAVES)
#include "engine/save/save_game.hpp"
#endif
#if defined(PSYGEN_LIMITS_OF_SOUNDS)
#include "tests/engine/audio/tones.hpp"
#endif

namespace psygen::limits {
namespace {

using Outcome = core::Result<void>;
using Count = std::size_t;
namespace fs = std::filesystem;

template <class T>
Outcome outcome(const core::Result<T>& result) {
  if (result) return {};
  return tl::unexpected(result.error());
}

std::string repeated(Count count, const std::string& text) {
  std::string all;
  for (Count i = 0; i < count; ++i)
    all += text;
  return all;
}

// The text with every "#" replaced by the numbers 0, 1, 2 … of its repetitions.
std::string numbered(Count count, const std::string& text) {
  std::string all;
  for (Count i = 0; i < count; ++i)
    for (const char c : text)
      all += c == '#' ? std::to_string(i) : std::string(1, c);
  return all;
}

void write(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}
// A file of zeros, which takes no room on the disk.
void write_zeros(const fs::path& file, std::uintmax_t bytes) {
  write(file, "");
  fs::resize_file(file, bytes);
}

// Worlds
// ---------------------------------------------------------------------------------------------

constexpr const char* kHead =
    "format = 1\n[world]\nname = \"w\"\nseed = 1\nblocks = [2000, 2000]\nblock_vertices = 33\n"
    "[terrain]\noctaves = 1\n";
constexpr const char* kGrass = "[[scatter]]\nmodel = \"grass\"\ncount = 1\n";
constexpr const char* kSpecies =
    "[[species]]\nname = \"s#\"\naxiom = \"T\"\niterations = 1\n"
    "[[species.kind]]\nsymbol = \"T\"\n";
constexpr const char* kRule = "[[species.rule]]\nfrom = \"T\"\nto = \"T\"\n";

Outcome load_world(const fs::path& folder, const std::string& text) {
  write(folder / "w.toml", text);
  auto registry = models::make_standard_registry();
  return outcome(world::load_world(folder / "w.toml", registry, &handmade::files()));
}
Outcome load_tables(const fs::path& folder, const std::string& tables) {
  return load_world(folder, kHead + tables);
}

std::string stamp(const std::string& image) {
  return "[[stamp]]\nimage = \"" + image + "\"\ncentre_m = [900, 900]\nheight_m = 1\n";
}
void write_grey(const fs::path& file, Count width, Count height) {
  image::GreyImage image;
  image.width = static_cast<std::uint32_t>(width),
  image.height = static_cast<std::uint32_t>(height);
  image.grey.resize(width * height);
  ASSERT_TRUE(image::write_png(file, image));
}

std::string road(Count points, double step_m = 2) {
  std::ostringstream text;
  text << "[[road]]\npoints_m = [";
  for (Count i = 0; i < points; ++i)
    text << "[" << 100 + step_m * static_cast<double>(i) << ", 700], ";
  text << "]\n";
  return text.str();
}

std::string river(Count points, double step_m = 2, int z = 700) {
  std::ostringstream text;
  text << "[[river]]\npoints_m = [";
  for (Count i = 0; i < points; ++i)
    text << "[" << 100 + step_m * static_cast<double>(i) << ", " << z << "], ";
  text << "]\n";
  return text.str();
}
// A bar of 20 m.
std::string lake(double wide_m, double z) {
  std::ostringstream text;
  text << "[[lake]]\npoints_m = [";
  for (int i = 0; i < 40; ++i)
    text << "[" << 900 + wide_m * (i <= 20 ? i : 40 - i) / 20.0 << ", " << z + (i <= 20 ? 0 : 20)
         << "], ";
  text << "[" << 900 << ", " << z + 20 << "]]\n";
  return text.str();
}

world::World flat_world(const models::Registry& registry) {
  return *world::parse_world(kHead, "flat", registry);
}

// glTF
// -----------------------------------------------------------------------------------------------

Outcome load_gltf(const fs::path& folder, const gltf::Sample& sample) {
  write(folder / "m.glb", sample.glb());
  return outcome(gltf::read_file(folder / "m.glb", handmade::gltf_limits()));
}

// A file whose JSON ends with "extras" of this text.
Outcome load_with_extras(const fs::path& folder,
                         const std::function<std::string(const std::string&)>& extras) {
  gltf::Sample sample = gltf::square();
  sample.json["extras"] = "@";
  std::string text = sample.text("m.bin");
  const std::size_t at = text.find("\"@\"");
  text.replace(at, 3, extras(text));
  write(folder / "m.bin", sample.binary);
  write(folder / "m.gltf", text);
  return outcome(gltf::read_file(folder / "m.gltf", handmade::gltf_limits()));
}

// Commas and opening brackets outside of strings.
Count values_in(const std::string& json) {
  bool in_string = false;
  Count count = 0;
  for (const char c : json) {
    if (c == '"') in_string = !in_string;
    if (!in_string && (c == ',' || c == '[' || c == '{')) ++count;
  }
  return count;
}

// One mesh of these triangles, with normals upwards.
gltf::Sample mesh(const std::vector<glm::vec3>& positions,
                  const std::vector<std::uint32_t>& corners) {
  gltf::Sample s;
  nlohmann::json primitive = {{"indices", s.accessor(corners, "SCALAR", gltf::kInts)}};
  const std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 1, 0));
  primitive["attributes"] = {{"POSITION", s.accessor(positions, "VEC3", gltf::kFloats)},
                             {"NORMAL", s.accessor(normals, "VEC3", gltf::kFloats)}};
  s.add("meshes", {{"primitives", gltf::list(primitive)}});
  s.add("nodes", gltf::parsed(R"({"mesh": 0})"));
  s.add("scenes", gltf::parsed(R"({"nodes": [0]})"));
  return s;
}

// One triangle with this many vertices and indices.
gltf::Sample soup(Count vertices, Count indices) {
  std::vector<glm::vec3> positions(vertices, glm::vec3(0));
  positions[1].x = positions[2].z = 1;
  std::vector<std::uint32_t> corners(indices, 0);
  for (Count i = 0; i < indices; ++i)
    corners[i] = static_cast<std::uint32_t>(i % 3);
  return mesh(positions, corners);
}

constexpr Count kGridSide = 256;
// A surface of kGridSide² vertices.
gltf::Sample surface() {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < kGridSide * kGridSide; ++i) {
    const std::uint32_t x = i % kGridSide, z = i / kGridSide;
    positions.emplace_back(x, (x * z) % 7, z);
    if (x + 1 == kGridSide || z + 1 == kGridSide) continue;
    const std::uint32_t side = kGridSide;
    corners.insert(corners.end(), {i, i + side, i + 1, i + 1, i + side, i + side + 1});
  }
  return mesh(positions, corners);
}

// The bytes of one more key than `keys` need a second channel.
gltf::Sample animated(Count keys) {
  gltf::Sample s = gltf::square();
  s.json.erase("animations");
  std::vector<float> times(keys / 2);
  for (Count i = 0; i < times.size(); ++i)
    times[i] = static_cast<float>(i);
  const int input = s.accessor(times, "SCALAR", gltf::kFloats);
  const int output = s.accessor(std::vector<glm::vec3>(times.size()), "VEC3", gltf::kFloats);
  s.add("animations",
        {{"samplers", gltf::list(nlohmann::json{{"input", input}, {"output", output}})},
         {"channels", gltf::list(nlohmann::json{
                          {"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}})}});
  return s;
}

// Materials with textures of 4096 x 4096 pixels.
gltf::Sample pictured(const fs::path& folder, Count bytes) {
  constexpr Count kSide = 4096, kBytes = kSide * kSide * 4;
  gltf::Sample s = gltf::square();
  EXPECT_TRUE(image::write_png(folder / "p.png", image::make_image(kSide, kSide, 9, 9, 9, 255)));
  EXPECT_TRUE(image::write_png(folder / "q.png", image::make_image(1, 1, 9, 9, 9, 255)));
  const auto view = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return s.view(std::string{std::istreambuf_iterator<char>(in), {}});
  };
  const int large = view("p.png"), small = view("q.png");
  for (Count sum = 0; sum < bytes; sum += kBytes) {
    const int image = s.add("images", {{"bufferView", bytes - sum >= kBytes ? large : small},
                                       {"mimeType", "image/png"}});
    const int texture = s.add("textures", {{"source", image}});
    s.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  }
  for (Count i = 1; i < s.json["materials"].size(); ++i) {
    nlohmann::json primitive = s.json["meshes"][0]["primitives"][0];
    primitive["material"] = i;
    s.json["meshes"][0]["primitives"].push_back(primitive);
  }
  return s;
}

// Other readers
// ----------------------------------------------------------------------------------------

std::string path_text(const std::string& points) {
  return "format = 1\n[path]\nname = \"p\"\n" + points;
}
std::string path_point(double time_s, double x_m) {
  std::ostringstream text;
  text.precision(17);
  text << "[[point]]\ntime_s = " << time_s << "\nat_m = [" << x_m << ", 0.0]\nheight_m = 2\n";
  return text.str();
}
Outcome load_path(const std::string& points) {
  return outcome(world::parse_camera_path(path_text(points), "p.toml"));
}

models::GroundEdit map_edit(Count side) {
  models::GroundEdit edit;
  edit.change = models::GroundChange::kStampAdd;
  edit.square = true;
  edit.centre.local = {5, 0, 5};
  auto map = std::make_shared<models::Heightmap>();
  map->columns = static_cast<std::uint32_t>(side), map->rows = 2;
  map->heights_m.resize(side * 2);
  edit.map = map;
  return edit;
}

// Heights and numbers of edits of block (0, 0) up to the limits of a block.
Outcome add_heights(Count heights) {
  const auto registry = models::make_standard_registry();
  const world::World flat = flat_world(registry);
  world::Edits edits;
  Outcome added;
  for (Count sum = 0; sum < heights && added;) {
    const Count rows = std::clamp<Count>((heights - sum) / 1024, 2, 1024);
    models::GroundEdit edit = map_edit(1024);
    auto map = std::make_shared<models::Heightmap>(*edit.map);
    map->rows = static_cast<std::uint32_t>(rows);
    map->heights_m.resize(1024 * rows);
    edit.map = map;
    sum += map->heights_m.size();
    added = outcome(edits.edit_ground(flat, edit));
  }
  return added;
}
Outcome add_edits(Count count) {
  const auto registry = models::make_standard_registry();
  const world::World flat = flat_world(registry);
  const models::ModelType& rock = registry[static_cast<models::ModelIndex>(registry.find("rock"))];
  models::BlockEdits block;
  for (Count i = 0; i + 1 < count; ++i) {
    models::PlacedModel placed;
    placed.id = static_cast<std::uint32_t>(i + 1);
    placed.parameters = models::default_parameters(rock);
    models::bind(placed, rock);
    block.placed.push_back(placed);
  }
  world::Edits edits;
  if (auto ok = edits.replace_block(flat, {0, 0}, std::move(block)); !ok) return ok;
  return outcome(edits.raise(flat, {{0, 0}, {1, 0, 1}}, 1, 0.1));
}

std::string frame_test(const std::string& name) {
  return "format = 1\nname = \"" + name +
         "\"\n[flight]\nseconds = 1\n[at_most]\nframe_ms.p99 = 5\n";
}

Outcome load_capture(const std::string& text) {
  return outcome(captures::parse(text, "c"));
}

#if defined(PSYGEN_LIMITS_OF_SOUNDS)
Outcome load_sound(const fs::path& folder, const audio::Clip& clip) {
  audio::testing::write_sound(folder / "s.wav", clip, SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  return outcome(audio::read_clip(folder / "s.wav"));
}
#endif

std::string in_string(Count bytes) {
  return std::string(bytes, 'n');
}

// A case: what becomes of an input of this size.
struct Case {
  const char* input;
  std::function<Outcome(const fs::path& folder, double size)> load;
  double beyond = 1;         // the next size
  bool only_beyond = false;  // an input at the limit takes too much memory for a test
};

Count whole(double size) {
  return static_cast<Count>(size);
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all {
    // World files
    {"bytes of a world file",
     [](const fs::path& folder, double n) {
       const std::string text = kHead;
       return load_world(folder, text + "#" + std::string(whole(n) - text.size() - 1, ' '));
     }},
        {"nested values in a TOML file",
         [](const fs::path&, double n) {
           return outcome(world::parse_document(
               "a = " + repeated(whole(n), "[") + repeated(whole(n), "]"), "t"));
         }},
        {"dotted parts of a key in a TOML file",
         [](const fs::path&, double n) {
           return outcome(
               world::parse_document("a" + repeated(whole(n) - 1, ".a") + " = 1\n", "t"));
         }},
        {"bytes of a world's name",
         [](const fs::path& folder, double n) {
           return load_world(folder, std::regex_replace(std::string(kHead), std::regex("\"w\""),
                                                        "\"" + in_string(whole(n)) + "\""));
         }},
        {"`[[species]]` of a world",
         [](const fs::path& folder, double n) {
           return load_tables(folder, numbered(whole(n), std::string(kSpecies) + kRule));
         }},
        {"`[[species.kind]]` of a species",
         [](const fs::path& folder, double n) {
           std::string kinds;
           for (Count i = 1; i < whole(n); ++i)
             kinds +=
                 std::string("[[species.kind]]\nsymbol = \"") + static_cast<char>('A' + i) + "\"\n";
           return load_tables(folder, numbered(1, kSpecies) + kinds + kRule);
         }},
        {"`[[species.rule]]` of a species",
         [](const fs::path& folder, double n) {
           const std::string rule = std::string(kRule) + "probability = 0.0625\n";
           return load_tables(folder, numbered(1, kSpecies) + repeated(whole(n), rule));
         }},
        {"`[[model]]` of a world",
         [](const fs::path& folder, double n) {
           write(folder / "m.glb", gltf::square().glb());
           return load_tables(folder,
                              numbered(whole(n), "[[model]]\nname = \"m#\"\nfile = \"m.glb\"\n"));
         }},
        {"`[[scatter]]` of a world",
         [](const fs::path& folder, double n) {
           return load_tables(folder, repeated(whole(n), kGrass));
         }},
        {"models of one `[[scatter]]` on a block",
         [](const fs::path& folder, double n) {
           return load_tables(folder, "[[scatter]]\nmodel = \"grass\"\ncount = " +
                                          std::to_string(whole(n)) + "\n");
         }},
        {"models of all `[[scatter]]` on a block",
         [](const fs::path& folder, double n) {
           return load_tables(folder, kGrass + ("[[scatter]]\nmodel = \"grass\"\ncount = " +
                                                std::to_string(whole(n) - 1) + "\n"));
         }},
        {"`[[place]]` of a world",
         [](const fs::path& folder, double n) {
           return load_tables(folder,
                              numbered(whole(n), "[[place]]\nmodel = \"rock\"\nat_m = [9, #]\n"));
         }},
        {"`[[stamp]]` of a world",
         [](const fs::path& folder, double n) {
           write_grey(folder / "s.png", 2, 2);
           return load_tables(folder, repeated(whole(n), stamp("s.png")));
         }},
        {"`[[road]]` of a world",
         [](const fs::path& folder, double n) {
           return load_tables(folder, repeated(whole(n), road(2)));
         }},
        {"points of a road",
         [](const fs::path& folder, double n) { return load_tables(folder, road(whole(n))); }},
        {"length of all roads together",
         [](const fs::path& folder, double n) {
           return load_tables(folder, road(2, 20'000) + road(2, 30'000) + road(2, n - 50'000));
         },
         1},
        {"`[[lake]]` of a world",
         [](const fs::path& folder, double n) {
           std::string tables;
           for (Count i = 0; i < whole(n); ++i)
             tables += lake(40, 100 + 90 * static_cast<double>(i));
           return load_tables(folder, tables);
         }},
        {"`[[river]]` of a world",
         [](const fs::path& folder, double n) {
           std::string tables;
           for (Count i = 0; i < whole(n); ++i)
             tables += river(2, 20, static_cast<int>(100 + 40 * i));
           return load_tables(folder, tables);
         }},
        {"points of a river",
         [](const fs::path& folder, double n) { return load_tables(folder, river(whole(n))); }},
        {"length of all rivers together",
         [](const fs::path& folder, double n) {
           return load_tables(
               folder, river(2, 20'000) + river(2, 30'000, 900) + river(2, n - 50'000, 1100));
         },
         1},
        {"width of a lake",
         [](const fs::path& folder, double n) { return load_tables(folder, lake(n, 900)); }, 1},
        {"side of a mask or a stamp",
         [](const fs::path& folder, double n) {
           write_grey(folder / "s.png", whole(n), 2);
           return load_tables(folder, stamp("s.png"));
         }},
        {"bytes of a picture's file",
         [](const fs::path& folder, double n) {
           write_zeros(folder / "s.png", whole(n));
           return load_tables(folder, stamp("s.png"));
         },
         1, true},
        {"memory of all masks and stamps together",
         [](const fs::path& folder, double n) {
           // Seven stamps of one picture and one mask have the limit; another picture is beyond it.
           write_grey(folder / "s.png", 4096, 4096);
           write_grey(folder / "m.png", 4096, 4096);
           write_grey(folder / "t.png", 2, 2);
           const std::string mask = kGrass + std::string("mask_image = \"m.png\"\n");
           const bool beyond = n > double{512U << 20U};
           return load_tables(folder,
                              mask + repeated(7, stamp("s.png")) + (beyond ? stamp("t.png") : ""));
         }},
        // glTF
        {"bytes of a model's files",
         [](const fs::path& folder, double n) {
           gltf::Sample sample = gltf::square();
           for (int i = 0; i < 2;
                ++i)  // the second time the length has as many digits as at the end
             sample.binary.resize(sample.binary.size() + whole(n) - sample.glb().size());
           EXPECT_EQ(sample.glb().size(), whole(n));
           return load_gltf(folder, sample);
         },
         4},
        {"values in a model's JSON",
         [](const fs::path& folder, double n) {
           return load_with_extras(folder, [n](const std::string& rest) {
             return "[0" + repeated(whole(n) - values_in(rest) - 1, ",0") + "]";
           });
         }},
        {"nesting of a model's JSON",
         [](const fs::path& folder, double n) {
           return load_with_extras(folder, [n](const std::string&) {
             return repeated(whole(n) - 1, "[") + repeated(whole(n) - 1, "]");
           });
         }},
        {"nodes of a model",
         [](const fs::path& folder, double n) {
           gltf::Sample sample = gltf::square();
           while (sample.json["nodes"].size() < whole(n))
             sample.add("nodes", nlohmann::json::object());
           return load_gltf(folder, sample);
         }},
        {"vertices in a model's file",
         [](const fs::path& folder, double n) { return load_gltf(folder, soup(whole(n), 3)); }},
        {"indices in a model's file",
         [](const fs::path& folder, double n) { return load_gltf(folder, soup(3, whole(n))); }, 3},
        {"keys of a model's animations",
         [](const fs::path& folder, double n) { return load_gltf(folder, animated(whole(n))); }, 2},
        {"memory of a model's textures",
         [](const fs::path& folder, double n) {
           return load_gltf(folder, pictured(folder, whole(n)));
         }},
        {"vertices of a model with all its nodes",
         [](const fs::path& folder, double n) {
           gltf::Sample sample = soup(1024, 3);
           sample.json["scenes"][0]["nodes"] = nlohmann::json::array();
           for (Count i = 0; i < (whole(n) + 1023) / 1024; ++i) {
             if (i > 0) sample.add("nodes", gltf::parsed(R"({"mesh": 0})"));
             sample.json["scenes"][0]["nodes"].push_back(i);
           }
           write(folder / "m.glb", sample.glb());
           return outcome(gltf::read_file(folder / "m.glb", handmade::gltf_limits())
                              .and_then([](const gltf::Model& model) {
                                return handmade::triangles_of(model, world::HandmadeModel{});
                              }));
         }},
        {"memory of all models of a world",
         [](const fs::path& folder, double n) {
           write(folder / "m.glb", surface().glb());
           const Count each = kGridSide * kGridSide * sizeof(handmade::Vertex) +
                              6 * (kGridSide - 1) * (kGridSide - 1) * sizeof(std::uint16_t);
           return load_tables(folder,
                              numbered(whole(n) / each + 1,
                                       "[[model]]\nname = \"m#\"\nfile = \"m.glb\"\nsize_m = 1.#5\n"
                                       "levels = 1\ncollider = \"none\"\n"));
         },
         1, true},
        // Camera paths
        {"points of a camera path",
         [](const fs::path&, double n) {
           std::string points;
           for (Count i = 0; i < whole(n); ++i)
             points += path_point(static_cast<double>(i), 0);
           return load_path(points);
         }},
        {"speed of a camera path",
         [](const fs::path&, double n) { return load_path(path_point(0, 0) + path_point(1, n)); }},
        {"time of a camera path",
         [](const fs::path&, double n) { return load_path(path_point(0, 0) + path_point(n, 0)); }},
        {"distance of a camera path from its block",
         [](const fs::path&, double n) { return load_path(path_point(0, n) + path_point(1, n)); }},
        // Edits
        {"radius of an edit of the ground",
         [](const fs::path&, double n) {
           world::Edits edits;
           return outcome(edits.raise(flat_world(models::make_standard_registry()),
                                      {{9, 9}, {1, 0, 1}}, n, 0.1));
         }},
        {"side of an edit's heightmap",
         [](const fs::path&, double n) {
           world::Edits edits;
           return outcome(
               edits.edit_ground(flat_world(models::make_standard_registry()), map_edit(whole(n))));
         }},
        {"heights in the heightmaps of a block",
         [](const fs::path&, double n) { return add_heights(whole(n)); }},
        {"edits of a block", [](const fs::path&, double n) { return add_edits(whole(n)); }},
        {"distance of an edit from its block",
         [](const fs::path&, double n) {
           world::Edits edits;
           const auto registry = models::make_standard_registry();
           const auto endless = *world::parse_world(
               std::regex_replace(std::string(kHead), std::regex("2000, 2000"), "0, 0"), "endless",
               registry);
           return outcome(edits.raise(endless, {{0, 0}, {n, 0, 1}}, 1, 0.1));
         }},
        // Input
        {"actions of a game",
         [](const fs::path&, double n) {
           input::Actions actions;
           Outcome added;
           for (Count i = 0; i < whole(n) && added; ++i)
             added = outcome(actions.add("a" + std::to_string(i)));
           return added;
         }},
        {"bindings of an action",
         [](const fs::path&, double n) {
           input::Actions actions;
           return outcome(actions.add(
               "a", std::vector<input::Binding>(whole(n), input::Binding{platform::Key::kA})));
         }},
        {"bytes of an action's name",
         [](const fs::path&, double n) {
           input::Actions actions;
           return outcome(actions.add(in_string(whole(n))));
         }},
        // Sockets
        {"block of a camera pose of a client",
         [](const fs::path&, double n) {
           return outcome(inspect::pose_from({{"block", {0, static_cast<std::int64_t>(n)}},
                                              {"local_m", {0, 0, 0}},
                                              {"yaw", 0},
                                              {"pitch", 0}},
                                             64));
         }},
        // Runs
        {"bytes of a frame test's name",
         [](const fs::path&, double n) {
           return outcome(frametest::parse_frame_test(frame_test(in_string(whole(n))), "t"));
         }},
        {"runs of a frame test",
         [](const fs::path&, double n) {
           return outcome(frametest::parse_frame_test(
               frame_test("t") + "[test]\nruns = " + std::to_string(whole(n)) + "\n", "t"));
         }},
        {"retries of a frame test",
         [](const fs::path&, double n) {
           return outcome(frametest::parse_frame_test(
               frame_test("t") + "[test]\nretries = " + std::to_string(whole(n)) + "\n", "t"));
         }},
        {"bytes of a file of usual times",
         [](const fs::path& folder, double n) {
           write(folder / "u.jsonl", std::string(whole(n), '\n'));
           return outcome(frametest::UsualLoadFile::load(folder / "u.jsonl"));
         }},
        {"bytes of a frame test",
         [](const fs::path& folder, double n) {
           const std::string text = frame_test("t");
           write(folder / "t.toml", text + "#" + std::string(whole(n) - text.size() - 1, ' '));
           return outcome(frametest::load_frame_test(folder / "t.toml"));
         }},
        {"sections of a frame test",
         [](const fs::path&, double n) {
           return outcome(frametest::parse_frame_test(
               frame_test("t") + numbered(whole(n), "[sections.s#]\n"), "t"));
         }},
        {"figures of a game",
         [](const fs::path&, double n) {
           telemetry::OwnFigures figures;
           Outcome added;
           for (Count i = 0; i < whole(n) && added; ++i)
             added = outcome(figures.add({.name = "f" + std::to_string(i)}));
           return added;
         }},
        {"bytes of a figure's name",
         [](const fs::path&, double n) {
           telemetry::OwnFigures figures;
           return outcome(figures.add({.name = in_string(whole(n))}));
         }},
        {"bytes of a figure's unit",
         [](const fs::path&, double n) {
           telemetry::OwnFigures figures;
           return outcome(figures.add({.name = "f", .unit = in_string(whole(n))}));
         }},
        {"bytes of a `profile.json`",
         [](const fs::path& folder, double n) {
           const std::string text = frametest::to_json(frametest::ProfileSummary{});
           write(folder / "p.json", text + std::string(whole(n) - text.size(), ' '));
           return outcome(frametest::read_profile(folder / "p.json"));
         }},
        {"bytes of a ledger",
         [](const fs::path& folder, double n) {
           write_zeros(folder / "l", whole(n));
           return outcome(amplify::read_ledger(folder / "l"));
         },
         1, true},
        {"bytes of a run's `frames.csv`",
         [](const fs::path& folder, double n) {
           write(folder / "summary.json", "{}");
           write_zeros(folder / "frames.csv", whole(n));
           return outcome(compare::read_run(folder));
         },
         1, true},
        {"bytes of a capture of another tool",
         [](const fs::path& folder, double n) {
           write_zeros(folder / "c.csv", whole(n));
           return outcome(captures::read(folder / "c.csv"));
         },
         1, true},
        {"bytes of a capture's line",
         [](const fs::path&, double n) {
           return load_capture("Application,MsBetweenPresents\n" + in_string(whole(n) - 2) +
                               ",5\n");
         }},
        {"swap chains of a capture",
         [](const fs::path&, double n) {
           return load_capture("Application,ProcessID,MsBetweenPresents\n" +
                               numbered(whole(n), "a,#,5\n"));
         }},
        {"nesting of a capture's JSON",
         [](const fs::path&, double n) {
           return load_capture(R"({"Runs": [{"CaptureData": {"MsBetweenPresents": [5]}}], "x": )" +
                               repeated(whole(n) - 1, "[") + repeated(whole(n) - 1, "]") + "}");
         }},
        {"captures of a side of a comparison",
         [](const fs::path&, double n) {
           compare::TimesSide one, many;
           one.captures.resize(1);
           many.captures.resize(whole(n));
           return outcome(compare::compare_times(one, many));
         }},
#if defined(PSYGEN_LIMITS_OF_HISTORIES)
        {"bytes of a file of entries for a history",
         [](const fs::path& folder, double n) {
           write_zeros(folder / "h.csv", whole(n));
           return outcome(history::read_entries(folder / "h.csv"));
         },
         1, true},
        {"bytes of a text in a history",
         [](const fs::path& folder, double n) {
           std::filesystem::remove(folder / "h.sqlite");
           const std::vector<history::Entry> entries = {
               {.test = in_string(whole(n)), .figure = "f", .value = 1}};
           auto store = history::Store::open(folder / "h.sqlite");
           return store ? outcome(store->add(entries)) : outcome(store);
         }},
#endif
#if defined(PSYGEN_LIMITS_OF_SAVES)
        {"bytes of a value in a save",
         [](const fs::path&, double n) {
           return save::check_value(save::Bytes(whole(n)), "the value");
         }},
        {"bytes of the edits of a block in a save",
         [](const fs::path& folder, double n) {
           auto save = save::SaveGame::open(folder / "s", {});
           return save ? save->put_edits({0, 0}, 1, std::vector<std::byte>(whole(n)))
                       : outcome(save);
         }},
        {"bytes of a value's name in a save",
         [](const fs::path& folder, double n) {
           auto save = save::SaveGame::open(folder / "s", {});
           return save ? save->put_value(in_string(whole(n)), 1.0) : outcome(save);
         }},
#endif
#if defined(PSYGEN_LIMITS_OF_SOUNDS)
        {"memory of a sound",
         [](const fs::path& folder, double n) {
           return load_sound(folder, {48'000, 1, std::vector<std::int16_t>(whole(n / 2))});
         },
         2},
        {"rate of a sound",
         [](const fs::path& folder, double n) {
           return load_sound(folder, {static_cast<std::uint32_t>(n), 1, {0, 0}});
         }},
        {"channels of a sound", [](const fs::path& folder, double n) {
           return load_sound(folder,
                             {48'000, static_cast<std::uint32_t>(n), std::vector<std::int16_t>(6)});
         }},
#endif
  };
  return all;
}

class Limits : public ::testing::TestWithParam<Case> {};

TEST_P(Limits, HoldAsThePageSays) {
  const Page page = read_page();
  const auto row = std::ranges::find(page.tried, GetParam().input, &Row::input);
  ASSERT_NE(row, page.tried.end()) << "docs/limits.md has no row for " << GetParam().input;
  const TemporaryFolder folder;
  if (!GetParam().only_beyond) {
    const Outcome at_limit = GetParam().load(folder.path(), row->most);
    EXPECT_TRUE(at_limit) << at_limit.error().message;
  }
  const Outcome beyond = GetParam().load(folder.path(), row->most + GetParam().beyond);
  ASSERT_FALSE(beyond) << "one more than the limit is accepted";
  EXPECT_TRUE(matches(beyond.error().message, row->refusal))
      << beyond.error().message << "\n  instead of\n"
      << row->refusal;
}

INSTANTIATE_TEST_SUITE_P(Of, Limits, ::testing::ValuesIn(cases()), [](const auto& of) {
  return std::regex_replace(std::string(of.param.input), std::regex("[^A-Za-z0-9]+"), "_");
});

TEST(LimitsPage, HasACaseForEachRowAndConstantsThatExist) {
  const Page page = read_page();
  EXPECT_GT(page.tried.size(), 40U);
  const auto contains = [](const std::string& file, const std::string& word) {
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return std::regex_search(text, std::regex("\\b" + word + "\\b"));
  };
  for (const auto& rows : {page.tried, page.held_elsewhere}) {
    for (const Row& row : rows)
      EXPECT_TRUE(contains(source_file(row.file), row.constant))
          << row.input << ": no " << row.constant << " in " << row.file;
  }
#if defined(PSYGEN_LIMITS_OF_SAVES) && defined(PSYGEN_LIMITS_OF_SOUNDS) && \
    defined(PSYGEN_LIMITS_OF_HISTORIES)
  for (const Row& row : page.tried) {
    EXPECT_TRUE(std::ranges::any_of(cases(), [&](const Case& c) { return c.input == row.input; }))
        << "nothing tries the row " << row.input;
  }
#endif
  for (const Row& row : page.held_elsewhere) {
    const std::size_t colon = row.test.find(':');
    EXPECT_TRUE(contains(source_file(row.test.substr(0, colon)), row.test.substr(colon + 1)))
        << row.input << ": no test " << row.test;
  }
}

TEST(LimitsPage, RefusalsAreComparedPartByPart) {
  EXPECT_TRUE(matches("w.toml:3: at most 64 of them", "at most 64 …"));
  EXPECT_TRUE(matches("a 1 b 2 c", "a … b … c"));
  EXPECT_FALSE(matches("c b a", "a … b"));
}

}  // namespace
}  // namespace psygen::limits
