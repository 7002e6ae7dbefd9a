// Tests annotations of meshes, from the modeler's hook to the end of the mesh.
#include <gtest/gtest.h>

#include <thread>

#include "engine/core/geometry_memory.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/synthesis/synthesis_manager.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {
using testing::FakeModel;
using testing::Gate;
using testing::hole;
using testing::key_of;
using testing::kMeshBytes;
using testing::LyingModel;
using testing::parameters_of;
using testing::ScriptedModel;

constexpr models::ModelIndex kNoted = 0, kPlain = 1, kLying = 2;

// Annotation of these tests. Shared, so that a test observes its destruction.
struct Seen {
  std::uint64_t hash = 0;  // of the mesh
  std::thread::id thread;
};
using Note = std::shared_ptr<const Seen>;

// Annotates one of three types; the hook of another one fails.
class NoteTest : public ::testing::Test {
 protected:
  NoteTest() {
    const auto script = [this](const auto& p, int) {
      synthesised_by = std::this_thread::get_id();
      if (p.integer(0) == 99) gate.wait();
    };
    EXPECT_TRUE(registry.add(std::make_unique<ScriptedModel>("noted", script)));
    EXPECT_TRUE(registry.add(std::make_unique<FakeModel>("plain")));
    EXPECT_TRUE(registry.add(std::make_unique<LyingModel>()));
    options.modelers = 1;
    options.watchdog_seconds = 0;
    options.hash_content = true;
    options.annotate.resize(3);
    options.annotate[kNoted] =
        options.annotate[kLying] = [this](const Request& request, const models::MeshView& mesh) {
          const auto note = std::make_shared<const Seen>(
              Seen{content_hash(request.key, mesh), std::this_thread::get_id()});
          last = note;
          ++made;
          return std::any(Note(note));
        };
  }

  Request request(std::uint32_t index, models::ModelIndex model = kNoted) {
    const auto p = parameters_of(index, 80);
    Request r;
    r.handle = cache.reserve(key_of(index, p, model), p, index, hole(1)).value_or(kNoMesh);
    r.key = key_of(index, p, model);
    r.parameters = p;
    r.destination = cache.get(r.handle)->destination;
    r.size = cache.get(r.handle)->size;
    r.owner = index;
    return r;
  }
  std::vector<Completion> run(std::vector<Request> plan) {
    SynthesisManager manager(registry, options);
    manager.publish(std::move(plan));
    EXPECT_TRUE(manager.wait_all());
    std::vector<Completion> done;
    manager.collect(done);
    return done;
  }
  // Adds the mesh and makes it ready.
  MeshHandle add(std::uint32_t index) {
    std::vector<Completion> done = run({request(index)});
    EXPECT_EQ(land(done, cache, nullptr).ready, 1u);
    EXPECT_FALSE(done[0].note.has_value());
    return done[0].handle;
  }
  static const Seen* seen(const std::any& note) {
    const Note* known = std::any_cast<Note>(&note);
    return known == nullptr ? nullptr : known->get();
  }

  Gate gate;
  std::atomic<std::thread::id> synthesised_by;
  std::weak_ptr<const Seen> last;  // the last one made
  int made = 0;
  models::Registry registry;
  SynthesisOptions options;
  core::HeapGeometryMemory memory{1 << 20};
  GeometryCache cache{memory, registry, 4 * kMeshBytes};
};

TEST_F(NoteTest, IsMadeOfTheMeshByTheThreadThatSynthesisedIt) {
  const std::vector<Completion> done = run({request(1)});
  ASSERT_EQ(done.size(), 1u);
  const Seen* note = seen(done[0].note);
  ASSERT_NE(note, nullptr);
  EXPECT_EQ(note->hash, done[0].content_hash);
  EXPECT_EQ(note->thread, synthesised_by.load());
  EXPECT_NE(note->thread, std::this_thread::get_id());

  SynthesisManager manager(registry, options);
  std::vector<Completion> here;
  manager.execute_here(request(2));
  manager.collect(here);
  ASSERT_NE(seen(here.at(0).note), nullptr);
  EXPECT_EQ(seen(here[0].note)->thread, std::this_thread::get_id());
}

TEST_F(NoteTest, IsNotMadeOfOtherTypesNorOfFailedMeshes) {
  std::vector<Completion> done = run({request(1, kPlain), request(2, kLying)});
  ASSERT_EQ(done.size(), 2u);
  EXPECT_TRUE(done[0].ok);
  EXPECT_FALSE(done[1].ok);
  EXPECT_FALSE(done[0].note.has_value() || done[1].note.has_value());
  EXPECT_EQ(made, 0);
  land(done, cache, nullptr);
  EXPECT_FALSE(cache.get(done[0].handle)->note.has_value());

  options.annotate = {};
  done = run({request(3)});
  EXPECT_TRUE(done[0].ok);
  EXPECT_FALSE(done[0].note.has_value());
}

TEST_F(NoteTest, AHookThatThrowsFailsItsRequestOnly) {
  options.annotate[kNoted] = [](const Request& asked, const models::MeshView&) {
    if (asked.owner == 1) throw std::bad_alloc();
    return std::any(asked.owner);
  };
  std::vector<Completion> done = run({request(1), request(2)});
  ASSERT_EQ(done.size(), 2u);
  EXPECT_FALSE(done[0].ok);
  EXPECT_NE(done[0].error.find("annotation"), std::string::npos);
  EXPECT_FALSE(done[0].note.has_value());
  EXPECT_TRUE(done[1].ok);
  EXPECT_EQ(land(done, cache, nullptr).failed, 1u);
  EXPECT_EQ(cache.get(done[0].handle)->state, MeshState::kFailed);
}

// Destinations may be slow to read: the hook sees the mesh in other memory, and the destination
// receives the same bytes.
TEST_F(NoteTest, IsMadeBeforeTheMeshIsCopiedToItsDestination) {
  std::vector<const std::byte*> places;
  const Annotate annotate = options.annotate[kNoted];
  options.annotate[kNoted] = [&](const Request& r, const models::MeshView& mesh) {
    places.push_back(mesh.vertices.data());
    EXPECT_EQ(mesh.vertices.size(), r.destination.vertices.size());
    EXPECT_EQ(mesh.indices.size(), r.destination.indices.size());
    return annotate(r, mesh);
  };
  const std::vector<Request> plan = {request(1), request(2)};
  const std::vector<Completion> done = run(plan);
  ASSERT_EQ(done.size(), 2u);
  ASSERT_EQ(places.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NE(places[i], plan[i].destination.vertices.data());
    const auto alone = HeapDestination::make(registry[kNoted], plan[i].parameters, 0);
    ASSERT_TRUE(synthesise_guarded(registry[kNoted], plan[i].parameters, 0, alone->view()).ok);
    EXPECT_EQ(content_hash(plan[i].key, plan[i].destination),
              content_hash(plan[i].key, alone->view()));
    EXPECT_EQ(seen(done[i].note)->hash, done[i].content_hash);
  }
}

TEST_F(NoteTest, ArrivesWithItsMeshAndIsAvailableAtEveryHit) {
  const MeshHandle handle = add(1);
  const auto p = parameters_of(1, 80);
  EXPECT_EQ(cache.look_up(key_of(1, p)), handle);
  cache.adopt(handle, 7, hole(2));
  EXPECT_EQ(seen(cache.get(handle)->note), last.lock().get());
  EXPECT_EQ(made, 1);
}

TEST_F(NoteTest, EndsWithItsMesh) {
  cache.set_rank(add(1), Rank::unwanted());
  const auto evicted = last;
  const MeshHandle released = add(2);
  const auto gone = last;
  add(3);
  const auto kept = last;
  for (std::uint32_t i = 4; i <= 5; ++i)
    ASSERT_TRUE(request(i).handle);
  EXPECT_EQ(cache.take_evictions().size(), 1u);
  EXPECT_TRUE(evicted.expired());
  EXPECT_FALSE(gone.expired());
  cache.release(released);
  EXPECT_TRUE(gone.expired());
  EXPECT_FALSE(kept.expired());
}

TEST_F(NoteTest, EndsWithTheCache) {
  auto note = std::make_shared<const Seen>();
  last = note;
  {
    GeometryCache other(memory, registry, 4 * kMeshBytes);
    const auto p = parameters_of(1, 80);
    other.complete(*other.reserve(key_of(1, p), p, 1, hole(1)), {}, std::any(std::move(note)));
    EXPECT_FALSE(last.expired());
  }
  EXPECT_TRUE(last.expired());
}

// Its owner released it, or the reservation was cancelled.
TEST_F(NoteTest, EndsAtArrivalIfItsMeshIsNoLongerWanted) {
  std::vector<Completion> done = run({request(1)});
  cache.release(done[0].handle);
  EXPECT_FALSE(last.expired());
  EXPECT_EQ(land(done, cache, nullptr).ready, 0u);
  EXPECT_TRUE(last.expired());

  done = run({request(2)});
  cache.cancel(done[0].handle);
  EXPECT_EQ(land(done, cache, nullptr).ready, 0u);
  done.clear();
  EXPECT_TRUE(last.expired());
}

// By then the objects that the hook refers to may be destroyed.
TEST_F(NoteTest, IsNotMadeForAnAbandonedRequest) {
  std::atomic<double> now{100};
  options.watchdog_seconds = 10;
  options.clock = [&now] { return now.load(); };
  SynthesisManager manager(registry, options);
  const Request asked = request(99);
  std::ranges::fill(asked.destination.vertices, std::byte{0xAA});
  manager.publish({asked});
  gate.await(1);
  now = 200;
  std::vector<Completion> done;
  manager.collect(done);
  ASSERT_EQ(done.size(), 1u);
  EXPECT_TRUE(done[0].abandoned);
  gate.open();
  while (manager.collect(done) == 0)
    std::this_thread::yield();
  ASSERT_EQ(done.size(), 2u);
  EXPECT_TRUE(done[1].late);
  EXPECT_FALSE(done[0].note.has_value() || done[1].note.has_value());
  EXPECT_EQ(made, 0);
  const auto untouched = [](std::byte byte) { return byte == std::byte{0xAA}; };
  EXPECT_TRUE(std::ranges::all_of(asked.destination.vertices, untouched));
  while (!manager.hung().empty())
    manager.collect(done);
}

}  // namespace
}  // namespace psygen::synthesis
