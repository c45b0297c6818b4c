// What delassus/compiled.hpp leaves out, compiled once for all files of a program.
#include <delassus/compile_here.hpp>
