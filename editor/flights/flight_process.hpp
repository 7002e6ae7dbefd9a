// Flies a path with `psygen` in another process, which gives way to everything else. Main thread.
#pragma once

#include <QObject>
#include <QProcess>
#include <filesystem>

#include "editor/flights/flight_run.hpp"

namespace psygen::editor {

class FlightProcess final : public QObject {
  Q_OBJECT

 public:
  explicit FlightProcess(QObject* parent = nullptr);
  // Ends a flight that is under way.
  ~FlightProcess() override;

  // Flies; flown() or failed() follow. One at a time.
  void fly(const FlightSettings& settings, const std::filesystem::path& world,
           const std::filesystem::path& path, const std::filesystem::path& out);
  void cancel();
  bool is_flying() const { return process_.state() != QProcess::NotRunning; }

 Q_SIGNALS:
  void flown(const psygen::editor::FlightRun& run);
  void failed(const QString& sentence);

 private:
  void finish(int code, QProcess::ExitStatus status);

  QProcess process_;
  FlightSettings settings_;
  std::filesystem::path out_;
  bool cancelled_ = false;
};

// The program `psygen`: beside this one, else where the system finds it.
QString psygen_program();

}  // namespace psygen::editor
