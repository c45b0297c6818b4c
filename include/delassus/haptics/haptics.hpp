/// All of haptics/: the channel of a device thread, a simulated device, and what watches that no energy is given out.
#pragma once

#include <delassus/haptics/force_output.hpp>
#include <delassus/haptics/haptic_channel.hpp>
#include <delassus/haptics/passivity_observer.hpp>
#include <delassus/haptics/simulated_device.hpp>
