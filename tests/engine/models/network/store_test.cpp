#include "engine/models/network/store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <thread>
#include <vector>

#include "engine/models/network/network.hpp"

namespace psygen::models {
namespace {

using Place = std::array<std::int64_t, 2>;

std::shared_ptr<const RiverNetwork> network_with(std::shared_ptr<NetworkStore> store) {
  return *RiverNetwork::create({.halvings = 6}, {.relief_m = 2000, .sea_level_m = 200},
                               std::move(store));
}

// A hash of ground and water around a place.
std::uint64_t hash_of(const RiverNetwork& network, const Place& place) {
  constexpr std::size_t kSide = 40;
  std::vector<std::int64_t> x, z;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(kSide); ++i) {
    x.push_back(place[0] + 2 * i);
    z.push_back(place[1] + 2 * i);
  }
  std::vector<float> height(kSide * kSide), water(kSide * kSide);
  network.evaluate({x, z}, {},
                   {.height_m = height.data(), .water_m = water.data(), .stride = kSide});
  return core::combine(core::hash_bytes(std::as_bytes(std::span(height))),
                       core::hash_bytes(std::as_bytes(std::span(water))));
}

TEST(NetworkStore, ChangesNoBitWithAnySizeAndThreadCount) {
  std::vector<Place> places;
  core::RandomStream random(4, 0, 0, 0, core::Purpose::kPosition);
  while (places.size() < 12)
    places.push_back(
        {random.next_integer(-300'000, 300'000), random.next_integer(-300'000, 300'000)});
  std::vector<std::uint64_t> expected;
  const auto bare = network_with(nullptr);
  for (const Place& place : places)
    expected.push_back(hash_of(*bare, place));
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1} << 20, std::size_t{64} << 20}) {
    for (const std::size_t threads : {1U, 2U, 4U}) {
      const auto store = std::make_shared<NetworkStore>(bytes);
      const auto network = network_with(store);
      std::vector<std::thread> running;
      std::vector<int> wrong(threads, 0);
      for (std::size_t t = 0; t < threads; ++t)
        running.emplace_back([&, t] {
          for (std::size_t k = 0; k < places.size(); ++k) {
            const std::size_t q = (k * 5 + t * 3) % places.size();
            wrong[t] += hash_of(*network, places[q]) != expected[q] ? 1 : 0;
          }
        });
      for (std::thread& thread : running)
        thread.join();
      for (const int count : wrong)
        EXPECT_EQ(count, 0);
      EXPECT_LE(store->bytes(), bytes);
      EXPECT_EQ(network->ready(network->tile_of(places[0][0], places[0][1], {})), bytes > 16 << 20);
    }
  }
}

TEST(NetworkStore, DropsTheLeastRecentlyUsedValues) {
  constexpr std::size_t kBytes = 8 * 3 * 2200;  // three root tiles in each of eight shards
  NetworkStore store(kBytes);
  const auto get = [&](std::int64_t i) {
    return store.get<network::RootTile>({1, {-1, i, 0}}, [] { return network::RootTile{}; });
  };
  const auto first = get(0);
  EXPECT_EQ(get(0), first);
  for (std::int64_t i = 1; i < 200; ++i) {
    get(i);
    EXPECT_EQ(get(0), first);  // in use
    EXPECT_LE(store.bytes(), kBytes);
  }
  EXPECT_FALSE(store.has({1, {-1, 1, 0}}));
  EXPECT_TRUE(store.has({1, {-1, 199, 0}}));
}

}  // namespace
}  // namespace psygen::models
