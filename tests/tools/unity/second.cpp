#include <array>
#include <cstddef>

int second();

namespace {

// The same types of parameters, by other names.
int sum_of(const std::array<int, 2>&, std::size_t) {
  return 0;
}

struct Corner {
  int y = 200;
};

}  // namespace

int second() {
  return sum_of({}, 0) + Corner{}.y;
}
