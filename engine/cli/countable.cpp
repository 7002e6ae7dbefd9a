// Preloaded into programs that run under valgrind (compare_command.cpp). The library of SIMD
// kernels measures the resolution of the processor's clock when it is loaded. It uses an
// instruction that valgrind does not support on some processors, which would end the program with
// SIGILL. psygen does not use the result, so the loader takes this function instead.
namespace hwy::platform {

double TimerResolution();
double TimerResolution() {
  return 1e-9;  // s
}

}  // namespace hwy::platform
