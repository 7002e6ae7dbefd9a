#include <array>

int other();

namespace {

using Numbers = std::array<int, 2>;  // with the same meaning

int sum_of(int a, int b) {
  return a + b;
}  // an overload

}  // namespace

int other() {
  return sum_of(Numbers{3, 1}[0], 1);
}
