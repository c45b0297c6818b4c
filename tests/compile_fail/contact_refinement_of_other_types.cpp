// expect: delassus: a law declares refine::natural_map, but Vec<rows, T> natural_map(item, const Vec<rows, T>& lambda, const Vec<rows, T>& u, T scale) const is not there or has other types
#include <delassus/delassus.hpp>

using namespace delassus;

struct Bound {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::lower};
  static constexpr auto refines = refine::natural_map;
  struct Parameters {};
  Parameters parameters() const { return {}; }
  Vec<1> solve_local(const Parameters&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
  double natural_map(const Parameters&, const Vec<1>&, const Vec<1>& u, double) const { return u[0]; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Bound{}}}};
  loop.step(1e-3);
}
