/// Restitution: a wrapper that gives a contact law's normal row a target velocity.
#pragma once

#include <delassus/constraints/law.hpp>
#include <delassus/core/expect.hpp>

#include <cmath>

namespace delassus {

/// u_n⁺ ≥ −e u_n⁻ for a contact that closes within the step, u_n⁻ at its start. The stabilisation reads `restitution`
/// and makes the bias; an energy guard per island keeps the impulses from adding energy (`guard_energy`).
template <class Law>
struct Restitution {
  static constexpr int rows = Law::rows;
  static constexpr auto kinds = Law::kinds;

  Law law{};
  double restitution = 0;  ///< e in [0, 1], where neither the pair nor the materials say otherwise

  struct Parameters {
    typename Law::Parameters law;
    double restitution;
  };

  void check() const {
    law.check();
    DELASSUS_EXPECT(restitution >= 0 && restitution <= 1,
                    "Restitution: restitution " + inner::text(restitution) + " must be in [0, 1]");
  }

  Parameters parameters() const { return {law.parameters(), restitution}; }
  static void set_restitution(Parameters& p, double restitution) { p.restitution = restitution; }
  static void set_friction(Parameters& p, double friction)
    requires requires { Law::set_friction(p.law, friction); }
  {
    Law::set_friction(p.law, friction);
  }

  template <class T>
  using Memory = inner::memory_of_t<Law, T>;

  template <class T>
  void prepare(const Mat<rows, rows, T>& W, Memory<T>& memory) const {
    inner::prepare(law, W, memory);
  }
  template <class T>
  void project(const Parameters& p, Local<rows, T>& c, Memory<T>& memory) const {
    inner::project(law, p.law, c, memory);
  }
  template <class T>
  Vec<rows, T> meet(const Parameters& p, const Vec<rows, T>& b, Memory<T>& memory) const
    requires requires { law.meet(p.law, b, memory); }
  {
    return law.meet(p.law, b, memory);
  }
  template <class T>
  Vec<rows, T> natural_map(const Parameters& p, const Vec<rows, T>& lambda, const Vec<rows, T>& u, T scale) const {
    return law.natural_map(p.law, lambda, u, scale);
  }
  template <class T>
  void clamp(const Parameters& p, Vec<rows, T>& lambda) const {
    law.clamp(p.law, lambda);
  }
  template <class T>
  bool is_sliding(const Parameters& p, const Vec<rows, T>& lambda) const
    requires requires { law.is_sliding(p.law, lambda); }
  {
    return law.is_sliding(p.law, lambda);
  }
};

template <class Law>
Restitution(Law, double) -> Restitution<Law>;
template <class Law>
Restitution(Law) -> Restitution<Law>;

}  // namespace delassus
