#include <delassus/adapters/urdf.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace urdf_holds_tests {

using namespace delassus;

// The forces of joints balance the weight to rounding, and so does the direct solver: what is left of 1e4 steps is rounding.
TEST_CASE("arms of URDF files hold a pose under gravity compensation") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  for (const char* name : {"panda", "ur5"}) {
    const Model model = read_urdf(std::string(folder) + "/urdf/robots/" + name + ".urdf");
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Slider{}}, DirectGaussSeidel{.tolerance = 1e-12}};
    const LeaveOut plain{.contacts = true, .limits = true, .damping = true, .friction_loss = true, .couplings = true};
    const Machine machine = add(loop, model, {}, Base::fixed, plain);
    JointSpace space(model, Base::fixed);
    std::vector<double> q(std::size_t(space.q_size())), v(std::size_t(space.v_size())), tau(v.size());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> draw(-1, 1);
    space.reference(q);
    for (double& x : q) x += draw(random);
    set_joint_state(loop, machine, space, q, v);

    std::vector<Index> held;  // all but the root, which the world holds
    for (std::size_t j = 0; j < model.joints.size(); ++j)
      if (space.q_of(Index(j)) >= 0) held.push_back(Index(j));
    std::vector<double> now = q;
    double most = 0, push = 0;
    for (int n = 0; n < 10000; ++n) {
      for (const Index j : held) now[std::size_t(space.q_of(j))] = position_of(loop.world(), machine, j);
      space.gravity_compensation(now, tau);
      for (const Index j : held) push_joint(loop, machine, j, tau[std::size_t(space.v_of(j))]);
      loop.step(1e-3);
    }
    for (std::size_t k = 0; k < q.size(); ++k) most = std::max(most, std::abs(std::remainder(now[k] - q[k], 2 * M_PI)));
    for (const double t : tau) push = std::max(push, std::abs(t));
    CAPTURE(name, push);
    CHECK(push > 10);  // N·m: there is something to hold
    CHECK(most < 1e-9);
  }
}

}  // namespace urdf_holds_tests
