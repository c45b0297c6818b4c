/// While a step runs its arrays fit the bodies and constraints that are there: none can be added.
#pragma once

#include <delassus/core/expect.hpp>

namespace delassus::inner {

/// Closes the sets of a world while it lives, also where a step throws. A set of a user's own may lack `close`.
template <class World>
class StepUnderWay {
 public:
  StepUnderWay(World& world, bool& is_under_way) : world_(world), is_under_way_(is_under_way) { close(true); }
  StepUnderWay(const StepUnderWay&) = delete;
  ~StepUnderWay() { close(false); }

 private:
  void close(bool is_closed) {
    is_under_way_ = is_closed;
    world_.each([&](auto& set, auto) {
      if constexpr (requires { set.close(is_closed); }) set.close(is_closed);
    });
  }

  World& world_;
  bool& is_under_way_;
};

}  // namespace delassus::inner
