// expect: delassus: a law declares a refinement that is not asked of it: speed, follow, breaks and restitution are of laws with items,
#include <delassus/delassus.hpp>

using namespace delassus;

struct Bound {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::lower};
  static constexpr auto refines = refine::speed;
  struct Parameters {};
  Parameters parameters() const { return {}; }
  Vec<1> solve_local(const Parameters&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
  double speed(const Parameters&) const { return 1; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Bound{}, 0.5}}}};
  loop.step(1e-3);
}
