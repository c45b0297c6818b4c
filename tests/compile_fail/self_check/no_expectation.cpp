static_assert(sizeof(int) == 1, "a sentence nobody announced");
int main() {}
