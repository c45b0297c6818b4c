/// What listeners keep for other threads, in the types of their loop.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/solvers/problem.hpp>
#include <delassus/step/row_types.hpp>

#include <memory>
#include <tuple>
#include <type_traits>

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

/// Each on the heap: other threads hold references to them while the loop may move.
template <class Problem, class... Publishers>
class Channels {
 public:
  explicit Channels([[maybe_unused]] const auto& policies)
      : channels_{std::make_unique<typename Publishers::template Channel<Problem>>(std::get<Publishers>(policies))...} {}

  template <class P>
  auto& of() const {
    return *std::get<std::unique_ptr<typename P::template Channel<Problem>>>(channels_);
  }

 private:
  [[no_unique_address]] std::tuple<std::unique_ptr<typename Publishers::template Channel<Problem>>...> channels_;
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
