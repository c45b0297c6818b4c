/// The typed edge: a list of laws becomes a list of pools.
#pragma once

#include "law_pool.hpp"

#include <delassus/constraints/constraints.hpp>

#include <array>
#include <tuple>
#include <utility>

namespace light {

/// The pools of a list of laws, and the list of them that plain code is given.
template <class... Laws>
struct Pools {
  std::tuple<LawPool<Laws, double>...> typed;
  std::array<Pool<double>*, sizeof...(Laws)> list;

  explicit Pools(const Constraints<Laws...>& laws)
      : Pools(laws, std::make_index_sequence<sizeof...(Laws)>{}) {}

 private:
  template <std::size_t... p>
  Pools(const Constraints<Laws...>& laws, std::index_sequence<p...>)
      : typed(laws.template pool<int(p)>()...), list{&std::get<p>(typed)...} {}
};

}  // namespace light
