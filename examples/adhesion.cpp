// A contact law of your own: surfaces that stick, and part only under more than a given force.
// prints: holds 9 N and lets go of 11 N
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

/// λ_n ≥ −h F:  with λ' = λ_n + h F the law is Signorini's, 0 ≤ u_n ⟂ λ' ≥ 0. F (N) is what one contact point can pull.
struct Adhesive {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::lower};
  static constexpr auto refines = refine::check | refine::clamp | refine::natural_map;
  double force = 0;
  double h = 0;  ///< the step that the force acts in

  struct Parameters { double impulse; };
  void check() const { DELASSUS_EXPECT(force >= 0 && h > 0, "Adhesive: force must be >= 0 and h > 0"); }
  Parameters parameters() const { return {h * force}; }

  Vec<1> solve_local(const Parameters& p, const Mat<1, 1>& W, const Vec<1>& b) const {
    return Vec<1>(std::max(-p.impulse, -b[0] / W(0, 0)));
  }
  void clamp(const Parameters& p, Vec<1>& lambda) const { lambda[0] = std::max(-p.impulse, lambda[0]); }
  Vec<1> natural_map(const Parameters& p, const Vec<1>& lambda, const Vec<1>& u, double scale) const {
    return Vec<1>(std::min(scale * (lambda[0] + p.impulse), u[0]));
  }
};

bool holds(double pull) {
  constexpr double h = 0.01;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Adhesive{.force = 10, .h = h}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  rigid.add_fixed(HalfSpace{});
  const auto ball = rigid.add({.position = {0, 0, 0.1}, .mass = 1.0, .shape = Sphere{0.1}});
  for (int i = 0; i < 100; ++i) rigid.apply_force(ball, {0, 0, pull}), loop.step(h);
  return rigid.position(ball).z() < 0.1 + 1e-9;
}
int main() { std::printf("holds 9 N%s and %s 11 N\n", holds(9) ? "" : " not", holds(11) ? "holds" : "lets go of"); }
