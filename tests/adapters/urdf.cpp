// The rules by which a URDF becomes a description, each on a robot of a few lines.
#include <delassus/adapters/urdf.hpp>

#include "catch.hpp"
#include "scratch_path.hpp"

#include <filesystem>
#include <fstream>

namespace urdf_tests {

using namespace delassus;
using Catch::Contains;

namespace {

std::string a_link(const std::string& name, double mass, const std::string& more = "") {
  if (mass == 0) return "<link name='" + name + "'>" + more + "</link>\n";
  return "<link name='" + name + "'><inertial><origin xyz='0 0 0.1'/><mass value='" + std::to_string(mass) +
         "'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>" + more + "</link>\n";
}
std::string a_joint(const std::string& name, const std::string& type, const std::string& parent,
                    const std::string& child, const std::string& more = "<origin xyz='0 0 1'/>") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
         child + "'/>" + more + "</joint>\n";
}
const std::string shape =
    "<collision><origin xyz='1 0 0'/><geometry><sphere radius='0.5'/></geometry></collision>";
const std::string bounds = "<limit lower='-1' upper='2' effort='30' velocity='4'/>";

Model read(const std::string& elements, const UrdfOptions& options = {}) {
  return parse_urdf("<robot name='r'>\n" + elements + "</robot>\n", "r.urdf", options);
}
void refuses(const std::string& elements, const std::string& sentence, const UrdfOptions& options = {}) {
  INFO(elements);
  CHECK_THROWS_WITH(read(elements, options), Contains("delassus: r.urdf:") && Contains(sentence));
}

const model::Body& body(const Model& m, const std::string& name) {
  for (const model::Body& b : m.bodies)
    if (b.name == name) return b;
  FAIL("no body " << name);
  return m.bodies[0];
}
const model::Joint& joint(const Model& m, const std::string& name) {
  for (const model::Joint& j : m.joints)
    if (j.name == name) return j;
  FAIL("no joint " << name);
  return m.joints[0];
}

}  // namespace

TEST_CASE("links with mass are bodies, a fixed joint between two leaves none, and the root is free") {
  const Model m =
      read(a_link("a", 1) + a_link("b", 2) + a_link("c", 3) + a_joint("ab", "fixed", "a", "b") +
           a_joint("bc", "revolute", "b", "c",
                   "<origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/><axis xyz='0 3 4'/>" + bounds));
  CHECK(m.name == "r");
  REQUIRE((m.bodies.size() == 3 && m.bodies[1].joints.empty()));
  CHECK(m.bodies[1].parent == 0);
  CHECK(m.bodies[1].pose.position == Vec3(0, 0, 1));
  CHECK(m.bodies[2].parent == 1);
  CHECK(m.bodies[2].mass == 3);
  CHECK(m.bodies[2].centre == Vec3(0, 0, 0.1));
  CHECK((m.bodies[2].pose.rotation * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm() < 1e-15);
  CHECK(joint(m, "a").kind == model::JointKind::free);
  const model::Joint& hinge = joint(m, "bc");
  CHECK(hinge.kind == model::JointKind::hinge);
  CHECK((hinge.axis - Vec3(0, 0.6, 0.8)).norm() < 1e-15);
  CHECK(hinge.point == Vec3(0, 0, 0));
  CHECK(hinge.is_limited);
  CHECK(hinge.lower == -1);
  CHECK(hinge.upper == 2);
  CHECK(hinge.effort == 30);
  CHECK(hinge.speed == 4);
  CHECK(m.skipped.empty());
}

TEST_CASE("each kind of joint becomes its own") {
  const std::string two = a_link("a", 1) + a_link("b", 1),
                    brakes = "<dynamics damping='0.5' friction='0.25'/>";
  const Model turn = read(two + a_joint("j", "continuous", "a", "b",
                                        "<axis xyz='0 0 2'/><limit effort='5' velocity='6'/>" + brakes));
  CHECK_FALSE(joint(turn, "j").is_limited);
  CHECK(joint(turn, "j").effort == 5);
  CHECK(joint(turn, "j").damping == 0.5);
  CHECK(joint(turn, "j").friction_loss == 0.25);
  CHECK(joint(turn, "j").axis == Vec3(0, 0, 1));
  CHECK(joint(read(two + a_joint("j", "continuous", "a", "b", "")), "j").axis == Vec3(1, 0, 0));
  CHECK(joint(read(two + a_joint("j", "prismatic", "a", "b", bounds)), "j").kind == model::JointKind::slide);
  CHECK(joint(read(two + a_joint("j", "floating", "a", "b")), "j").kind == model::JointKind::free);
  const Model plane = read(two + a_joint("j", "planar", "a", "b", "<axis xyz='0 0 1'/>" + brakes));
  REQUIRE(body(plane, "b").joints.size() == 3);
  CHECK(joint(plane, "j_x").kind == model::JointKind::slide);
  CHECK(joint(plane, "j_x").axis == Vec3(1, 0, 0));
  CHECK(joint(plane, "j_y").axis == Vec3(0, 1, 0));
  CHECK(joint(plane, "j_turn").kind == model::JointKind::hinge);
  CHECK(joint(plane, "j_turn").axis == Vec3(0, 0, 1));
  REQUIRE(plane.skipped.size() == 1);
  CHECK_THAT(plane.skipped[0], Contains("r.urdf:4: damping and friction of joint 'j'"));
  refuses(two + a_joint("j", "continuous", "a", "b", "<axis xyz='0 0 0'/>"),
          "4: the axis of joint 'j' is zero");
  refuses(two + a_joint("j", "revolute", "a", "b", "<limit lower='2' upper='1' effort='0' velocity='0'/>"),
          "go from 2 to 1");
  refuses(two + a_joint("j", "revolute", "a", "b", ""),
          "urdfdom does not take joint 'j': Joint [0] is of type REVOLUTE");
  refuses(two + a_joint("j", "ball", "a", "b", ""),
          "4: joint 'j' is of type 'ball', which URDF does not have");
}

TEST_CASE("a massless link at the end of a fixed joint is part of its parent") {
  const Model m = read(a_link("a", 1) + a_link("hand", 0, shape) + a_link("tip", 0) + a_link("finger", 1) +
                       a_joint("1", "fixed", "a", "hand") + a_joint("2", "fixed", "hand", "tip") +
                       a_joint("3", "continuous", "tip", "finger"));
  REQUIRE(m.bodies.size() == 2);
  CHECK(body(m, "finger").parent == 0);
  CHECK(body(m, "finger").pose.position == Vec3(0, 0, 3));
  REQUIRE(m.geometries.size() == 1);
  CHECK((m.geometries[0].name == "hand" && m.geometries[0].body == 0));
  CHECK(m.geometries[0].pose.position == Vec3(1, 0, 1));
  REQUIRE(m.sites.size() == 2);
  CHECK(m.sites[1].name == "tip");
  CHECK(m.sites[1].body == 0);
  CHECK(m.sites[1].pose.position == Vec3(0, 0, 2));
}

TEST_CASE("a massless link that a joint moves and a fixed one holds to its child is part of the child") {
  const std::string turned = "<origin xyz='0 0 1' rpy='1.5707963267948966 0 0'/>";
  const Model m =
      read(a_link("a", 1) + a_link("knee", 0, shape) + a_link("shin", 2) +
           a_joint("turn", "continuous", "a", "knee", "<origin xyz='0 2 0'/><axis xyz='0 0 1'/>") +
           a_joint("hold", "fixed", "knee", "shin", turned));
  REQUIRE(m.bodies.size() == 2);
  const model::Body& shin = body(m, "shin");
  CHECK(shin.pose.position == Vec3(0, 2, 1));
  REQUIRE(shin.joints.size() == 1);
  // The knee's frame lies 1 m below the shin's along its z, which is the shin's y.
  CHECK((joint(m, "turn").point - Vec3(0, -1, 0)).norm() < 1e-15);
  CHECK((joint(m, "turn").axis - Vec3(0, 1, 0)).norm() < 1e-15);
  CHECK((m.geometries[0].pose.position - Vec3(1, -1, 0)).norm() < 1e-15);
  CHECK(m.sites[0].name == "knee");
}

TEST_CASE("a massless root goes to the child that is fixed to it, which then is the root") {
  const std::string robot =
      a_link("base", 0) + a_link("trunk", 5) + a_joint("hold", "fixed", "base", "trunk");
  for (const Base base : {Base::as_file, Base::free, Base::fixed}) {
    const Model m = read(robot, {.base = base});
    REQUIRE(m.bodies.size() == 1);
    CHECK(m.bodies[0].parent == -1);
    CHECK(m.bodies[0].pose.position == Vec3(0, 0, 1));
    CHECK(m.bodies[0].joints.empty() == (base == Base::fixed));
    CHECK(m.sites[0].pose.position == Vec3(0, 0, -1));
  }
}

TEST_CASE("a massless root that goes nowhere is the world, and so is one called world") {
  const std::string rail =
      a_link("rail", 0, shape) + a_link("cart", 1) + a_joint("slide", "prismatic", "rail", "cart", bounds);
  const Model cart = read(rail);
  REQUIRE(cart.bodies.size() == 1);
  CHECK(cart.bodies[0].parent == -1);
  CHECK(cart.joints.size() == 1);
  CHECK(cart.geometries[0].body == -1);
  CHECK(cart.sites[0].body == -1);
  refuses(rail, "2: the root 'rail' has no mass", {.base = Base::free});

  const std::string post = a_link("world", 0) + a_link("post", 1) + a_joint("hold", "fixed", "world", "post");
  CHECK(read(post).bodies[0].joints.empty());
  CHECK(read(post).sites[0].body == -1);
  CHECK(read(post, {.base = Base::free}).bodies[0].joints.size() == 1);
  const Model heavy =
      read(a_link("world", 3) + a_link("arm", 1) + a_joint("turn", "continuous", "world", "arm"));
  CHECK(body(heavy, "world").joints.empty());
  CHECK(read(a_link("a", 1), {.base = Base::fixed}).joints.empty());
}

TEST_CASE("a massless link within the tree is refused with its line") {
  refuses(a_link("a", 1) + a_link("cross", 0) + a_link("b", 1) + a_joint("1", "continuous", "a", "cross") +
              a_joint("2", "continuous", "cross", "b"),
          "3: link 'cross' has no mass, and no fixed joint holds it");
  refuses(a_link("a", 1) + a_link("end", 0) + a_joint("1", "continuous", "a", "end"),
          "3: link 'end' has no mass");
}

TEST_CASE("a mimic is a coupling, whatever the order of the two joints") {
  const std::string hand = a_link("palm", 1) + a_link("l", 1) + a_link("r", 1) +
                           a_joint("left", "prismatic", "palm", "l",
                                   bounds + "<mimic joint='right' multiplier='-2' offset='0.5'/>");
  const Model m = read(hand + a_joint("right", "prismatic", "palm", "r", bounds));
  REQUIRE(m.couplings.size() == 1);
  CHECK(m.joints[std::size_t(m.couplings[0].joint)].name == "left");
  CHECK(m.joints[std::size_t(m.couplings[0].other)].name == "right");
  CHECK(m.couplings[0].coefficients == std::array<double, 5>{0.5, -2, 0, 0, 0});
  refuses(hand + a_joint("other", "prismatic", "palm", "r", bounds), "5: there is no joint 'right' to mimic");
  refuses(a_link("a", 1) + a_link("b", 1) + a_joint("j", "continuous", "a", "b", "<mimic joint='j'/>"),
          "joint 'j' mimics itself");
  CHECK_THAT(read(hand + a_joint("right", "fixed", "palm", "r")).skipped.at(0),
             Contains("r.urdf:5: a mimic between joints"));
}

TEST_CASE("shapes keep their sizes, places, names and what Bullet says of friction") {
  const auto one = [](const std::string& geometry) {
    return "<collision name='c'><geometry>" + geometry + "</geometry></collision>";
  };
  const std::string contact =
      "<contact><lateral_friction value='0.3'/><rolling_friction value='0.01'/><spinning_friction "
      "value='0.02'/><restitution value='0.4'/></contact>";
  const Model m = read(a_link("a", 1,
                              one("<box size='1  2\n3'/>") + one("<sphere radius='4'/>") +
                                  one("<cylinder radius='5' length='6'/>") +
                                  one("<capsule radius='7' length='8'/>") + contact));
  REQUIRE(m.geometries.size() == 4);
  CHECK(std::get<Box>(m.geometries[0].shape).z == 3);
  CHECK(std::get<Sphere>(m.geometries[1].shape).radius == 4);
  CHECK(std::get<Cylinder>(m.geometries[2].shape).height == 6);
  CHECK(std::get<Capsule>(m.geometries[3].shape).radius == 7);
  CHECK(std::get<Capsule>(m.geometries[3].shape).height == 8);
  CHECK(m.geometries[0].name == "c");
  CHECK(m.geometries[3].name == "c_4");
  CHECK(m.geometries[3].friction == 0.3);
  CHECK(m.geometries[3].rolling_friction == 0.01);
  CHECK(m.geometries[3].spinning_friction == 0.02);
  CHECK(m.geometries[3].restitution == 0.4);
  CHECK(m.geometries[3].contact_freedoms == 6);
  refuses(a_link("a", 1, one("<box size='1 2'/>")), "2: size of <box> has 2 numbers and must have 3");
  refuses(a_link("a", 1, one("<box/>")),
          "2: urdfdom does not take link 'a': Box shape has no size attribute");
  refuses(a_link("a", 1, one("<sphere radius='-1'/>")), "a size of a collision's shape is -1 m");
  refuses(a_link("a", 1, one("<cone radius='1'/>")), "<cone> is no shape of URDF");
  refuses(a_link("a", 1, "<collision/>"), "a collision of link 'a' has no shape");
  refuses(a_link("a", 1, one("<box size='1 1 0'/>")), "has no volume", {.strict = true});
}

TEST_CASE("the inertia about the centre stands in the axes of the link") {
  const Model m = read(
      "<link name='a'><inertial><origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/><mass value='2'/>"
      "<inertia ixx='2' iyy='3' izz='4' ixy='0.5' ixz='0' iyz='0'/></inertial></link>");
  CHECK(m.bodies[0].centre == Vec3(1, 2, 3));
  Mat3 turned;
  turned << 3, -0.5, 0, -0.5, 2, 0, 0, 0, 4;
  CHECK((m.bodies[0].inertia - turned).norm() < 1e-14);
}

TEST_CASE("meshes become hulls, found beside the file, in a package or in a folder that is named") {
  namespace fs = std::filesystem;
  const fs::path top = scratch_path("urdf_meshes"), package = top / "arm";
  fs::create_directories(package / "urdf");
  std::ofstream(package / "wedge.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\n";
  const auto collision = [](const std::string& file, const std::string& scale) {
    return "<collision><geometry><mesh filename='" + file + "' scale='" + scale +
           "'/></geometry></collision>";
  };
  const std::string text =
      "<robot name='r'>" +
      a_link("a", 1,
             collision("package://arm/wedge.obj", "2 2 -2") + collision("../wedge.obj", "1 1 1") +
                 collision("package://arm/wedge.obj", "2 2 -2")) +
      "</robot>";
  std::ofstream(package / "urdf" / "arm.urdf") << text;
  const Model m = read_urdf((package / "urdf" / "arm.urdf").string(), {.strict = true});
  REQUIRE(m.meshes.size() == 2);
  CHECK(m.meshes[0].vertices[3] == Vec3(0, 0, -2));
  CHECK(m.meshes[0].triangles[0] == std::array<Index, 3>{0, 1, 2});
  CHECK(std::get<model::HullOf>(m.geometries[2].shape).mesh == 0);
  CHECK(parse_urdf(text, "r.urdf", {.meshes = top.string()}).meshes.size() == 1);
  CHECK(parse_urdf(text, "r.urdf", {.packages = {{"arm", package.string()}}}).meshes.size() == 1);
  const Model none = parse_urdf(text, "r.urdf");
  CHECK(none.geometries.empty());
  REQUIRE(none.skipped.size() == 3);
  CHECK_THAT(none.skipped[0],
             Contains("r.urdf:1: collision mesh 'package://arm/wedge.obj': there is no such file"));
  CHECK_THROWS_WITH(parse_urdf(text, "r.urdf", {.strict = true}),
                    Contains("r.urdf:1: collision mesh") && Contains("without `strict`"));
  std::ofstream(package / "wedge.obj") << "v 0 0 zero\n";
  CHECK_THROWS_WITH(read_urdf((package / "urdf" / "arm.urdf").string()),
                    Contains("wedge.obj:1: coordinate 'zero'"));
  fs::remove_all(top);
}

TEST_CASE("what is not read is named with file and line, and refused if strict") {
  const std::string robot =
      a_link("a", 1, "<sensor/><visual><geometry><nothing/></geometry></visual>") +
      "<transmission name='t'/>\n<material name='m'/>\n" + a_link("b", 1) +
      a_joint("j", "revolute", "a", "b", "<axis xyz='1 0 0' abc='1'/>" + bounds + bounds);
  const Model m = read(robot);
  REQUIRE(m.skipped.size() == 4);
  CHECK_THAT(m.skipped[0], Contains("r.urdf:2: <sensor> is not read"));
  CHECK_THAT(m.skipped[1], Contains("r.urdf:3: <transmission> is not read"));
  CHECK_THAT(m.skipped[2], Contains("r.urdf:6: of <axis> no 'abc' is read"));
  CHECK_THAT(m.skipped[3], Contains("r.urdf:6: a second <limit> in one <joint>"));
  refuses(robot, "<transmission> is not read", {.strict = true});
  const std::string rod =
      "<link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='3' ixy='0' ixz='0' "
      "iyz='0'/></inertial></link>";
  CHECK_THAT(
      read(rod).skipped.at(0),
      Contains("r.urdf:2: link 'a': inertia with diagonal (1, 1, 3) violates the triangle inequality"));
  CHECK(read(rod).bodies[0].inertia(2, 2) == 3);
  refuses(rod, "violates the triangle inequality", {.strict = true});
}

}  // namespace urdf_tests
