/// The attributes that MJCF has, an element at a time, so that a word misspelt does not pass in silence.
#pragma once

#include <delassus/adapters/mjcf/source.hpp>

#include <string>
#include <string_view>

namespace delassus::inner::mjcf {

/// The elements within an element, and their attributes. What is of no account here has no list: its
/// attributes and children are not looked at. From the XML reference of MuJoCo 3.12, and what older versions
/// had.
namespace known {

inline constexpr const char* orientation = "pos quat axisangle xyaxes zaxis euler";
inline constexpr const char* softness = "solreflimit solimplimit solreffriction solimpfriction";
inline constexpr const char* actuator =
    "name class group nsample interp delay ctrlrange user ctrllimited forcelimited forcerange lengthrange "
    "gear "
    "damping armature cranklength joint jointinparent tendon slidersite cranksite site refsite";
inline constexpr const char* everything = "*";

struct Row {
  std::string_view section, element;
  const char* attributes;
  const char* more = "";
};

/// A section "" is any.
inline constexpr Row rows[] = {
    {"", "include", "file"},
    {"mujoco", "mujoco", "model"},
    {"mujoco", "compiler",
     "autolimits boundmass boundinertia settotalmass balanceinertia strippath coordinate angle fitaabb "
     "eulerseq "
     "meshdir texturedir discardvisual usethread fusestatic inertiafromgeom inertiagrouprange saveinertial "
     "assetdir "
     "alignfree conflict convexhull exactmeshinertia"},
    {"compiler", "lengthrange", everything},
    {"mujoco", "option",
     "timestep impratio tolerance ls_tolerance noslip_tolerance ccd_tolerance sleep_tolerance gravity wind "
     "magnetic "
     "density viscosity o_margin o_solref o_solimp o_friction integrator cone jacobian solver iterations "
     "ls_iterations noslip_iterations ccd_iterations sdf_iterations sdf_initpoints actuatorgroupdisable "
     "apirate "
     "mpr_tolerance mpr_iterations collision"},
    {"option", "flag",
     "constraint equality frictionloss limit contact spring damper passive gravity clampctrl warmstart "
     "filterparent "
     "actuation refsafe sensor midphase eulerdamp autoreset nativeccd island multiccd override energy fwdinv "
     "invdiscrete sleep diagexact sensornoise"},
    {"mujoco", "size", everything},
    {"mujoco", "statistic", everything},
    {"mujoco", "visual", everything},
    {"mujoco", "default", "class"},
    {"default", "default", "class"},
    {"mujoco", "extension", everything},
    {"mujoco", "asset", ""},
    {"mujoco", "worldbody", ""},
    {"mujoco", "deformable", everything},
    {"mujoco", "contact", ""},
    {"mujoco", "equality", ""},
    {"mujoco", "tendon", ""},
    {"mujoco", "actuator", ""},
    {"mujoco", "sensor", everything},
    {"mujoco", "custom", everything},
    {"mujoco", "keyframe", ""},
    {"asset", "mesh",
     "name class content_type file vertex normal texcoord face refpos refquat scale smoothnormal maxhullvert "
     "inertia "
     "builtin params material"},
    {"asset", "hfield", "name content_type file nrow ncol size elevation"},
    {"asset", "skin", everything},
    {"asset", "texture", everything},
    {"asset", "material", everything},
    {"asset", "model", "name file content_type"},
    {"default", "mesh", "scale maxhullvert inertia"},
    {"default", "material", everything},
    {"default", "equality", "active solref solimp"},
    {"default", "tendon",
     "group limited range frictionloss springlength width material margin stiffness damping "
     "rgba user",
     softness},
    {"body", "body", "name childclass mocap gravcomp sleep simple user", orientation},
    {"body", "frame", "name childclass", orientation},
    {"body", "replicate", "count offset euler sep childclass"},
    {"body", "inertial", "mass diaginertia fullinertia", orientation},
    {"body", "joint",
     "name class type group pos axis springdamper limited actuatorfrclimited stiffness range "
     "actuatorfrcrange "
     "actuatorgravcomp margin ref springref armature damping frictionloss user",
     softness},
    {"body", "freejoint", "name group align"},
    {"body", "geom",
     "name class type contype conaffinity condim group priority size material friction mass density "
     "shellinertia "
     "solmix solref solimp margin gap surfacevel adhesion fromto hfield mesh fitscale rgba fluidshape "
     "fluidcoef "
     "user",
     orientation},
    {"body", "attach", "model body frame prefix"},
    {"body", "site", "name class type group material size fromto rgba user", orientation},
    {"body", "camera", everything},
    {"body", "light", everything},
    {"body", "plugin", everything},
    {"body", "composite", everything},
    {"body", "flexcomp", everything},
    {"contact", "pair",
     "name class geom1 geom2 condim friction solref solreffriction solimp gap margin adhesion"},
    {"contact", "exclude", "name body1 body2"},
    {"tendon", "spatial",
     "name class group limited actuatorfrclimited range actuatorfrcrange frictionloss springlength width "
     "material "
     "margin stiffness damping armature rgba user",
     softness},
    {"tendon", "fixed",
     "name class group limited actuatorfrclimited range actuatorfrcrange frictionloss springlength margin "
     "stiffness "
     "damping armature user",
     softness},
    {"spatial", "site", "site"},
    {"spatial", "geom", "geom sidesite"},
    {"spatial", "pulley", "divisor"},
    {"fixed", "joint", "joint coef"},
    {"equality", "connect", "name class active solref solimp body1 body2 anchor site1 site2"},
    {"equality", "weld",
     "name class active solref solimp body1 body2 relpose anchor site1 site2 torquescale"},
    {"equality", "joint", "name class active solref solimp joint1 joint2 polycoef"},
    {"equality", "tendon", "name class active solref solimp tendon1 tendon2 polycoef"},
    {"equality", "flex", everything},
    {"equality", "flexvert", everything},
    {"equality", "flexstrain", everything},
    {"equality", "distance", everything},
    {"actuator", "general",
     "actlimited actrange body actdim input velrange ffrange dyntype gaintype biastype dynprm gainprm "
     "biasprm "
     "actearly",
     actuator},
    {"actuator", "motor", "", actuator},
    {"actuator", "position", "inheritrange kp kv dampratio timeconst", actuator},
    {"actuator", "velocity", "kv", actuator},
    {"actuator", "intvelocity", "actlimited actrange inheritrange kp kv dampratio", actuator},
    {"actuator", "damper", "kv", actuator},
    {"actuator", "cylinder", "timeconst area diameter bias", actuator},
    {"actuator", "orientation", everything},
    {"actuator", "pid", everything},
    {"actuator", "muscle", everything},
    {"actuator", "adhesion", everything},
    {"actuator", "dcmotor", everything},
    {"actuator", "plugin", everything},
    {"keyframe", "key", "name time qpos qvel act mpos mquat ctrl"},
};

/// Under which name the children of an element are looked up: bodies and what stands for one share theirs.
inline std::string_view section_of(std::string_view element) {
  for (const std::string_view body : {"worldbody", "body", "frame", "replicate"})
    if (element == body) return "body";
  return element;
}

inline const Row* find(std::string_view section, std::string_view element) {
  for (const Row& row : rows)
    if ((row.section.empty() || row.section == section) && row.element == element) return &row;
  if (section != "default") return nullptr;
  // A class sets what elements of bodies, contacts and actuators have.
  for (const std::string_view no :
       {"body", "frame", "replicate", "inertial", "freejoint", "attach", "exclude"})
    if (element == no) return nullptr;
  for (const std::string_view other : {"body", "contact", "actuator"})
    if (const Row* found = find(other, element)) return found;
  return nullptr;
}

/// Whether the word stands in a list with a space between two.
inline bool has_word(std::string_view list, std::string_view word) {
  for (std::size_t at = list.find(word); at != std::string_view::npos; at = list.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' ')) return !word.empty();
  }
  return false;
}

}  // namespace known

/// Attributes that name things: their values may look like numbers.
inline bool is_name(std::string_view attribute) {
  return known::has_word(
      "name class childclass model file dir prefix sep joint joint1 joint2 jointinparent tendon tendon1 "
      "tendon2 site "
      "site1 site2 slidersite cranksite refsite sidesite body body1 body2 geom geom1 geom2 mesh hfield "
      "material "
      "texture target frame content_type assetdir meshdir texturedir objname refname key value plugin "
      "instance "
      "fileright fileleft fileup filedown filefront fileback data camera actuator flex node subtree1 "
      "subtree2 memory",
      attribute);
}

/// Refuses numbers that are not finite or beyond 1e30.
inline void check_numbers(const Element& e) {
  for (const auto* a = e.xml()->FirstAttribute(); a; a = a->Next()) {
    if (is_name(a->Name())) continue;
    for_each_word(a->Value(), [&](std::string_view word) {
      double value = 0;
      if (!parse_number(word, value)) return false;
      e.check_size(a->Name(), word, value);
      return true;
    });
  }
}

/// Refuses what MJCF does not have in this place, and numbers that are not finite or beyond 1e30 even where
/// nothing here reads them. Says whether the children are to be looked at.
inline bool check_known(std::string_view section, const Element& e) {
  const known::Row* row = known::find(section, e.name());
  if (!row)
    e.refuse("an element '" + std::string(e.name()) + "' is not known within '" + std::string(section) +
             "'; is it misspelt, or newer than MuJoCo 3.12?");
  const bool is_open = std::string_view(row->attributes) != known::everything;
  for (const auto* a = e.xml()->FirstAttribute(); a; a = a->Next()) {
    if (is_open && !known::has_word(row->attributes, a->Name()) && !known::has_word(row->more, a->Name()))
      e.refuse("an attribute '" + std::string(a->Name()) + "' is not known for '" + std::string(e.name()) +
               "'; is it misspelt, or newer than MuJoCo 3.12?");
  }
  check_numbers(e);
  return is_open;
}

}  // namespace delassus::inner::mjcf
