// expect: what a reader hopes for
static_assert(sizeof(int) == 1, "what the compiler says");
int main() {}
