// Modelers on a virtual clock: who claims which request, and when it is finished, follows from what
// is predicted of the requests and from nothing else. So a schedule is the same on any machine and
// for any number of threads, and a test that judges what modelers had time for judges the same
// everywhere. Executes nothing: the manager does, once a request is finished by this clock. Main
// thread. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// Modelers of a virtual clock, all free at 0 s.
class VirtualModelers {
 public:
  // A request that a modeler claimed, and from when to when it works on it.
  struct Job {
    Request request;
    std::uint32_t modeler = 0;
    double started_s = 0, finished_s = 0;
  };

  // This many modelers, all free at time 0.
  explicit VirtualModelers(unsigned modelers) : free_s_(modelers, 0.0) {}

  // Publishes a plan at `now_s`. Requires that the last one was reclaimed.
  void publish(std::vector<Request>&& plan, double now_s);
  // What is unclaimed at `now_s`, in order. Times never go back.
  std::vector<Request> reclaim(double now_s);
  // What is finished at `now_s`, in the order of finishing.
  std::vector<Job> take_finished(double now_s);
  // Everything that was published, whatever it takes; from then on all modelers are free at
  // `now_s`.
  std::vector<Job> finish_all(double now_s);

  // How many modelers there are, and how many requests are not finished.
  unsigned count() const { return static_cast<unsigned>(free_s_.size()); }
  std::size_t outstanding() const { return plan_.size() - next_ + running_.size(); }

 private:
  void claim_until(double now_s);

  std::vector<double> free_s_;  // by modeler: when it is done with what it claimed
  std::vector<Request> plan_;
  std::size_t next_ = 0;  // of plan_, the first unclaimed one
  double published_s_ = 0;
  std::vector<Job> running_;
};

}  // namespace psygen::synthesis
