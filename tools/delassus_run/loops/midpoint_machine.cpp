// A loop for joints of any kind, its steps of second order: the machine in it.
#include "midpoint.hpp"  // before all else

#include "define_machine_in.hpp"

namespace delassus_run {

template struct MachineIn<decltype(midpoint_loop({}))>;

}  // namespace delassus_run
