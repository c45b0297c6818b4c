/// Read before a program of one thread: its loops that name no execution run on as many threads as the
/// variable DELASSUS_TEST_THREADS says, and it prints a sum over the bits of all their states as it ends.
#pragma once

#include <delassus/adapters/tbb.hpp>
#include <delassus/delassus.hpp>
#include <delassus/io/state_hash.hpp>
#include <delassus/rows/alive.hpp>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace delassus {

namespace inner {

/// Steps may end on several threads at once, in any order.
struct StepsOfProgram {
  std::atomic<std::uint64_t> sum = 0;
  std::atomic<long> count = 0;
  ~StepsOfProgram() { std::printf("%ld steps, bits %016llx\n", count.load(), static_cast<unsigned long long>(sum.load())); }
};
inline StepsOfProgram steps_of_program;

inline int threads_of_test() {
  const char* const word = std::getenv("DELASSUS_TEST_THREADS");
  return word ? std::atoi(word) : 1;
}

}  // namespace inner

/// Threads that sum the bits that each step begins with.
struct ThreadsOfTest : Threads {
  ThreadsOfTest() : Threads(inner::threads_of_test()) {}

  template <class Base>
  struct stages : Threads::stages<Base> {
    static void begin(auto& step, double h) {
      Threads::stages<Base>::begin(step, h);
      inner::Fingerprint print;
      step.world().each([&](const auto& set, auto) {
        for (const Index b : alive(set)) {
          const auto pose = set.pose(b);
          const auto& v = set.velocity()[b];
          print.bytes(pose.position.data(), sizeof(double) * 3);
          print.bytes(v.data(), sizeof(v[0]) * std::size_t(v.size()));
        }
      });
      inner::steps_of_program.sum += print.value;
      ++inner::steps_of_program.count;
    }
  };
};

/// A loop with them, unless it names threads itself.
template <class... P>
auto loop_on_threads(P... policies) {
  if constexpr ((Plays<P, role::Execution> || ...)) return AnimationLoop{std::move(policies)...};
  else return AnimationLoop{std::move(policies)..., ThreadsOfTest{}};
}
template <class... P>
struct LoopOnThreads : decltype(loop_on_threads(std::declval<P>()...)) {
  using Base = decltype(loop_on_threads(std::declval<P>()...));
  explicit LoopOnThreads(P... policies) : Base(loop_on_threads(std::move(policies)...)) {}
};
template <class... P>
LoopOnThreads(P...) -> LoopOnThreads<P...>;

}  // namespace delassus

// From here on the program's loops are these.
#define AnimationLoop LoopOnThreads
