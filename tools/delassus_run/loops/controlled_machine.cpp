// A loop for joints of any kind whose steps keep an error: the machine in it.
#include "controlled.hpp"  // before all else

#include "define_machine_in.hpp"

namespace delassus_run {

template struct MachineIn<decltype(controlled_loop({}))>;

}  // namespace delassus_run
