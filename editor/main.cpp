// The editor with the model types of psygen.
#include "editor/editor.hpp"

int main(int argc, char** argv) {
  return psygen::editor::run(argc, argv);
}
