#include "tests/engine/synthesis/waits.hpp"

#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdarg>

#include "tests/next_function.hpp"

namespace {

using psygen::next;

thread_local std::uint64_t waits = 0;

}  // namespace

namespace psygen::synthesis::testing {

std::uint64_t waits_of_this_thread() {
  return waits;
}

}  // namespace psygen::synthesis::testing

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static const auto real = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  ++waits;
  return real(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  static const auto real = next<int(pthread_mutex_t*)>("pthread_mutex_trylock");
  ++waits;
  return real(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  static const auto real = next<int(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  ++waits;
  return real(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  static const auto real = next<int(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  ++waits;
  return real(lock);
}
int pthread_spin_lock(pthread_spinlock_t* lock) noexcept {
  static const auto real = next<int(pthread_spinlock_t*)>("pthread_spin_lock");
  ++waits;
  return real(lock);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  static const auto real = next<int(pthread_cond_t*, pthread_mutex_t*)>("pthread_cond_wait");
  ++waits;
  return real(condition, mutex);
}
int sem_wait(sem_t* semaphore) {
  static const auto real = next<int(sem_t*)>("sem_wait");
  ++waits;
  return real(semaphore);
}
int sched_yield() noexcept {
  static const auto real = next<int()>("sched_yield");
  ++waits;
  return real();
}
// Reads as many arguments as any call can have, like the C library's function.
__attribute__((no_sanitize_address)) long syscall(long number, ...) noexcept {
  static const auto real = next<long(long, ...)>("syscall");
  va_list list;
  va_start(list, number);
  long a[6];
  for (long& argument : a)
    argument = va_arg(list, long);
  va_end(list);
  if (number == SYS_futex) ++waits;
  return real(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

}  // extern "C"
