int third();

namespace {

constexpr int kValues = 30;

}  // namespace

int third() {
  return kValues;
}
