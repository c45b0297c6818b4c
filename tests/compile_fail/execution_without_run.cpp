// expect: delassus: this type plays role::Execution but lacks workers() or run(tasks, f), both const; see core/execution.hpp
#include <delassus/delassus.hpp>

using namespace delassus;

struct Workers {
  using plays = role::Execution;
  Index workers() const { return 2; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, Workers{}};
  loop.step(1e-3);
}
