#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"

namespace mjcf_forces_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

Model read_text(const std::string& inside) {
  return parse_mjcf("<mujoco>" + inside + "</mujoco>", "text.xml");
}

/// Two arms, a joint and a site each.
const std::string arms =
    "<worldbody><body name='a' pos='0 0 1'><joint name='x' ref='90' range='-90 180'/><geom size='.1'/><site "
    "name='s' pos='1 0 "
    "0'/></body><body name='b' pos='0 3 1'><joint name='y'/><geom size='.1'/><site "
    "name='t'/></body></worldbody>";

model::Actuator read_actuator(const std::string& actuator, const std::string& before = "") {
  const Model m = read_text(before + arms + "<actuator>" + actuator + "</actuator>");
  REQUIRE(m.actuators.size() == 1);
  return m.actuators[0];
}
using Three = std::array<double, 3>;

}  // namespace

TEST_CASE("an actuator's name sets its gain, its bias and its filter") {
  const model::Actuator motor = read_actuator("<motor name='m' joint='y' gear='3' ctrlrange='-1 2'/>");
  CHECK(motor.name == "m");
  CHECK(motor.target == 1);
  CHECK((motor.gear[0] == 3 && motor.gain == 1 && motor.bias == Three{0, 0, 0}));
  CHECK((motor.control_is_limited && motor.control_lower == -1 && motor.control_upper == 2 &&
         !motor.force_is_limited));
  const model::Actuator position =
      read_actuator("<position joint='y' kp='5' kv='2' timeconst='.3' forcerange='-1 1'/>");
  CHECK((position.gain == 5 && position.bias == Three{0, -5, -2} && position.time_constant == 0.3 &&
         position.force_is_limited));
  const model::Actuator velocity = read_actuator("<velocity joint='y' kv='2'/>");
  CHECK((velocity.gain == 2 && velocity.bias == Three{0, 0, -2}));
  const model::Actuator general = read_actuator(
      "<general site='t' gear='0 0 1' gainprm='3' biastype='affine' biasprm='1 -2 -3' dyntype='filterexact' "
      "dynprm='.5'/>");
  CHECK(general.transmission == model::Transmission::site);
  CHECK((general.gain == 3 && general.bias == Three{1, -2, -3} && general.time_constant == 0.5 &&
         general.gear[2] == 1));
  const model::Actuator inherits = read_actuator("<position joint='x' inheritrange='.5'/>");
  CHECK(inherits.control_lower == Approx(3.14159265358979 * (0.25 - 0.375)));
}

TEST_CASE("all actuators of a class share one set of numbers") {
  const model::Actuator a =
      read_actuator("<position joint='y'/>", "<default><general gear='4' gainprm='6'/></default>");
  CHECK((a.gear[0] == 4 && a.gain == 6 && a.bias == Three{0, -6, 0}));
}

TEST_CASE("actuators of other laws and transmissions are left out by name") {
  for (const auto& [actuator, reason] :
       {std::pair{"<muscle name='m' joint='x'/>", "it is a muscle"},
        {"<intvelocity name='m' joint='x'/>", "its activation is the integral"},
        {"<damper name='m' joint='x' kv='1' ctrlrange='0 1'/>", "its gain depends"},
        {"<adhesion name='m' body='a'/>", "it acts on a body"},
        {"<dcmotor name='m' joint='x'/>", "its law of force is not"},
        {"<motor name='m' site='s' refsite='t'/>", "as seen from another"},
        {"<motor name='m' cranksite='s' slidersite='t' cranklength='1'/>", "a slider and crank"}}) {
    const Model m = read_text(arms + "\n<actuator>" + actuator + "<motor joint='y'/></actuator>");
    CHECK(m.actuators.size() == 1);
    REQUIRE(!m.skipped.empty());
    CHECK_THAT(m.skipped.back(), Contains("text.xml:2: the actuator 'm'") && Contains(reason));
  }
}

TEST_CASE(
    "fixed tendons sum joints, spatial ones run from site to site, and rest where they are not told "
    "otherwise") {
  const Model m = read_text(
      arms +
      "<tendon><fixed name='f' range='0 1' stiffness='2'><joint joint='x' coef='2'/><joint joint='y' "
      "coef='-3'/></fixed><spatial name='p' damping='4'><site site='s'/><site site='t'/></spatial><spatial "
      "name='q' springlength='.5 "
      "2'><site site='t'/><site site='s'/></spatial><spatial name='w'><site site='s'/><pulley "
      "divisor='2'/><site "
      "site='t'/></spatial></tendon><actuator><motor tendon='w'/></actuator>");
  REQUIRE(m.tendons.size() == 3);
  CHECK((m.tendons[0].joints.size() == 2 && m.tendons[0].joints[1].coefficient == -3 &&
         m.tendons[0].is_limited));
  CHECK(m.tendons[1].damping == 4);
  // The spring of x rests at q = 0, a quarter turn before the pose of the file: the site (1, 0, 0) is then at
  // (0, −1, 1), the other at (0, 3, 1).
  CHECK(m.tendons[1].rest_lower == Approx(4));
  CHECK((m.tendons[2].rest_lower == 0.5 && m.tendons[2].rest_upper == 2));
  REQUIRE(m.skipped.size() == 2);
  CHECK_THAT(m.skipped[0], Contains("the tendon 'w' is left out: it has a pulley"));
  CHECK_THAT(m.skipped[1], Contains("so is its tendon"));
  CHECK(m.actuators.empty());
}

TEST_CASE("equalities: points and poses of two bodies as the file has them, sites, joints") {
  const Model m = read_text(
      arms +
      "<equality><connect name='c' body1='a' body2='b' anchor='1 0 0'/><connect site1='s' site2='t'/><weld "
      "body1='b'/><weld body1='a' body2='b' relpose='1 2 3 1 0 0 0' anchor='0 0 1'/><weld site1='s' "
      "site2='t'/><joint joint1='y' joint2='x' polycoef='1 2'/><joint joint1='x' "
      "active='false'/></equality>");
  REQUIRE(m.connects.size() == 2);
  CHECK(m.connects[0].other_point == Vec3(1, -3, 0));
  CHECK((m.connects[1].point == Vec3(1, 0, 0) && m.connects[1].other_point == Vec3(0, 0, 0)));
  REQUIRE(m.welds.size() == 3);
  CHECK((m.welds[0].other == -1 && m.welds[0].pose.position == Vec3(0, -3, -1)));
  CHECK(m.welds[1].pose.position == Vec3(1, 2, 2));  // its anchor, 1 above, is at (1, 2, 3)
  CHECK(m.welds[2].pose.position == Vec3(1, 0, 0));
  REQUIRE(m.couplings.size() == 1);
  CHECK((m.couplings[0].joint == 1 && m.couplings[0].other == 0 &&
         m.couplings[0].coefficients == std::array<double, 5>{1, 2, 0, 0, 0}));
  REQUIRE(m.skipped.size() == 1);
  CHECK_THAT(m.skipped[0], Contains("is not active"));
}

TEST_CASE("pairs have numbers of their own, excludes name bodies or the world") {
  const Model m = read_text(
      "<default><pair friction='.3'/></default><worldbody><geom name='f' type='plane' size='1 1 1' "
      "friction='9'/><body "
      "name='a'><joint/><geom name='g' size='1'/></body></worldbody><contact><pair geom1='f' geom2='g' "
      "condim='6' friction='.5 .5 "
      ".1 .2 .2'/><pair geom1='f' geom2='g'/><exclude body1='world' body2='a'/></contact>");
  REQUIRE(m.pairs.size() == 2);
  CHECK((m.pairs[0].contact_freedoms == 6 && m.pairs[0].friction == 0.5 &&
         m.pairs[0].spinning_friction == 0.1 && m.pairs[0].rolling_friction == 0.2));
  CHECK((m.pairs[1].friction == 0.3 && m.pairs[1].contact_freedoms == 3));
  CHECK((m.excludes[0].body == -1 && m.excludes[0].other == 0));
}

TEST_CASE(
    "a key fills what it does not say from the pose of the file, and drops controls of what is left out") {
  const Model m = read_text(
      "<worldbody><body pos='1 2 3'><freejoint/><geom size='1'/></body><body><joint type='ball'/><geom "
      "size='1'/><body><joint "
      "name='j' ref='.5' type='slide'/><geom size='1'/></body></body></worldbody><actuator><muscle "
      "joint='j'/><general joint='j' "
      "dyntype='filter'/><motor joint='j'/></actuator><keyframe><key name='k' time='3' ctrl='1 2 3' act='4 "
      "5'/></keyframe>");
  REQUIRE(m.keyframes.size() == 1);
  const model::Keyframe& key = m.keyframes[0];
  CHECK(key.time == 3);
  CHECK(key.q == std::vector<double>{1, 2, 3, 1, 0, 0, 0, 1, 0, 0, 0, 0.5});
  CHECK(key.v == std::vector<double>(10, 0));
  CHECK(key.control == std::vector<double>{2, 3});
  CHECK(key.activation == std::vector<double>{5});
  CHECK_THROWS_WITH(read_text("<worldbody><body><joint/><geom size='1'/></body></worldbody><keyframe>\n<key "
                              "qpos='1 2'/></keyframe>"),
                    Contains("text.xml:2: the key must have 1 numbers in qpos"));
}

TEST_CASE("names that mean nothing are refused, and things of the wrong kind") {
  const auto refuses = [](const std::string& inside, const std::string& sentence) {
    CHECK_THROWS_WITH(read_text(arms + "\n" + inside), Contains("text.xml:2: " + sentence));
  };
  refuses("<actuator><motor joint='z'/></actuator>", "there is no joint 'z'");
  refuses("<actuator><motor/></actuator>", "an actuator acts on one joint, tendon or site");
  refuses("<tendon><spatial><site site='s'/></spatial></tendon>", "the path of a tendon needs two sites");
  refuses("<tendon><fixed/></tendon>", "the path of a tendon needs two sites or a joint");
  refuses("<equality><joint joint1='x' joint2='x'/></equality>", "the equality couples a thing to itself");
  refuses("<equality><connect body1='a' body2='b'/></equality>", "connect needs an anchor");
  refuses("<contact><exclude body1='a' body2='c'/></contact>", "there is no body 'c'");
  refuses("<actuator><motor joint='x' class='c'/></actuator>", "there is no class 'c'");
}

}  // namespace mjcf_forces_tests
