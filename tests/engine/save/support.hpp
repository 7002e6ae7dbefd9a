// Saves for tests: distinguishable states of a whole game, and processes that are killed.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <tuple>

#include "ecs/fields.hpp"
#include "engine/save/save_game.hpp"
#include "tests/file_content.hpp"

namespace psygen::save::testing {

struct Creature {
  std::int64_t generation = 0;
};

}  // namespace psygen::save::testing

template <>
struct psygen::ecs::ComponentTraits<psygen::save::testing::Creature> {
  static constexpr std::string_view name = "creature";
  static constexpr auto fields =
      std::tuple{ecs::field("generation", &psygen::save::testing::Creature::generation)};
};

namespace psygen::save::testing {

inline const WorldIdentity kWorld{"test world", 0x1234};

inline Bytes bytes_of(std::string_view text) {
  Bytes bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

inline void write_file(const std::filesystem::path& path, std::string_view content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

inline SaveGame opened(const std::filesystem::path& file) {
  auto save = SaveGame::open(file, kWorld);
  EXPECT_TRUE(save.has_value()) << (save ? "" : save.error().message);
  return std::move(*save);
}

inline constexpr std::int32_t kBlocks = 40;

inline std::string edits_text(std::int64_t generation, std::int32_t block) {
  return fmt::format("{}/{}", generation, block) +
         std::string(static_cast<std::size_t>((generation * 97 + block * 131) % 1500), '.');
}

// Changes every part of the save. Half of the blocks exist in odd generations only.
inline core::Result<void> put_generation(SaveGame& save, std::int64_t generation) {
  for (std::int32_t b = 0; b < kBlocks; ++b) {
    if (b % 2 == 1 && generation % 2 == 0) {
      save.erase_edits({b, -b});
    } else if (auto ok = save.put_edits({b, -b}, 1, bytes_of(edits_text(generation, b))); !ok) {
      return ok;
    }
  }
  ecs::World world;
  const auto created = world.create<Creature>(30);
  for (auto& creature : created.column<Creature>())
    creature.generation = generation;
  if (auto ok = save.put_entities(world); !ok) return ok;
  if (auto ok = save.put_value("generation", generation); !ok) return ok;
  if (auto ok = save.execute("CREATE TABLE IF NOT EXISTS game_log(generation INTEGER)"); !ok)
    return ok;
  if (auto ok = save.execute("DELETE FROM game_log"); !ok) return ok;
  return save.execute("INSERT INTO game_log VALUES(?)", {generation});
}

// The generation of the save, after checking that all of it is of this one generation.
inline std::int64_t generation_of(const SaveGame& save) {
  const auto value = save.value("generation");
  if (!value || !std::holds_alternative<std::int64_t>(*value)) {
    ADD_FAILURE() << "the save has no generation";
    return -1;
  }
  const auto generation = std::get<std::int64_t>(*value);
  for (std::int32_t b = 0; b < kBlocks; ++b) {
    const auto edits = save.edits({b, -b});
    EXPECT_TRUE(edits.has_value()) << edits.error().message;
    const bool wanted = b % 2 == 0 || generation % 2 == 1;
    EXPECT_EQ(edits->has_value(), wanted) << "block " << b;
    if (wanted && edits->has_value()) {
      EXPECT_EQ((*edits)->bytes, bytes_of(edits_text(generation, b))) << "block " << b;
    }
  }
  ecs::World world;
  world.declare<Creature>();
  const auto loaded = save.load_entities(world);
  EXPECT_TRUE(loaded && *loaded) << (loaded ? "" : loaded.error().message);
  std::size_t creatures = 0;
  world.each<const Creature>([&](auto, auto all) {
    for (const Creature& creature : all) {
      EXPECT_EQ(creature.generation, generation);
      ++creatures;
    }
  });
  EXPECT_EQ(creatures, 30U);
  const auto log = save.query("SELECT generation FROM game_log");
  EXPECT_TRUE(log && log->rows.size() == 1 && log->rows[0][0] == Value(generation));
  return generation;
}

// Runs work() in a child process and returns its wait status. The child ends with exit code 0, or 1
// when work() returns false.
template <class Work>
int in_child(const Work& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work() ? 0 : 1);
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

}  // namespace psygen::save::testing
