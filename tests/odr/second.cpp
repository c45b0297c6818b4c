#include <delassus/delassus.hpp>

int second();

int second() { return 0; }
