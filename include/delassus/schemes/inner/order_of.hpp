/// The order of an integrator in flight and with joints.
#pragma once

namespace delassus::inner {

/// What it says by `static constexpr int order = 2;`, else one.
template <class Integrator>
consteval int order_of() {
  if constexpr (requires { Integrator::order; }) return Integrator::order;
  else return 1;
}

}  // namespace delassus::inner
