// The pendulums of step_cost.cpp, joint by joint.
//   step_cost_visits <pendulum|pendulums> <visits> <steps>
#include "library_pendulums.hpp"

#include <delassus/schemes/joint_by_joint.hpp>

#include <cstdlib>
#include <string>

using namespace step_scenes;

int main(int count_of_words, char** words) {
  if (count_of_words != 4) return 2;
  const std::string what = std::string(words[1]) + " " + words[2];
  const int steps = std::atoi(words[3]);
  if (what == "pendulum visits") run(LibraryPendulums<1, Constraints<BallJoint>, JointByJoint>{}, steps);
  else if (what == "pendulums visits") run(LibraryPendulums<100, Constraints<BallJoint>, JointByJoint>{}, steps);
  else return 2;
}
