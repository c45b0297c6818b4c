/// Two ways to one result, timed turn by turn in one run: CPU time of the thread, medians, and their ratio.
#pragma once

#include <delassus/adapters/posix.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

namespace against {

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

template <class F>
double seconds(F&& f) {
  const double start = delassus::ThreadClock{}.now();
  f();
  return delassus::ThreadClock{}.now() - start;
}

/// The reported time is that of `ours`; counters: the time of `theirs` in ms, and how many times faster ours
/// is. Theirs runs before every `every`-th of ours.
template <class Ours, class Theirs>
void run(benchmark::State& state, Ours&& ours, Theirs&& theirs, int every = 1) {
  std::vector<double> our_times, their_times;
  int n = 0;
  ours();  // warm
  for (auto _ : state) {
    if (n++ % every == 0) their_times.push_back(seconds(theirs));
    our_times.push_back(seconds(ours));
    state.SetIterationTime(our_times.back());
  }
  state.counters["theirs_ms"] = 1e3 * median(their_times);
  state.counters["ours_ms"] = 1e3 * median(our_times);
  state.counters["times_faster"] = median(their_times) / median(our_times);
}

}  // namespace against
