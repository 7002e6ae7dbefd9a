// The editor's side of the rendering process: starts it for the first request, sends it one request
// at a time, and restarts it after a crash. Serves the newest batch of requests first, and within
// it the lowest rank. Main thread; never blocks.
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

// One process at a time.
class PictureService final : public QObject {
  Q_OBJECT

 public:
  // Receives the reply of a request.
  using Done = std::function<void(const PictureReply&)>;

  // `program` with `arguments` starts a process that calls render_pictures(). The service ends a
  // process that works on an image for longer than `limit_ms`; exports may take ten times as long.
  PictureService(QString program, QStringList arguments, QObject* parent = nullptr,
                 int limit_ms = 30'000);
  ~PictureService() override;

  // A number for requests that belong together; larger than all previous ones.
  int new_batch() { return ++last_batch_; }
  // Queues a request. Calls `done` once, later, unless the owner was destroyed or the request
  // cancelled. Images with an empty `out` get a temporary file; the reply contains the image.
  void ask(PictureRequest request, int batch, double rank, QObject* owner, Done done);
  // Cancels the requests of an owner.
  void cancel(const QObject* owner);
  // Sets a function that returns the unsaved images for each request; it may return null.
  void set_pictures(std::function<handmade::MemoryPicturesPtr()> ask) {
    ask_pictures_ = std::move(ask);
  }
  // Delays images, for at most a second each, while the view waits for meshes. Costs and exports
  // are not delayed.
  void set_busy(bool busy);
  // Number of requests without a reply.
  std::size_t waiting() const { return queue_.size() + (current_ ? 1 : 0); }
  // Number of times that the process crashed or was ended.
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
  void take(PictureReply reply);
  void ended();

  QString program_;
  QStringList arguments_;
  int limit_ms_;
  std::unique_ptr<QProcess> process_;
  QTemporaryDir folder_;
  std::function<handmade::MemoryPicturesPtr()> ask_pictures_;
  std::deque<Job> queue_;
  std::optional<Job> current_;
  int unanswered_ = 0;  // requests in the process; more than one if current_ has replaced one
  QByteArray input_;
  QTimer limit_, patience_;
  int overdue_ = 0;              // number of limits that have passed
  double worked_before_ms_ = 0;  // processor time of the process at the start of the request
  bool busy_ = false, patient_ = true;
  int last_batch_ = 0;
  std::uint64_t last_id_ = 0;
  int restarts_ = 0;
};

}  // namespace psygen::editor
