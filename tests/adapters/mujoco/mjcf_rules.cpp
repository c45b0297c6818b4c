// Small texts of the rules that the models of others do not use, as MuJoCo 2.2.2 reads them.
#include "same_model.hpp"
#include "scratch_path.hpp"

#include <delassus/adapters/mjcf.hpp>

#include <filesystem>
#include <fstream>

namespace mujoco_mjcf_rules_tests {

using namespace delassus;

namespace {

/// `inside` is what stands within <mujoco>.
void check_text(const std::string& inside) {
  const std::string text = "<mujoco><compiler autolimits='true'/>" + inside + "</mujoco>";
  CAPTURE(text);
  const std::string path = scratch_path("mjcf_rule.xml").string();
  std::ofstream(path) << text;
  const MujocoModel m = load_in_mujoco(path);
  const Model model = parse_mjcf(text, path);
  std::filesystem::remove(path);
  check_bodies(model, *m);
  check_joints(model, *m);
  check_geoms(model, *m);
  check_tendons(model, *m);
  check_actuators(model, *m);
  check_rest(model, *m);
}

/// A moving body with these parts.
std::string body(const std::string& parts) {
  return "<worldbody><body name='b' pos='.1 .2 .3'><freejoint/>" + parts + "</body></worldbody>";
}

}  // namespace

TEST_CASE("every shape weighs what it does in MuJoCo, by density and by mass") {
  for (const char* shape :
       {"type='sphere' size='.3'", "type='capsule' size='.2 .3'", "type='cylinder' size='.2 .3'",
        "type='ellipsoid' size='.1 .2 .3'", "type='box' size='.1 .2 .3'"})
    for (const char* mass : {"", " mass='3'", " density='70'"})
      check_text(body(std::string("<geom pos='1 2 3' euler='10 20 30' ") + shape + mass + "/>"));
}

TEST_CASE("orientations in each of their five ways, and in other units and orders of angles") {
  for (const char* way : {"quat='1 2 3 4'", "axisangle='1 2 3 40'", "xyaxes='1 2 3 0 1 1'", "zaxis='1 -2 3'",
                          "zaxis='0 0 -2'", "euler='10 20 30'"})
    for (const char* compiler :
         {"", "<compiler angle='radian'/>", "<compiler eulerseq='zYx'/>", "<compiler eulerseq='XYZ'/>"})
      check_text(std::string(compiler) + body(std::string("<geom type='box' size='.1 .2 .3' ") + way + "/>"));
}

TEST_CASE("shapes from one point to another, whatever their type") {
  for (const char* type : {"capsule", "cylinder", "box", "ellipsoid"})
    check_text(body(std::string("<geom fromto='1 2 3 2 4 1' size='.1' type='") + type + "'/>"));
}

TEST_CASE("an inertial along axes, and turned") {
  for (const char* moments : {"diaginertia='1 2 2.5'", "diaginertia='1 2 2.5' euler='10 20 30'"})
    check_text(body(std::string("<geom size='.1'/><inertial pos='.1 .2 .3' mass='4' ") + moments + "/>"));
}

TEST_CASE("what the compiler makes of masses") {
  const std::string parts =
      "<geom size='.1' group='1'/><geom type='box' size='.1 .2 .3' pos='.5 0 0' group='3'/><inertial pos='0 "
      "0 .2' "
      "mass='2' diaginertia='.1 .2 .25'/>";
  for (const char* compiler :
       {"", "inertiafromgeom='true'", "inertiafromgeom='true' inertiagrouprange='2 4'", "settotalmass='7'",
        "boundmass='3'", "boundinertia='.15'", "boundmass='3' boundinertia='.3' settotalmass='2'"})
    check_text("<compiler " + std::string(compiler) + "/>" + body(parts));
  check_text("<compiler balanceinertia='true'/>" +
             body("<inertial pos='0 0 0' mass='1' diaginertia='1 1 5'/>"));
  // A body without geoms weighs nothing; what is fixed to it may.
  check_text(body("<body pos='1 0 0'><geom size='.1'/></body>"));
}

TEST_CASE("joints of every kind, with references, springs and limits in degrees and radians") {
  const std::string joints =
      "<worldbody><body><joint type='slide' axis='1 2 3' range='-1 2' ref='.5' springref='.3' stiffness='2' "
      "damping='3' "
      "armature='.1' frictionloss='.2'/><joint axis='0 3 0' pos='.1 .2 .3' range='-10 20' ref='30' "
      "springref='40'/><geom "
      "size='.1'/><body><joint type='ball' range='0 60' damping='2'/><geom "
      "size='.1'/></body></body><body><joint "
      "type='free' damping='.5'/><geom size='.1'/></body></worldbody>";
  check_text(joints);
  check_text("<compiler angle='radian'/>" + joints);
}

TEST_CASE("classes within classes, and which of them an element takes") {
  check_text(
      "<default><geom density='3' size='.1'/><joint damping='1'/><default class='a'><geom type='box' "
      "size='.1 .2 .3'/><joint "
      "damping='2' axis='1 0 0'/><default class='b'><geom friction='.5'/></default></default><default "
      "class='c'><joint "
      "stiffness='3'/></default></default><worldbody><geom/><body childclass='a'><joint/><geom/><geom "
      "class='b'/><body><joint "
      "class='c'/><geom class='main'/></body><body childclass='b'><joint/><geom "
      "size='.5'/></body></body></worldbody>");
}

TEST_CASE("actuators by each of their names") {
  const std::string world =
      "<worldbody><body><joint name='j' range='-1 1'/><geom size='.1'/><site name='s' pos='.1 0 "
      "0'/></body></worldbody>";
  for (const char* actuator :
       {"<motor joint='j' gear='3'/>", "<position joint='j' kp='5'/>", "<velocity joint='j' kv='2'/>",
        "<cylinder joint='j' timeconst='.2' area='.3' bias='1 2 3'/>", "<cylinder joint='j' diameter='.2'/>",
        "<general joint='j' gainprm='3' biastype='affine' biasprm='1 -2 -3' dyntype='filter' dynprm='.3' "
        "forcerange='-1 2' ctrlrange='-3 4'/>",
        "<motor site='s' gear='1 2 3 4 5 6'/>",
        "<motor jointinparent='j' ctrllimited='false' ctrlrange='0 1'/>"})
    check_text((std::string(actuator).find("jointinparent") == std::string::npos ? world : "") +
               "<actuator>" + actuator + "</actuator>" +
               (std::string(actuator).find("jointinparent") == std::string::npos ? "" : world));
  // All names of a class share one set of numbers: the position's gain is that of `general` before it.
  check_text("<default><general gainprm='4' gear='2'/><motor ctrlrange='-1 1'/></default>" + world +
             "<actuator><position joint='j'/><velocity joint='j'/><motor joint='j'/></actuator>");
}

TEST_CASE("equalities, tendons, pairs and keys") {
  const std::string two =
      "<worldbody><geom name='f' type='plane' size='1 1 1'/><body name='a' pos='1 2 3' euler='10 20 "
      "30'><joint name='x' "
      "ref='20'/><joint name='y' type='slide' ref='.2'/><geom name='ga' size='.1'/><site name='sa' pos='.1 "
      ".2 .3'/></body><body "
      "name='b' pos='3 1 2' "
      "euler='40 50 60'><joint name='z'/><geom name='gb' size='.1'/><site name='sb'/></body></worldbody>";
  for (const char* equality :
       {"<connect body1='a' body2='b' anchor='.1 .2 .3'/>", "<connect body1='a' anchor='.1 .2 .3'/>",
        "<weld body1='a' body2='b'/>", "<weld body1='b' relpose='1 2 3 1 2 3 4'/>",
        "<weld body1='a' body2='b' anchor='.1 .2 .3' relpose='1 2 3 1 2 3 4'/>",
        "<weld body1='a' body2='b' anchor='.1 .2 .3'/>",
        "<joint joint1='x' joint2='z' polycoef='.1 2 3 0 0'/>", "<joint joint1='x'/>",
        "<tendon tendon1='t' tendon2='s'/>"})
    check_text(
        two +
        "<tendon><fixed name='t' stiffness='2' range='-1 1' damping='.1' frictionloss='.2'><joint joint='x' "
        "coef='2'/><joint joint='y' coef='-3'/></fixed><spatial name='s' springlength='.7' range='0 3'><site "
        "site='sa'/><site site='sb'/></spatial><spatial stiffness='3'><site site='sb'/><site "
        "site='sa'/></spatial></tendon><equality>" +
        equality + "</equality>");
  check_text(two +
             "<contact><pair geom1='f' geom2='ga' condim='4' friction='.5 .5 .1 .2 .2'/><pair geom1='ga' "
             "geom2='gb'/><exclude body1='b' body2='a'/></contact><keyframe><key name='k' time='2' qpos='1 2 "
             "3' qvel='4 5 "
             "6'/><key/></keyframe>");
}

}  // namespace mujoco_mjcf_rules_tests
