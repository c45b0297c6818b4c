/// Machines from MJCF, the XML files of MuJoCo. Needs the component mjcf.
#pragma once

#include <delassus/adapters/mjcf/machine.hpp>
#include <delassus/model/check.hpp>
#include <delassus/model/model.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace delassus {

/// How `load_mjcf` reads a file.
struct MjcfOptions {
  bool strict = false;  ///< refuses what would be left out, where it is named otherwise in `Model::skipped`
  /// Folders in which included files, models, meshes and height fields are looked for besides that of the
  /// file.
  std::vector<std::string> files;
  std::int64_t most_elements =
      200'000;  ///< that a model may have, with the copies of `replicate` and `attach`; of texts 50 bytes each
};

/// The machine that a text describes. `name` stands in what is thrown, with the line, and files that the text
/// names are looked for in its folder. What is left out is named in `Model::skipped`, and refused where
/// `strict` is set. What is not MJCF, or no machine, is refused (InvalidArgument) with file and line. Source:
/// the XML reference of MuJoCo 3.12.
inline Model parse_mjcf(const std::string& text, const std::string& name, const MjcfOptions& options = {}) {
  Model model;
  inner::mjcf::Reading reading{.model = model,
                               .skipped = {options.strict, model.skipped},
                               .budget = inner::mjcf::Budget(options.most_elements),
                               .folders = {options.files}};
  inner::mjcf::read_machine(reading, text, name);
  try {
    check(model);
  } catch (const InvalidArgument& error) {  // with a file and a line, as all that is refused here
    const std::string sentence = error.what();
    inner::refuse(name + ":1: " + sentence.substr(sentence.find(": ") + 2));
  }
  return model;
}

/// The machine of a file.
inline Model read_mjcf(const std::string& path, const MjcfOptions& options = {}) {
  return parse_mjcf(inner::read_text(path), path, options);
}

}  // namespace delassus
