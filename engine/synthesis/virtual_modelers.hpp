// Modelers on a virtual clock: predictions alone determine which modeler claims a request and when
// it finishes. A schedule is therefore the same on any machine and for any number of threads, and
// so are tests that depend on it. Executes nothing: the manager executes a request once this clock
// has finished it. Main thread. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// Modelers of a virtual clock, all free at 0 s.
class VirtualModelers {
 public:
  // A claimed request, and the time span in which its modeler works on it.
  struct Job {
    Request request;
    std::uint32_t modeler = 0;
    double started_s = 0, finished_s = 0;
  };

  // Creates this number of modelers, all free at time 0.
  explicit VirtualModelers(unsigned modelers) : free_s_(modelers, 0.0) {}

  // Publishes a plan at `now_s`. Requires that the previous one was reclaimed.
  void publish(std::vector<Request>&& plan, double now_s);
  // Returns the requests unclaimed at `now_s`, in order. Times never decrease.
  std::vector<Request> reclaim(double now_s);
  // Returns the requests finished at `now_s`, in the order of finishing.
  std::vector<Job> take_finished(double now_s);
  // Finishes every published request, however long it takes; then all modelers are free at `now_s`.
  std::vector<Job> finish_all(double now_s);

  // Number of modelers, and number of unfinished requests.
  unsigned count() const { return static_cast<unsigned>(free_s_.size()); }
  std::size_t outstanding() const { return plan_.size() - next_ + running_.size(); }

 private:
  void claim_until(double now_s);

  std::vector<double> free_s_;  // by modeler: when it finishes its claimed requests
  std::vector<Request> plan_;
  std::size_t next_ = 0;  // of plan_, the first unclaimed one
  double published_s_ = 0;
  std::vector<Job> running_;
};

}  // namespace psygen::synthesis
