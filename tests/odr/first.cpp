// Includes everything, as second.cpp does: the two link only if every definition is a template or inline.
#include <delassus/delassus.hpp>

int second();

int main() { return second(); }
