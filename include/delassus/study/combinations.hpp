/// The policies a study tries: every choice of each axis with every choice of the others.
#pragma once

#include <delassus/study/code_of.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace delassus {

namespace inner {

/// What is asked for an accuracy, as `ErrorControlled` is, makes its steps itself.
template <class P>
concept ChoosesItsSteps = requires(P policy) {
  { policy.accuracy } -> std::same_as<double&>;
};

}  // namespace inner

/// One axis: `Choices{SymplecticEuler{}, ImplicitMidpoint{}}`. Each is a type of its own, so each is
/// compiled.
template <class... P>
struct Choices {
  static constexpr int count = int(sizeof...(P));
  /// How many of them take a step size, and choose none.
  static constexpr int fixed = (0 + ... + int(!inner::ChoosesItsSteps<P>));
  std::tuple<P...> policies;

  explicit Choices(P... choices) : policies(std::move(choices)...) {}
};
template <class... P>
Choices(P...) -> Choices<P...>;

/// `Combinations{Choices{...}, Choices{...}}`: the product of the axes, the last axis varying first. `count`
/// loops are compiled, each about as long as a small program of its own.
template <class... Axes>
class Combinations {
 public:
  static constexpr int count = (1 * ... * Axes::count);
  /// How many have a fixed step: no policy of theirs chooses it.
  static constexpr int fixed = (1 * ... * Axes::fixed);
  static_assert(((Axes::count > 0) && ...),
                "delassus: every Choices{...} of a study needs at least one policy");

  explicit Combinations(Axes... axes) : axes_(std::move(axes)...) {}

  /// f(number, policies...) for each combination.
  template <class F>
  void each(F&& f) const {
    int number = 0;
    choose<0>(number, f);
  }

  /// The C++ text of each choice, by axis: what a diagram tells apart by colour and marker.
  std::vector<std::vector<std::string>> names() const {
    std::vector<std::vector<std::string>> names;
    std::apply([&](const auto&... axis) { (names.push_back(names_of(axis)), ...); }, axes_);
    return names;
  }

 private:
  template <std::size_t axis, class F, class... Chosen>
  void choose(int& number, F& f, const Chosen&... chosen) const {
    if constexpr (axis == sizeof...(Axes)) {
      f(number++, chosen...);
    } else {
      std::apply([&](const auto&... policy) { (choose<axis + 1>(number, f, chosen..., policy), ...); },
                 std::get<axis>(axes_).policies);
    }
  }
  template <class Axis>
  static std::vector<std::string> names_of(const Axis& axis) {
    std::vector<std::string> names;
    std::apply([&](const auto&... policy) { (names.push_back(code_of(policy)), ...); }, axis.policies);
    return names;
  }

  std::tuple<Axes...> axes_;
};
template <class... Axes>
Combinations(Axes...) -> Combinations<Axes...>;

}  // namespace delassus
