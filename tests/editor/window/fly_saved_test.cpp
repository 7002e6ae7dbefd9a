// Edits a species in the window and saves it; the game renders the result.
#include <QFile>
#include <QJsonDocument>
#include <QJsonObject>
#include <QProcess>

#include "editor/flights/flight_process.hpp"
#include "editor/panels/field_row.hpp"
#include "tests/editor/window/oak_fixture.hpp"

namespace psygen::editor {
namespace {

// The summary of a short flight through the world of a file.
QJsonObject flown(const std::filesystem::path& world, const std::filesystem::path& out) {
  QProcess flight;
  flight.start(psygen_program(),
               {"fly", "--headless", "--world", QString::fromStdString(world.string()), "--frames",
                "20", "--fixed-step", "30", "--size", "160x90", "--preset", "low",
                "--view-distance", "200", "--out", QString::fromStdString(out.string())});
  EXPECT_TRUE(flight.waitForFinished(600'000));
  EXPECT_EQ(flight.exitStatus(), QProcess::NormalExit);
  EXPECT_EQ(flight.exitCode(), 0) << flight.readAllStandardError().toStdString();
  QFile summary(QString::fromStdString((out / "summary.json").string()));
  EXPECT_TRUE(summary.open(QIODevice::ReadOnly));
  return QJsonDocument::fromJson(summary.readAll()).object();
}

using FlySaved = OakInWindow;

TEST_F(FlySaved, TheGameRendersTheSpeciesThatWasEdited) {
  const world::TextPath species{"species", 0}, size{"species", 0, "size_m"};
  const QJsonObject before = flown(file_, folder_.path() / "before");
  properties().go_to(species);
  ASSERT_NE(properties().row(size), nullptr);
  const double small_m = document().field(size)->numbers[0];
  drag(*properties().row(size)->findChild<QSlider*>(), 30);
  const double large_m = document().field(size)->numbers[0];
  EXPECT_GT(large_m, small_m);
  settle();
  QTest::keyClick(window_.get(), Qt::Key_S, Qt::ControlModifier);
  ASSERT_TRUE(QTest::qWaitFor([&] { return !window_->isWindowModified(); }, kMaxMs));
  const QJsonObject after = flown(file_, folder_.path() / "after");
  const auto hash = [](const QJsonObject& summary) {
    return summary["hash"].toObject()["world"].toString();
  };
  EXPECT_FALSE(hash(before).isEmpty());
  EXPECT_NE(hash(after), hash(before)) << "other trees stand in the world that was flown";
  // The game has read the edited world, and the window shows the same world.
  const auto saved = parse_world_text(document().text(), file_.string(), {});
  ASSERT_TRUE(saved.has_value());
  EXPECT_DOUBLE_EQ((*saved)->world.species[0].size_m, large_m);
  EXPECT_EQ(shown(), (*saved)->world);
  // The file gives the same world again.
  EXPECT_EQ(hash(flown(file_, folder_.path() / "again")), hash(after));
}

}  // namespace
}  // namespace psygen::editor
