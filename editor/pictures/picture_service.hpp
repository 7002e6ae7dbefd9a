// The editor's side of the drawing process: starts it when there is something to draw, gives it one
// request at a time, and starts it anew when a world has ended it. The newest batch of requests is
// served first, within it the lowest rank. Main thread; it never waits.
#pragma once

#include <QObject>
#include <QPointer>
#include <QProcess>
#include <QStringList>
#include <QTemporaryDir>
#include <QTimer>
#include <deque>
#include <functional>
#include <memory>

#include "editor/pictures/picture_request.hpp"
#include "engine/handmade/files.hpp"

namespace psygen::editor {

class PictureService final : public QObject {
  Q_OBJECT

 public:
  using Done = std::function<void(const PictureReply&)>;

  // `program` with `arguments` is a process that calls render_pictures(). `limit_ms`: one that
  // works longer than that on a picture is ended; exports may take ten times as long.
  PictureService(QString program, QStringList arguments, QObject* parent = nullptr,
                 int limit_ms = 30'000);
  ~PictureService() override;

  // A number for requests that belong together; larger than all before.
  int new_batch() { return ++last_batch_; }
  // Asks for something. `done` is called once, later, unless its owner is gone or the request was
  // cancelled. Pictures get a file of their own where `out` is empty, and come as an image.
  void ask(PictureRequest request, int batch, double rank, QObject* owner, Done done);
  // Forgets what an owner has asked for.
  void cancel(const QObject* owner);
  // What is painted and not written, asked for with each request; its answer may be null.
  void set_pictures(std::function<handmade::MemoryPicturesPtr()> ask) {
    ask_pictures_ = std::move(ask);
  }
  // The view waits for meshes: pictures wait too, but for no longer than a second. Costs and
  // exports do not.
  void set_busy(bool busy);
  // Requests that are not answered.
  std::size_t waiting() const { return queue_.size() + (current_ ? 1 : 0); }
  // How often the process has ended by itself or had to be ended.
  int restarts() const { return restarts_; }

 private:
  struct Job {
    PictureRequest request;
    int batch = 0;
    double rank = 0;
    QPointer<QObject> owner;
    Done done;
    bool cancelled = false;
  };
  static bool is_picture(const PictureRequest& request);
  void attach_pictures(PictureRequest& request);
  void send_next();
  void start();
  void read();
  void take(const PictureReply& reply);
  void fail(const QString& why);
  void ended();

  QString program_;
  QStringList arguments_;
  int limit_ms_;
  std::unique_ptr<QProcess> process_;
  QTemporaryDir folder_;
  std::function<handmade::MemoryPicturesPtr()> ask_pictures_;
  std::deque<Job> queue_;
  std::optional<Job> current_;
  int unanswered_ = 0;  // requests that the process has; more than one: current_ has replaced one
  QByteArray input_;
  QTimer limit_, patience_;
  int overdue_ = 0;              // limits that have passed
  double worked_before_ms_ = 0;  // by the process, when it got the request
  bool busy_ = false, patient_ = true;
  int last_batch_ = 0;
  std::uint64_t last_id_ = 0;
  int restarts_ = 0;
};

}  // namespace psygen::editor
