// expect: delassus: check_against_reference needs tangent(item, local) of every constraint law; add it to the law that lacks it
#include <delassus/delassus.hpp>
#include <delassus/problems/reference_check.hpp>

using namespace delassus;

struct Floor {
  static constexpr int rows = 1;
  struct Item {
    Anchor a, b = world_anchor({0, 0, 0});
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 x = world.point(item.a);
    row.end(item.a, x).along(0, Vec3::UnitZ());
    row.phi(0, x.z());
  }
  Vec<1> solve_local(const Item&, const Mat<1, 1>& W, const Vec<1>& b) const { return Vec<1>(std::max(0.0, -b[0] / W(0, 0))); }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Floor{}}};
  loop.step(1e-3);
  check_against_reference(loop);
}
