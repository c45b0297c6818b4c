// The laws and the body set of loop/users_laws.cpp in a program that compiles all itself: nothing of `delassus::compiled`.
#include "loop/users_laws.cpp"
