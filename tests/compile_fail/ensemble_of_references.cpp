// expect: delassus: make_loop of an Ensemble must return a new loop, not a reference to one
#include <delassus/delassus.hpp>
#include <delassus/study/ensemble.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  const Ensemble ensemble{[&](double) -> auto& { return loop; }, std::vector{0.1, 0.2}};
}
