/// What listeners keep for other threads, in the types of their loop.
#pragma once

#include <delassus/core/pack.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/solvers/problem.hpp>
#include <delassus/step/row_types.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {

/// A listener that hands constraint problems to another thread says `template <class Problem> class Channel;`, built from
/// the listener, and `template <class Problem> static consteval bool can_publish();`, which speaks when it cannot.
template <class P>
concept Publisher = Plays<P, role::Listener> && requires { typename P::template Channel<Problem<int, int, int>>; };

namespace inner {

/// The constraint problem of a loop; void where there are no constraints.
template <class Policies>
struct problem_of {
  using Rows = typename rows_of<typename Policies::World, typename Policies::Laws>::type;
  using type = Problem<typename Policies::Laws, Rows, typename Policies::Compliance::template Operator<Rows>>;
};
template <class Policies>
  requires(Policies::Laws::pool_count == 0)
struct problem_of<Policies> {
  using type = void;
};

/// A T on the heap, so that it stays where it is when its owner moves. A copy is as new: another thread may use this one.
template <class T, class From>
class OnHeap {
 public:
  explicit OnHeap(const From& from) : at_(new Made(from)) {}
  OnHeap(const OnHeap& other) : OnHeap(other.at_->from) {}
  OnHeap(OnHeap&& other) noexcept : at_(other.at_) { other.at_ = nullptr; }
  OnHeap& operator=(OnHeap&& other) noexcept {
    std::swap(at_, other.at_);
    return *this;
  }
  ~OnHeap() { delete at_; }
  T& operator*() const { return at_->it; }

 private:
  struct Made {
    explicit Made(const From& by) : from(by), it(by) {}
    const From from;
    T it;
  };
  Made* at_;
};

/// Other threads hold references to them while the loop may move. Those of a copy are its own, and empty.
template <class Problem, class... Publishers>
class Channels {
 public:
  explicit Channels([[maybe_unused]] const auto& policies)
      : channels_{{Held<Publishers>(part_of_type<Publishers>(policies))}...} {}

  template <class P>
  auto& of() const {
    return *part_of_type<Held<P>>(channels_);
  }

 private:
  template <class P>
  using Held = OnHeap<typename P::template Channel<Problem>, P>;
  Pack<Held<Publishers>...> channels_;
};
template <class Problem>
class Channels<Problem> {
 public:
  [[gnu::always_inline]] explicit Channels(const auto&) {}
};

/// The channels of the publishers among `Policies`.
template <class Problem, class... Args>
struct channels_of {
  template <class... P>
  static Channels<Problem, P...> gather(const std::tuple<std::type_identity<P>...>*);
  template <class P>
  using one = std::conditional_t<Publisher<P>, std::tuple<std::type_identity<P>>, std::tuple<>>;
  using type = decltype(gather(static_cast<decltype(std::tuple_cat(one<Args>{}...))*>(nullptr)));
};

}  // namespace inner
}  // namespace delassus
