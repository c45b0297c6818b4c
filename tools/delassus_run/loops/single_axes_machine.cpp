// A loop for links with one axis each: the machine in it.
#include "single_axes.hpp"  // before all else

#include "define_machine_in.hpp"

namespace delassus_run {

template struct MachineIn<decltype(single_axes_loop({}))>;

}  // namespace delassus_run
