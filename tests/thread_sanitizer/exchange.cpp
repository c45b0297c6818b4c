// Two threads and a triple buffer, built with -fsanitize=thread, which tells of a data race. A program of its own: it
// says what it counted and returns 1 when something went wrong.
#include <delassus/listeners/triple_buffer.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <thread>

using namespace delassus;

namespace {

// In the first million every message is met by a read, and both threads are interrupted in the middle of their work, on
// one core too; in the second million they run free. Beside other programs a turn takes as long as those are given: after
// twenty seconds the threads run free as well.
constexpr std::uint64_t exchanges = 2'000'000;
std::atomic<std::uint64_t> in_turn{exchanges / 2};

/// Sixteen words that belong together.
using Message = std::array<std::uint64_t, 16>;

/// Not seen by the sanitizer as an agreement between the threads.
bool is_in_turn(std::uint64_t k) { return k < in_turn.load(std::memory_order_relaxed); }
void give_way(bool now) {
  if (now) std::this_thread::yield();
}

}  // namespace

int main() {
  TripleBuffer<Message> there, back;
  std::atomic<std::uint64_t> last_published{0};

  std::thread writer([&] {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (std::uint64_t k = 1; k <= exchanges; ++k) {
      if (is_in_turn(k) && k % 1024 == 0 && std::chrono::steady_clock::now() > patience)
        in_turn.store(k, std::memory_order_relaxed);
      Message& message = there.back();
      for (int w = 0; w < 16; ++w) {
        give_way(is_in_turn(k) && k % 32 == 0 && w == int(k / 32 % 16));
        message[w] = k;
      }
      there.publish();
      last_published.store(k, std::memory_order_release);
      back.fetch();
      give_way(is_in_turn(k));
    }
  });

  std::uint64_t reads = 0, fresh = 0, torn = 0, missed = 0, backward = 0, last = 0;
  while (last < exchanges) {
    const std::uint64_t at_least = last_published.load(std::memory_order_acquire);
    fresh += there.fetch();
    ++reads;
    Message& message = there.front();
    for (int w = 0; w < 16; ++w) {
      give_way(is_in_turn(last) && reads % 32 == 0 && w == int(reads / 32 % 16));
      torn += message[w] != message[0];
    }
    missed += message[0] < at_least;
    backward += message[0] < last;
    last = message[0];
    back.back() = message;
    back.publish();
    give_way(is_in_turn(last));
  }
  writer.join();
  back.fetch();
  const bool is_last_there = back.front()[0] == exchanges;

  std::printf("%llu published, %llu reads, %llu of them new; torn %llu, missed %llu, backward %llu\n",
              (unsigned long long)exchanges, (unsigned long long)reads, (unsigned long long)fresh,
              (unsigned long long)torn, (unsigned long long)missed, (unsigned long long)backward);
  return torn + missed + backward == 0 && fresh >= 1000 && is_last_there ? 0 : 1;
}
