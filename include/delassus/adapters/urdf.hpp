/// Machines from URDF files, read by urdfdom. Needs the component urdf.
#pragma once

#include <delassus/adapters/urdf/build.hpp>
#include <delassus/io/inner/text_reader.hpp>
#include <delassus/model/check.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace delassus {
namespace inner::urdf_file {

inline Model parse(std::string_view text, const std::string& name, const UrdfOptions& options,
                   const std::string& folder) {
  Source in(text, name, options.strict);
  const Robot robot(in);
  const Reading reading(robot, in);
  Model model = Builder(in, robot, reading, options, folder).made();
  model.skipped = in.skipped();
  try {
    check(model);
  } catch (const InvalidArgument& refused) {
    in.refuse_at(in.root(), std::string(refused.what()).substr(std::string("delassus: ").size()));
  }
  return model;
}

}  // namespace inner::urdf_file

/// The machine of a URDF text. `name` stands in what is thrown, with the line: `name:3: …`.
///
/// A link with mass is a body of its name, in the frame of the link. It is fixed to its parent where their
/// joint is fixed. A massless link goes to the parent, else to the child, to which a fixed joint holds it,
/// the root too. Its shapes and the joints on it are of that body then, and a `model::Site` has its name.
/// Elsewhere in the tree it is refused.
///
/// A root that is called `world`, or has no mass and goes nowhere, is the world or is fixed to it. Any other
/// has a joint of kind `free` with the name of the link. `UrdfOptions::base` overrides.
///
/// revolute (limited) and continuous are hinges, prismatic is a slide, floating is `free`. planar is two
/// slides across its axis and a hinge about it, `name_x`, `name_y` and `name_turn`. A mimic is a
/// `model::Coupling` with the joint's name.
///
/// Collisions are shapes, meshes (.obj, .stl) as hulls. `capsule` is read, its length without the round ends.
/// So are `lateral_friction`, `rolling_friction`, `spinning_friction` and `restitution` of a link's
/// `contact`, as Bullet has them.
///
/// Visuals and materials are left out. What else is not read stands in `Model::skipped`, and is refused if
/// `strict`: meshes that are not there, elements and attributes that URDF does not have, an inertia that no
/// solid has.
///
/// Refuses (InvalidArgument) what urdfdom would drop with a line on the console, and what is no tree of sound
/// numbers.
inline Model parse_urdf(std::string_view text, const std::string& name, const UrdfOptions& options = {}) {
  return inner::urdf_file::parse(text, name, options, ".");
}

/// The machine of a file.
inline Model read_urdf(const std::string& path, const UrdfOptions& options = {}) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return inner::urdf_file::parse(inner::read_text(path), path, options, folder.empty() ? "." : folder);
}

}  // namespace delassus
