// Renders a flight along a path with `psygen` in another process of lowest priority. Main thread.
#pragma once

#include <QObject>
#include <QProcess>
#include <filesystem>

#include "editor/flights/flight_run.hpp"

namespace psygen::editor {

// One process at a time.
class FlightProcess final : public QObject {
  Q_OBJECT

 public:
  explicit FlightProcess(QObject* parent = nullptr);
  // Ends a running flight.
  ~FlightProcess() override;

  // Starts a flight; flown() or failed() follows. Does nothing while a flight runs.
  void fly(const FlightSettings& settings, const std::filesystem::path& world,
           const std::filesystem::path& path, const std::filesystem::path& out);
  void cancel();
  bool is_flying() const { return process_.state() != QProcess::NotRunning; }

 Q_SIGNALS:
  // The result of a flight, or its error.
  void flown(const psygen::editor::FlightRun& run);
  void failed(const QString& error);

 private:
  void finish(int code, QProcess::ExitStatus status);

  QProcess process_;
  FlightSettings settings_;
  std::filesystem::path out_;
  bool cancelled_ = false;
};

// The program `psygen`: from the folder of this program, else from the system's search path.
QString psygen_program();

}  // namespace psygen::editor
