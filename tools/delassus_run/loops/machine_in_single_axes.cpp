// A machine in the loop of single axes.
#include "single_axes.hpp"  // before all else

#include "define_machine_in.hpp"

#include <delassus/loop/scene.hpp>

#include <utility>

namespace delassus_run {

template struct MachineIn<decltype(scene_of(std::declval<decltype(single_axes_loop({}))&>()))>;

}  // namespace delassus_run
