// expect: delassus: a law has a member natural_map that it does not declare, so that nobody would call it
#include <delassus/delassus.hpp>

using namespace delassus;

struct Bound {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::lower};
  struct Parameters {};
  Parameters parameters() const { return {}; }
  Vec<1> solve_local(const Parameters&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
  Vec<1> natural_map(const Parameters&, const Vec<1>&, const Vec<1>& u, double) const { return u; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Penalty{Bound{}, 1e5}}}};
  loop.step(1e-3);
}
