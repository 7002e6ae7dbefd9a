// Preloaded into programs that run under valgrind (instruction_count.cpp). While it is loaded, the
// library of SIMD kernels measures how finely the processor's clock counts, by an instruction that
// valgrind does not know on some processors, and the program ends with SIGILL. Nothing of ours uses
// that figure. The loader takes this function instead.
namespace hwy::platform {

double TimerResolution();
double TimerResolution() {
  return 1e-9;  // s
}

}  // namespace hwy::platform
