// expect: the first of two
static_assert(sizeof(int) == 1, "the first of two");
static_assert(sizeof(int) == 2, "the second of two");
int main() {}
