#include <delassus/math/linear.hpp>

#ifdef CONSUMER_USES_FCL
#include <fcl/config.h>
#endif
#ifdef CONSUMER_USES_CCD
#include <ccd/vec3.h>
#endif

int main() { return delassus::skew(delassus::Vec3(1, 2, 3)).trace() == 0 ? 0 : 1; }
