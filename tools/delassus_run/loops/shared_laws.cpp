// Compiles once what all types of loops share.
#include "shared_laws.hpp"

#include <delassus/compile_here.hpp>

namespace delassus {
DELASSUS_RUN_LAWS(DELASSUS_COMPILED_IS_SOUND, )
DELASSUS_RUN_LAWS(DELASSUS_COMPILED_LAW, template)
DELASSUS_RUN_LAWS(DELASSUS_COMPILED_POOL, template)
}  // namespace delassus
