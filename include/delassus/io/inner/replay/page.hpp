/// The replay page without its data: one layout, one style and one script, put together from pieces.
#pragma once

#include <delassus/io/inner/replay/camera.hpp>
#include <delassus/io/inner/replay/controls.hpp>
#include <delassus/io/inner/replay/data.hpp>
#include <delassus/io/inner/replay/graphics.hpp>
#include <delassus/io/inner/replay/layout.hpp>
#include <delassus/io/inner/replay/plots.hpp>
#include <delassus/io/inner/replay/shaders.hpp>
#include <delassus/io/inner/replay/solids.hpp>
#include <delassus/io/inner/replay/style.hpp>
#include <delassus/io/inner/replay/view.hpp>

#include <string>
#include <string_view>

namespace delassus::inner {

/// One script in a scope of its own; a piece uses only what stands above it.
inline std::string replay_script() {
  std::string script = "'use strict';\n(() => {\n";
  for (const std::string_view piece : {replay_data, replay_camera, replay_solids, replay_shaders,
                                       replay_graphics, replay_view, replay_plots, replay_controls})
    script += piece;
  return script + "})();\n";
}

}  // namespace delassus::inner
