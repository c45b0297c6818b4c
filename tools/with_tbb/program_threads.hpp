/// What `--threads` of a program names, where oneTBB is there.
#pragma once

#include <delassus/adapters/tbb.hpp>

/// `count` threads; 0: one a processor.
inline delassus::Threads program_threads(int count) { return delassus::Threads{count}; }
