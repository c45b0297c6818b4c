// delassus/fwd.hpp alone names a loop that a class keeps; it reads nothing of Eigen, and its names are the library's.
#include <delassus/fwd.hpp>

#if defined(EIGEN_WORLD_VERSION) || defined(_GLIBCXX_VECTOR)
#error "delassus/fwd.hpp reads more than names"
#endif

namespace {

using Machine = delassus::AnimationLoop<
    delassus::World<delassus::RigidBodies, delassus::Particles>,
    delassus::Constraints<delassus::Contact<delassus::Restitution<delassus::Coulomb>>, delassus::Hinge, delassus::Limit<delassus::Turn>>,
    delassus::AcceleratedGaussSeidel, delassus::Baumgarte>;

class Simulator {
 public:
  explicit Simulator(Machine* loop) : loop_(loop) {}
  Machine& loop() { return *loop_; }

 private:
  Machine* loop_;
};

}  // namespace

#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <type_traits>
#include <utility>

namespace {

using namespace delassus;

using SameMachine = decltype(AnimationLoop{World{RigidBodies{}, Particles{}},
                                           Constraints{Contact{Restitution{Coulomb{}, 0.3}}, Hinge{}, Limit<Turn>{}},
                                           AcceleratedGaussSeidel{}, Baumgarte{}});
static_assert(std::is_same_v<Machine, SameMachine>);
static_assert(std::is_same_v<decltype(std::declval<Simulator&>().loop().step(1e-3)), StepReport>);
static_assert(std::is_same_v<AcceleratedSweeps, BasicAcceleratedGaussSeidel<SweepsAlone>>);

}  // namespace
