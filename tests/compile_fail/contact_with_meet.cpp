// expect: delassus: a constraint law needs Vec<rows> solve_local(item, W, b) const in the place of project(item, local); see docs/project/migration.md
#include <delassus/delassus.hpp>

using namespace delassus;

struct Bound {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::lower};
  struct Parameters {};
  Parameters parameters() const { return {}; }
  Vec<1> meet(const Parameters&, const Vec<1>& b) const { return b; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Bound{}, 0.5}}}};
  loop.step(1e-3);
}
