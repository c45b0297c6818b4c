// A loop for joints of any kind: the machine in it.
#include "every_joint.hpp"  // before all else

#include "define_machine_in.hpp"

namespace delassus_run {

template struct MachineIn<decltype(every_joint_loop({}))>;

}  // namespace delassus_run
