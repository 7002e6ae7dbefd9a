// A program that meets one fault, named by its argument, under the guards of program::run().
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <latch>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/log.hpp"
#include "engine/program/program.hpp"

namespace psygen::program {
namespace {

using Body = core::Result<void> (*)(const std::string& argument);

core::Result<void> allocate(const std::string&) {
  std::vector<char> bytes(std::size_t{1} << 46);
  return core::fail(core::ErrorCode::kInternal, std::to_string(bytes.size()));
}

core::Result<void> print_much(const std::string&) {
  for (int i = 0; i < 1000; ++i) {
    if (print(std::string(1000, 'x')) != kOk)
      return core::fail(core::ErrorCode::kIo, "the output was not printed");
  }
  return {};
}

core::Result<void> write_much(const std::string& file) {
  std::ofstream out(file);
  out << std::string(1 << 20, 'x') << std::flush;
  if (out) return {};
  return core::fail(core::ErrorCode::kIo, file + ": cannot be written");
}

// Fills a frame of 4 MiB on this thread and on a new one.
void use_stack() {
  volatile char frame[std::size_t{4} << 20];
  for (std::size_t i = 0; i < sizeof(frame); i += 1024)
    frame[i] = 'x';
}

// Ends by a stack overflow.
[[gnu::noinline]] int recurse(int depth) {
  volatile char frame[4096];
  frame[0] = static_cast<char>(depth);
  return depth < 0 ? 0 : recurse(depth + 1) + frame[0];
}

core::Result<void> read_at_8() {
  volatile std::uintptr_t address = 8;
  return core::fail(core::ErrorCode::kInternal,
                    std::to_string(*reinterpret_cast<const volatile char*>(address)));
}

// Two threads that crash at the same time.
core::Result<void> crash_twice() {
  std::latch both(2);
  const auto crash = [&both] {
    both.arrive_and_wait();
    std::abort();
  };
  std::thread other(crash);
  crash();
  other.join();
  return {};
}

const std::map<std::string, Body> kFaults{
    {"read",
     [](const std::string&) {
       for (int i = 0; i < 100; ++i)
         core::log_info("line " + std::to_string(i));
       return read_at_8();
     }},
    {"abort", [](const std::string&) -> core::Result<void> { std::abort(); }},
    {"abort in two threads", [](const std::string&) { return crash_twice(); }},
    {"raise",
     [](const std::string& number) -> core::Result<void> {
       (void)std::raise(std::stoi(number));
       return {};
     }},
    {"overflow",
     [](const std::string&) -> core::Result<void> {
       return core::fail(core::ErrorCode::kInternal, std::to_string(recurse(0)));
     }},
    {"overflow in a thread",
     [](const std::string&) {
       auto thread = core::start_thread([] { (void)recurse(0); });
       return std::move(thread).map([](std::thread started) { started.join(); });
     }},
    {"throw in a thread",
     [](const std::string& text) -> core::Result<void> {
       std::thread([&text] { throw std::runtime_error(text); }).join();
       return {};
     }},
    {"allocate", allocate},
    {"allocate in a thread",
     [](const std::string& argument) -> core::Result<void> {
       std::thread([&] { (void)allocate(argument); }).join();
       return {};
     }},
    {"print", print_much},
    {"write", write_much},
    {"use 4 MiB of stack",
     [](const std::string&) -> core::Result<void> {
       use_stack();
       std::thread(use_stack).join();
       return {};
     }},
    {"throw",
     [](const std::string& text) -> core::Result<void> { throw std::runtime_error(text); }},
    {"throw a number", [](const std::string&) -> core::Result<void> { throw 7; }},
    {"fail",
     [](const std::string& text) -> core::Result<void> {
       return core::fail(core::ErrorCode::kIo, text);
     }},
    {"no device",
     [](const std::string&) -> core::Result<void> {
       return core::fail(core::ErrorCode::kNoDevice, "no device");
     }},
    {"interrupted",
     [](const std::string&) -> core::Result<void> {
       return core::fail(core::ErrorCode::kInterrupted, "closed");
     }},
    {"signal",
     [](const std::string&) -> core::Result<void> {
       const std::atomic<bool>& stop = stop_at_interrupt();
       (void)std::raise(SIGTERM);
       return stop ? core::Result<void>() : core::fail(core::ErrorCode::kInternal, "no signal");
     }},
};

}  // namespace
}  // namespace psygen::program

int main(int argc, char** argv) {
  // A handler of the program's own, which no report replaces.
  if (std::getenv("OWN_HANDLER") != nullptr) std::signal(SIGABRT, [](int) { std::_Exit(7); });
  return psygen::program::run("guarded", [&] {
    return psygen::program::kFaults.at(argc > 1 ? argv[1] : "")(argc > 2 ? argv[2] : "");
  });
}
