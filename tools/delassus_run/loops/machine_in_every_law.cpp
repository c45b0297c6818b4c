// A machine in the loops that have every law.
#include "every_joint.hpp"  // before all else

#include "define_machine_in.hpp"

#include <delassus/loop/scene.hpp>

#include <utility>

namespace delassus_run {

template struct MachineIn<decltype(scene_of(std::declval<decltype(every_joint_loop({}))&>()))>;

}  // namespace delassus_run
