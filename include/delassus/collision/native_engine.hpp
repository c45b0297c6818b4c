/// All that NativeCollision detects with.
#pragma once

#include <delassus/collision/box_tree.hpp>
#include <delassus/collision/engine.hpp>
#include <delassus/collision/gjk_epa.hpp>
