// What is no URDF, or one that was damaged: a sentence with file and line, soon, and never a crash.
#include <delassus/adapters/urdf.hpp>

#include "catch.hpp"

#include <chrono>

namespace urdf_bad_tests {

using namespace delassus;
using Catch::Contains;

namespace {

/// A robot that has each element with a number.
const std::string whole = R"(<?xml version="1.0"?>
<robot name="whole" version="1.0">
  <link name="base">
    <inertial>
      <origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/>
      <mass value="2.5"/>
      <inertia ixx="1.25" ixy="0.01" ixz="0.02" iyy="1.5" iyz="0.03" izz="1.75"/>
    </inertial>
    <collision name="one"><origin xyz="0.7 0.8 0.9" rpy="1.1 1.2 1.3"/><geometry><box size="1.4 2.1 2.2"/></geometry></collision>
    <collision><geometry><sphere radius="3.5"/></geometry></collision>
    <collision><geometry><cylinder radius="3.6" length="3.7"/></geometry></collision>
    <collision><geometry><capsule radius="3.8" length="3.9"/></geometry></collision>
    <collision><geometry><mesh filename="absent.stl" scale="4.1 4.2 4.3"/></geometry></collision>
    <contact><lateral_friction value="0.44"/><rolling_friction value="0.45"/><spinning_friction value="0.46"/><restitution value="0.47"/></contact>
  </link>
  <link name="hand"/>
  <link name="arm">
    <inertial><mass value="5.1"/><inertia ixx="5.2" ixy="0" ixz="0" iyy="5.3" iyz="0" izz="5.4"/></inertial>
  </link>
  <link name="finger">
    <inertial><mass value="6.1"/><inertia ixx="6.2" ixy="0" ixz="0" iyy="6.3" iyz="0" izz="6.4"/></inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="arm"/>
    <origin xyz="7.1 7.2 7.3" rpy="0.74 0.75 0.76"/>
    <axis xyz="0.77 0.78 0.79"/>
    <limit lower="-8.1" upper="8.2" effort="8.3" velocity="8.4"/>
    <dynamics damping="8.5" friction="8.6"/>
  </joint>
  <joint name="wrist" type="fixed"><parent link="arm"/><child link="hand"/></joint>
  <joint name="grip" type="prismatic">
    <parent link="hand"/><child link="finger"/>
    <limit lower="0" upper="9.1" effort="9.2" velocity="9.3"/>
    <mimic joint="shoulder" multiplier="9.4" offset="9.5"/>
  </joint>
</robot>
)";

/// Starts with the file and a line of it.
bool says_where(const std::string& sentence) {
  const std::string start = "delassus: bad.urdf:";
  return sentence.compare(0, start.size(), start) == 0 && sentence[start.size()] >= '1' &&
         sentence[start.size()] <= '9';
}

std::string refusal(const std::string& text) {
  try {
    check(parse_urdf(text, "bad.urdf"));
  } catch (const InvalidArgument& refused) {
    INFO(refused.what());
    CHECK(says_where(refused.what()));
    return refused.what();
  }
  return "";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != text.npos);
  return text.replace(at, from.size(), to);
}

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Where numbers of attributes stand: each run of digits, points and signs that begins after a quote or a
/// blank.
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  const std::string digits = "-0123456789.";
  for (std::size_t i = std::max<std::size_t>(1, text.find("<link")); i < text.size(); ++i) {
    if ((text[i - 1] != '"' && text[i - 1] != ' ') || digits.find(text[i]) == text.npos) continue;
    const std::size_t end = std::min(text.find_first_not_of(digits, i), text.size());
    found.emplace_back(i, end - i);
    i = end;
  }
  return found;
}

}  // namespace

TEST_CASE("a whole robot is read, whose every number is refused when it is not finite or too large") {
  CHECK(refusal(whole) == "");
  const auto numbers = numbers_in(whole);
  CHECK(numbers.size() == 69);
  for (const auto& [at, length] : numbers)
    for (const char* bad :
         {"nan", "inf", "-inf", "1e308", "-1e308", "1e999", "0x10", "1e", "", "--1", "1,5"}) {
      std::string text = whole;
      text.replace(at, length, bad);
      INFO(bad << " at line " << 1 + std::count(whole.begin(), whole.begin() + std::ptrdiff_t(at), '\n'));
      CHECK(refusal(text) != "");
    }
}

TEST_CASE("numbers that only their sum spoils are refused too") {
  CHECK_THAT(refusal(with(whole, "\"2.5\"", "\"-2.5\"")),
             Contains("bad.urdf:3: the mass of link 'base' is -2.5 kg"));
  CHECK_THAT(refusal(with(whole, "\"8.5\"", "\"-8.5\"")),
             Contains("damping and friction of joint 'shoulder' must be >= 0"));
  CHECK_THAT(refusal(with(whole, "\"8.3\"", "\"-8.3\"")),
             Contains("effort and velocity of joint 'shoulder'"));
  CHECK_THAT(refusal(with(whole, "0.77 0.78 0.79", "0 0 0")),
             Contains("the axis of joint 'shoulder' is zero"));
  CHECK_THAT(refusal(with(whole, "\"0.47\"", "\"1.5\"")), Contains("<restitution> must be in [0, 1]"));
  CHECK_THAT(refusal(with(whole, "4.1 4.2 4.3", "4.1 0 4.3")),
             Contains("bad.urdf:13: the scale of mesh 'absent.stl' must not be zero"));
  CHECK(refusal(with(whole, "0.77 0.78 0.79", "1e-40 0 0")) == "");
}

TEST_CASE("links and joints that are no tree are refused at the line of one of them") {
  CHECK_THAT(refusal(with(whole, "\"hand\"", "\"base\"")),
             Contains("16: a second link is called 'base'; the first one stands on line 3"));
  CHECK_THAT(refusal(with(whole, "\"wrist\"", "\"grip\"")), Contains("a second joint is called 'grip'"));
  CHECK_THAT(refusal(with(whole, "<child link=\"arm\"", "<child link=\"leg\"")),
             Contains("24: there is no link 'leg'"));
  CHECK_THAT(refusal(with(whole, "<parent link=\"base\"/>", "")),
             Contains("joint 'shoulder' has no <parent>"));
  CHECK_THAT(refusal(with(whole, "<child link=\"hand\"", "<child link=\"arm\"")),
             Contains("link 'arm' is the child of joint 'shoulder' already"));
  CHECK_THAT(refusal(with(whole, "<parent link=\"base\"", "<parent link=\"finger\"")),
             Contains("'hand' does not hang on the root 'base'") && Contains("run in a circle"));
  CHECK_THAT(refusal(with(whole, "<robot name=\"whole\" version=\"1.0\">",
                          "<robot name=\"whole\"><link name=\"stray\"/>")),
             Contains("links 'stray' and 'base' have no parent"));
  CHECK_THAT(refusal("<robot name='r'><link name='a'/><joint name='j' type='fixed'><parent link='a'/><child "
                     "link='a'/></joint></robot>"),
             Contains("there is no root"));
}

TEST_CASE("what is no URDF is refused") {
  CHECK_THAT(refusal(""), Contains("bad.urdf:1: this is no XML"));
  CHECK_THAT(refusal("<mujoco/>"), Contains("a URDF begins with the element <robot>"));
  CHECK_THAT(refusal("<robot/>"), Contains("<robot> needs the attribute 'name'"));
  CHECK_THAT(refusal("<robot name='r'/>"), Contains("the robot has no <link>"));
  CHECK_THAT(refusal("<robot name='r'><link name='a'/></robot>\n<robot/>"),
             Contains("bad.urdf:2: a second element stands beside <robot>"));
  CHECK_THAT(refusal(with(whole, "\"1.0\">", "\"2.0\">")), Contains("version '2.0' of URDF"));
  CHECK_THAT(refusal("<robot name='r'>\n" + std::string(1, '\0') + "</robot>"),
             Contains("bad.urdf:2: a zero byte"));
  CHECK_THROWS_WITH(read_urdf("/nowhere/r.urdf"), Contains("cannot open '/nowhere/r.urdf'"));
  for (std::size_t length = 0; length < whole.size() - 1; length += 7)
    CHECK(refusal(whole.substr(0, length)) != "");
}

TEST_CASE("an element that has lost its bracket is named or refused where one is strict") {
  const std::string text = with(whole, "<dynamics", "dynamics");
  const Model model = parse_urdf(text, "bad.urdf");
  CHECK(std::count(model.skipped.begin(), model.skipped.end(),
                   "bad.urdf:28: 'dynamics damping=\"8.5\" friction=\"8.6\"/>' in <joint> is no element") == 1);
  CHECK_THROWS_WITH(parse_urdf(text, "bad.urdf", {.strict = true}), Contains("is no element"));
}

TEST_CASE("deep, wide and long files are refused or read within a second") {
  std::string deep = "<robot name='r'>", wide = deep, chain = deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  for (int i = 0; i < 3000000; ++i) wide += "<a/>";
  CHECK(seconds_of([&] { CHECK_THAT(refusal(deep), Contains("ELEMENT_DEPTH")); }) < 1);
  CHECK(seconds_of([&] { CHECK_THAT(refusal(wide + "</robot>"), Contains("more than 400000")); }) < 1);
  const int links = 10000;
  for (int i = 0; i < links; ++i) {
    const std::string n = std::to_string(i), before = std::to_string(i - 1);
    chain += "<link name='" + n +
             "'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
             "izz='1'/></inertial></link>";
    if (i > 0)
      chain += "<joint name='" + n + "' type='continuous'><parent link='" + before + "'/><child link='" + n +
               "'/></joint>";
  }
  CHECK(seconds_of([&] { CHECK(parse_urdf(chain + "</robot>", "chain.urdf").bodies.size() == links); }) < 5);
}

TEST_CASE("nothing is written on the console, and its handler is the user's again") {
  struct Listener : console_bridge::OutputHandler {
    int lines = 0;
    void log(const std::string&, console_bridge::LogLevel, const char*, int) override { ++lines; }
  } listener;
  console_bridge::useOutputHandler(&listener);
  CHECK(refusal(with(whole, " radius=\"3.5\"", "")) != "");
  CHECK(listener.lines == 0);
  CHECK(console_bridge::getOutputHandler() == &listener);
  console_bridge::restorePreviousOutputHandler();
}

}  // namespace urdf_bad_tests
