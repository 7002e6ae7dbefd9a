// The rendering process from end to end: this program, started with the hidden option.
#include "editor/pictures/picture_service.hpp"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QEventLoop>

#include "editor/pictures/model_world.hpp"
#include "editor/pictures/picture_server.hpp"
#include "tests/editor/pictures/worlds.hpp"

namespace psygen::editor {
namespace {

constexpr int kNoLimitMs = 10 * 60'000;

// A service that talks to this program, and a way to wait for its answers.
struct Serving {
  PictureService service{
      QCoreApplication::applicationFilePath(), {kPicturesOption}, nullptr, kNoLimitMs};
  QObject owner;

  void wait_for(const std::function<bool()>& done) {
    QEventLoop loop;
    while (!done())
      loop.processEvents(QEventLoop::WaitForMoreEvents);
  }
  PictureReply answer(PictureRequest request) {
    std::optional<PictureReply> reply;
    service.ask(std::move(request), service.new_batch(), 0, &owner,
                [&](const PictureReply& told) { reply = told; });
    wait_for([&] { return reply.has_value(); });
    return *reply;
  }
};

PictureRequest picture_of(std::string text, PictureKind kind = PictureKind::kPicture) {
  PictureRequest request;
  request.kind = kind;
  request.text = std::move(text);
  request.file = "test.toml";
  request.size = {96, 64};
  return request;
}

std::string faulty_world(int subdivisions) {
  return "format = 1\n[world]\nname = \"faulty\"\nseed = 1\nblocks = [0, 0]\n[[scatter]]\n"
         "model = \"faulty_rock\"\ncount = 4\nsubdivisions = " +
         std::to_string(subdivisions) + "\n";
}

bool has_colours(const QImage& image) {
  for (int x = 1; x < image.width(); ++x)
    if (image.pixel(x, image.height() / 2) != image.pixel(0, 0)) return true;
  return false;
}

TEST(PictureService, SeesUnsavedPaintedImages) {
  Serving s;
  PictureRequest request = picture_of(
      "format = 1\n[world]\nname = \"painted\"\nseed = 1\nblocks = [4, 4]\n[[scatter]]\n"
      "model = \"rock\"\ncount = 4\nmask_image = \"not_written.png\"\n",
      PictureKind::kCost);
  EXPECT_FALSE(s.answer(request).error.empty());
  for (const auto grey : {std::uint16_t{0}, std::uint16_t{65535}}) {
    auto mask = std::make_shared<world::GreyPicture>();
    mask->width = mask->height = 4;
    mask->pixels.assign(16, grey);
    mask->hash = world::content_hash(*mask);
    auto pictures = std::make_shared<handmade::InMemoryImages>();
    pictures->in_place["not_written.png"] = mask;
    s.service.set_pictures([pictures] { return pictures; });
    const PictureReply reply = s.answer(request);
    ASSERT_EQ(reply.error, "");
    EXPECT_EQ(reply.cost->models > 0, grey > 0);
  }
}

TEST(PictureService, RendersWorldsAndModelsWithTheirCosts) {
  Serving s;
  const PictureReply world = s.answer(picture_of(testing::world_text("endless")));
  EXPECT_EQ(world.error, "");
  ASSERT_EQ(world.image.size(), QSize(96, 64));
  EXPECT_TRUE(has_colours(world.image));
  ASSERT_TRUE(world.cost.has_value());
  EXPECT_GT(world.cost->triangles, 0);

  PictureRequest portrait = picture_of(*portrait_of(testing::world_text("lakes"), {"scatter", 1}),
                                       PictureKind::kPortrait);
  portrait.size = {80, 80};
  const PictureReply model = s.answer(portrait);
  EXPECT_EQ(model.error, "");
  EXPECT_EQ(model.image.size(), QSize(80, 80));

  PictureRequest cost = picture_of(testing::world_text("lakes"), PictureKind::kCost);
  const PictureReply costs = s.answer(cost);
  EXPECT_EQ(costs.error, "");
  EXPECT_TRUE(costs.cost.has_value());
  EXPECT_EQ(s.service.restarts(), 0);
}

TEST(PictureService, AWorldThatCrashesTheProcessFailsAloneAndTheNextOneIsRendered) {
  Serving s;
  EXPECT_EQ(s.answer(picture_of(faulty_world(2))).error, "");
  const PictureReply hostile = s.answer(picture_of(faulty_world(6)));
  EXPECT_NE(hostile.error.find("the rendering process crashed (signal 6)"), std::string::npos)
      << hostile.error;
  EXPECT_EQ(s.service.restarts(), 1);
  const PictureReply after = s.answer(picture_of(faulty_world(3)));
  EXPECT_EQ(after.error, "");
  EXPECT_EQ(after.image.size(), QSize(96, 64));
}

TEST(PictureService, AnInvalidTextIsRejectedWithTheErrorOfItsParser) {
  Serving s;
  const PictureReply reply = s.answer(picture_of(
      "format = 1\n[world]\nname = \"x\"\nseed = 1\nblocks = [0, 0]\n[sky]\nexposure = -4\n"));
  EXPECT_NE(reply.error.find("exposure"), std::string::npos) << reply.error;
  EXPECT_EQ(s.service.restarts(), 0);
}

TEST(PictureService, TheNewestBatchIsAnsweredFirstAndWithinItTheLowestRank) {
  Serving s;
  std::string order;
  const auto ask = [&](char name, int batch, double rank) {
    s.service.ask(picture_of(faulty_world(1)), batch, rank, &s.owner,
                  [&order, name](const PictureReply&) { order += name; });
  };
  const int old_batch = s.service.new_batch(), batch = s.service.new_batch();
  ask('d', old_batch, 0);
  ask('c', batch, 3);
  ask('a', batch, 1);
  ask('b', batch, 2);
  s.wait_for([&] { return order.size() == 4; });
  EXPECT_EQ(order, "abcd");
}

TEST(PictureService, CancelledRequestsGetNoReply) {
  Serving s;
  bool told = false;
  QObject other;
  s.service.ask(picture_of(testing::world_text("endless")), s.service.new_batch(), 0, &other,
                [&](const PictureReply&) { told = true; });
  QCoreApplication::processEvents();  // sends the request
  s.service.cancel(&other);
  EXPECT_EQ(s.answer(picture_of(faulty_world(1))).error, "");
  EXPECT_FALSE(told);
  EXPECT_EQ(s.service.waiting(), 0U);
}

TEST(PictureService, AProgramThatCannotBeStartedFailsTheRequest) {
  PictureService service("/nowhere/at/all", {}, nullptr, kNoLimitMs);
  QObject owner;
  std::string error;
  service.ask(picture_of("x"), service.new_batch(), 0, &owner,
              [&](const PictureReply& reply) { error = reply.error; });
  QEventLoop loop;
  while (error.empty())
    loop.processEvents(QEventLoop::WaitForMoreEvents);
  EXPECT_NE(error.find("cannot be started"), std::string::npos);
}

}  // namespace
}  // namespace psygen::editor
