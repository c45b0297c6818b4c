// What is no machine is refused in a second, in a sentence with file and line.
#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cctype>
#include <ctime>

namespace mjcf_bad_input_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

/// A machine with a little of everything.
const std::string machine = R"(<mujoco model="m">
<compiler angle="degree" settotalmass="7" boundmass=".001" boundinertia="1e-9" inertiagrouprange="0 5"/>
<option timestep=".005" gravity="0 0 -9" density="0" viscosity="0" wind="0 0 0" tolerance="1e-8"/>
<size memory="1M" njmax="100"/>
<visual><map znear=".01"/></visual>
<default><geom density="900" friction=".7 .01 .001" solref=".02 1"/><default class="c"><joint damping=".1"/></default></default>
<asset><mesh name="w" vertex="0 0 0 1 0 0 0 1 0 0 0 1" scale=".1 .2 .3" refpos="0 0 .1" refquat="1 0 0 0"/>
<mesh name="s" builtin="supersphere" params="6 .5 .7"/>
<hfield name="h" nrow="2" ncol="2" size="1 1 .5 .1" elevation="0 1 2 3"/></asset>
<worldbody><light pos="0 0 3"/><geom type="plane" size="1 1 1" rgba="1 1 0 1"/><geom type="hfield" hfield="h"/>
<body name="a" pos="0 0 1" euler="10 20 30" gravcomp=".5"><freejoint/><geom name="g" size=".1"/>
<body name="b" pos=".1 0 0" childclass="c"><inertial pos="0 0 .1" mass="2" diaginertia="1 1 1"/>
<joint name="j" axis="0 1 0" pos="0 0 .1" range="-40 50" ref="5" springref="3" stiffness="2" armature=".1" frictionloss=".01"/>
<geom type="capsule" fromto="0 0 0 0 0 .3" size=".05" mass="1" surfacevel="1 0 0 0 0 1"/><site name="p" pos="0 0 .2"/></body></body>
<replicate count="3" offset="1 0 0" euler="0 0 20"><body name="r" pos="0 2 1"><joint name="k" type="slide" axis="0 0 1"/>
<geom type="mesh" mesh="w" zaxis="0 1 1"/><geom type="mesh" mesh="s" quat="1 1 0 0"/></body></replicate></worldbody>
<tendon><fixed name="f" range="-1 1" springlength=".1 .2"><joint joint="j" coef="2"/></fixed></tendon>
<equality><weld body1="b" body2="r0" relpose="0 0 1 1 0 0 0"/><joint joint1="j" joint2="k1" polycoef="0 1 0 0 0"/></equality>
<actuator><general joint="j" gear="2" ctrlrange="-1 1" forcerange="-9 9" dyntype="filter" dynprm=".1" gainprm="3" biastype="affine"
 biasprm="0 -3 -1"/><position tendon="f" kp="3" kv="1"/></actuator>
<contact><exclude body1="a" body2="r0"/></contact>
<keyframe><key name="x" time="1" qpos="0 0 1 1 0 0 0 .1 0 0 0" qvel="0 0 0 0 0 0 0 0 0 0" ctrl="1 2" act="3"/></keyframe>
</mujoco>)";

/// Seconds of this processor, however busy the machine is; a tenth of them under the address sanitizer.
class Clock {
 public:
  double seconds() const { return double(std::clock() - start_) / CLOCKS_PER_SEC / slower; }

 private:
#if defined(__SANITIZE_ADDRESS__)
  static constexpr double slower = 10;
#elif defined(__has_feature)
  static constexpr double slower = __has_feature(address_sanitizer) ? 10 : 1;
#else
  static constexpr double slower = 1;
#endif
  std::clock_t start_ = std::clock();
};

/// Reads, or refuses with file and line; either within a second.
void expect_sentence_or_machine(const std::string& text, const std::string& name = "bad.xml") {
  const Clock clock;
  try {
    parse_mjcf(text, name);
  } catch (const InvalidArgument& error) {
    const std::string sentence = error.what();
    CAPTURE(sentence);
    const std::size_t at = sentence.find(".xml:");
    CHECK((at != std::string::npos && std::isdigit(static_cast<unsigned char>(sentence[at + 5]))));
  }
  CHECK(clock.seconds() < 1);
}

/// Where the numbers of a text stand: within quotes, as words of digits.
std::vector<std::pair<std::size_t, std::size_t>> numbers_of(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  bool in_value = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') in_value = !in_value;
    if (!in_value || std::string("\" \n").find(text[i]) == std::string::npos) continue;
    const std::size_t first = i + 1, end = text.find_first_of("\" \n", first);
    if (end > first &&
        text.substr(first, end - first).find_first_not_of("0123456789.e-+") == std::string::npos)
      found.emplace_back(first, end - first);
  }
  return found;
}

}  // namespace

TEST_CASE("NaN, an infinity or 1e308 in place of any number is refused with its line") {
  REQUIRE(parse_mjcf(machine, "good.xml").bodies.size() == 5);
  const auto numbers = numbers_of(machine);
  REQUIRE(numbers.size() > 180);
  for (const auto& [at, size] : numbers)
    for (const char* odd : {"nan", "-inf", "1e308", "1e999"}) {
      std::string text = machine;
      text.replace(at, size, odd);
      const std::string line =
          std::to_string(1 + std::count(machine.begin(), machine.begin() + std::ptrdiff_t(at), '\n'));
      CAPTURE(odd, line, machine.substr(at > 20 ? at - 20 : 0, 40));
      // A tag may begin a line before the attribute.
      CHECK_THROWS_WITH(parse_mjcf(text, "bad.xml"),
                        Contains("delassus: bad.xml:") && Contains(std::string("'") + odd + "'"));
    }
}

TEST_CASE("other odd numbers give a sentence with file and line, or a machine") {
  for (const auto& [at, size] : numbers_of(machine))
    for (const char* odd : {"0", "-1", "1e30", "-1e30", "1e-300", "999999999", "x", "", "1 2", "0.5"}) {
      std::string text = machine;
      text.replace(at, size, odd);
      CAPTURE(odd, machine.substr(at > 20 ? at - 20 : 0, 40));
      expect_sentence_or_machine(text);
    }
}

TEST_CASE("what would grow beyond all bounds is refused") {
  const auto refuses = [](const std::string& inside, const std::string& sentence) {
    const Clock clock;
    CHECK_THROWS_WITH(parse_mjcf("<mujoco>\n" + inside + "</mujoco>", "big.xml"),
                      Contains("big.xml:") && Contains(sentence));
    CHECK(clock.seconds() < 1);
  };
  refuses("<worldbody><replicate count='1000000000'><geom size='1'/></replicate></worldbody>",
          "grows beyond 200000 elements");
  refuses("<worldbody><replicate count='1000000000'/></worldbody>", "grows beyond 200000 elements");
  refuses("<worldbody><replicate count='10000000000'/></worldbody>", "is no whole number of 32 bits");
  refuses(
      "<worldbody><replicate count='9999'><replicate "
      "count='9999'><site/></replicate></replicate></worldbody>",
      "grows beyond 200000 elements");
  // Each frame holds the one before twice.
  std::string frames = "<worldbody><frame name='f0'><geom size='1'/></frame>";
  for (int i = 1; i < 60; ++i) {
    const std::string attach = "<attach frame='f" + std::to_string(i - 1) + "' prefix='";
    frames += "<frame name='f" + std::to_string(i) + "'>" + attach + "a'/>" + attach + "b'/></frame>";
  }
  refuses(frames + "</worldbody>", "grows beyond 200000 elements");
  refuses(
      "<asset><mesh name='m' builtin='supersphere' params='100000 1 1'/></asset><worldbody><geom type='mesh' "
      "mesh='m'/></worldbody>",
      "grows beyond the 3e+06 points");
  refuses(
      "<asset><hfield name='h' nrow='2000000000' ncol='2000000000' size='1 1 1 1'/></asset><worldbody><geom "
      "type='hfield' "
      "hfield='h'/></worldbody>",
      "grows beyond the 3e+06 points");
  std::string deep = "<worldbody>", end = "</worldbody>";
  for (int i = 0; i < 100000; ++i) deep += "<body>", end = "</body>" + (i < 1 ? end : "");
  refuses(deep, "deeper than tinyxml2 reads");
  const Model few =
      parse_mjcf("<mujoco><worldbody><replicate count='9'><geom size='1'/></replicate></worldbody></mujoco>",
                 "a.xml", {.most_elements = 19});
  CHECK(few.geometries.size() == 9);
}

TEST_CASE("what is not known, in the wrong place or not XML is refused with its line") {
  const auto refuses = [](const std::string& text, const std::string& sentence) {
    CHECK_THROWS_WITH(parse_mjcf(text, "odd.xml"), Contains("odd.xml:" + sentence));
  };
  refuses("<mujoco>\n<worldbody>\n<bdy/></worldbody></mujoco>",
          "3: an element 'bdy' is not known within 'body'");
  refuses("<mujoco>\n<worldbody><geom sice='1'/></worldbody></mujoco>",
          "2: an attribute 'sice' is not known for 'geom'");
  refuses("<mujoco><default>\n<default class='a'><geom pos='1'/></default></default></mujoco>",
          "2: attribute 'pos' of geom has 1 numbers");
  refuses("<mujoco><default>\n<body/></default></mujoco>", "2: an element 'body'");
  refuses("<mujoco>\n<default><default/></default></mujoco>", "2: default needs the attribute 'class'");
  refuses("<mujoco>\n\n<worldbody>", "3: this is no XML");
  refuses("<mujoco/>\n<mujoco/>", "2: an element 'mujoco' stands beside 'mujoco'");
  refuses("<mujoco><worldbody>\n<geom size='1' contype='-2147483649'/></worldbody></mujoco>", "2: '-2147483649' in attribute 'contype'");
  refuses("", "1: this is no XML");
  refuses("<robot/>", "1: the first element is 'robot'");
  refuses("<mujoco><compiler coordinate='global'/></mujoco>", "1: coordinate='global' is not read");
  refuses("<mujoco><worldbody>\n<geom type='bal' size='1'/></worldbody></mujoco>",
          "2: 'bal' in attribute 'type' of geom is none of");
  refuses("<mujoco><worldbody>\n<geom size='0'/></worldbody></mujoco>", "2: size 1 of the geom is 0");
  refuses("<mujoco><worldbody>\n<joint/></worldbody></mujoco>", "2: the world has no joints");
  refuses("<mujoco><worldbody><body>\n<freejoint/><joint/><geom size='1'/></body></worldbody></mujoco>",
          "2: a free joint must be the only one");
  refuses("<mujoco><worldbody><body><body>\n<freejoint/><geom size='1'/></body></body></worldbody></mujoco>",
          "2: a free joint is for a child of the world");
  refuses("<mujoco><worldbody><body name='a'/>\n<body name='a'/></worldbody></mujoco>",
          "2: the name 'a' is given to two");
  refuses("<mujoco><worldbody>\n<geom type='mesh' mesh='m'/></worldbody></mujoco>",
          "2: there is no mesh 'm'");
  refuses(
      "<mujoco><asset>\n<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 1 1 0'/></asset><worldbody><geom "
      "type='mesh' mesh='m'/></worldbody></mujoco>",
      "2: the mesh has no hull");
}

TEST_CASE("an element that has lost its bracket is named or refused where one is strict") {
  const std::string text = "<mujoco><worldbody>\n<geom size='1'/>\ngeom size='2'/></worldbody></mujoco>";
  const Model model = parse_mjcf(text, "odd.xml");
  REQUIRE(model.skipped.size() == 1);
  CHECK(model.skipped[0] == "odd.xml:3: 'geom size='2'/>' in worldbody is no element, and is passed over");
  CHECK_THROWS_WITH(parse_mjcf(text, "odd.xml", {.strict = true}), Contains("odd.xml:3: 'geom size='2'/>' in worldbody is no element"));
}

}  // namespace mjcf_bad_input_tests
