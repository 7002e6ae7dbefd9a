// Adds the values of the other sources; each has its own private names.
int first();
int second();
int third();
int other();

int main() {
  return first() + second() + third() + other() == 1234 ? 0 : 1;
}
