// URDF files that are damaged or mean harm: a machine that is whole, or a sentence with file and line, soon and in little memory.
#include <delassus/adapters/urdf.hpp>

#include "adapters/bad_files.hpp"

namespace urdf_harm_tests {

using namespace delassus;
using namespace delassus::bad_files;

namespace {

/// A robot that has each element with a number.
const File own{"own.urdf", R"(<?xml version="1.0"?>
<robot name="whole" version="1.0">
  <link name="base">
    <inertial>
      <origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/>
      <mass value="2.5"/>
      <inertia ixx="1.25" ixy="0.01" ixz="0.02" iyy="1.5" iyz="0.03" izz="1.75"/>
    </inertial>
    <visual><geometry><box size="1 1 1"/></geometry></visual>
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
  <link name="plate">
    <inertial><mass value="1.1"/><inertia ixx="1.2" ixy="0" ixz="0" iyy="1.3" iyz="0" izz="1.4"/></inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="arm"/>
    <origin xyz="7.1 7.2 7.3" rpy="0.74 0.75 0.76"/>
    <axis xyz="0.77 0.78 0.79"/>
    <limit lower="-8.1" upper="8.2" effort="8.3" velocity="8.4"/>
    <dynamics damping="8.5" friction="8.6"/>
  </joint>
  <joint name="wrist" type="fixed"><origin xyz="0.1 0 0" rpy="0 0 0.1"/><parent link="arm"/><child link="hand"/></joint>
  <joint name="grip" type="prismatic">
    <parent link="hand"/><child link="finger"/>
    <limit lower="0" upper="9.1" effort="9.2" velocity="9.3"/>
    <mimic joint="shoulder" multiplier="9.4" offset="9.5"/>
  </joint>
  <joint name="table" type="planar"><parent link="base"/><child link="plate"/><axis xyz="0 1 2"/></joint>
</robot>
)"};

Model read(const std::string& text, const std::string& name) { return parse_urdf(text, name); }

/// What the text holds is in the model, or named as passed over.
void expect_whole(const Model& model, const std::string& text) {
  tinyxml2::XMLDocument xml;
  REQUIRE(xml.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement& root = *xml.RootElement();
  std::size_t heavy = 0, moving = 0, collisions = 0, mimics = 0, texts = 0;
  const auto texts_in = [&](const tinyxml2::XMLElement& e) {
    for (const auto* node = e.FirstChild(); node; node = node->NextSibling()) texts += node->ToText() || node->ToUnknown();
  };
  texts_in(root);
  for (const auto* link = root.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    texts_in(*link);
    const auto* inertial = link->FirstChildElement("inertial");
    const auto* mass = inertial ? inertial->FirstChildElement("mass") : nullptr;
    heavy += mass && mass->DoubleAttribute("value") > 0;
    for (const auto* c = link->FirstChildElement("collision"); c; c = c->NextSiblingElement("collision")) ++collisions, texts_in(*c);
  }
  for (const auto* joint = root.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
    const std::string type = joint->Attribute("type");
    texts += texts_below(*joint);
    moving += type == "fixed" ? 0 : type == "planar" ? 3 : 1;
    mimics += joint->FirstChildElement("mimic") != nullptr;
  }
  CHECK(model.bodies.size() == heavy);
  // A free base is a joint besides.
  CHECK((model.joints.size() == moving || model.joints.size() == moving + 1));
  CHECK(model.geometries.size() + skipped_for(model, "collision") >= collisions);
  CHECK(model.couplings.size() + skipped_for(model, "mimic") >= mimics);
  CHECK(skipped_for(model, "is no element") >= texts);
}

}  // namespace

TEST_CASE("numbers that no reckoning bears are refused with their line or do no harm") {
  CHECK(read(own.text, own.path).joints.size() == 6);
  CHECK(numbers_of(own.text).size() > 80);
  expect_no_number_gets_through(read, own, true);
  for (const File& other : files_of_others("urdf", ".urdf")) expect_no_number_gets_through(read, other, false);
}

TEST_CASE("mutilated files are refused with file and line or are machines that lack nothing") {
  std::vector<File> files = files_of_others("urdf", ".urdf");
  files.push_back(own);
  Random random(38);
  int count = 0, are_refused = 0;
  for (const File& file : files)
    for (int copy = 0; copy < (file.path == own.path ? 400 : 40); ++copy, ++count) {
      const std::string text = mutilated(file.text, random);
      CAPTURE(file.path, copy);
      const Answer answer = expect_model_or_sentence(read, text, file.path);
      are_refused += !answer.is_model;
      if (answer.is_model) expect_whole(answer.model, text);
    }
  CHECK(are_refused > 100);
  CHECK(count - are_refused > 20);
}

TEST_CASE("files that are deep or long without end are refused in a second and 200 MB") {
  const auto refuses = [](const std::string& inside, const std::string& sentence) {
    expect_refused_soon(read, "<robot name='r'>\n" + inside + "</robot>", "big.urdf", sentence);
  };
  const auto times = [](const std::string& word, int n) {
    std::string all;
    for (int i = 0; i < n; ++i) all += word;
    return all;
  };
  refuses(times("<link name='a'>", 190000), "ELEMENT_DEPTH");
  refuses(times("<a>", 390000), "ELEMENT_DEPTH");
  refuses(times("<link/>", 3000000), "more than 400000");
  refuses(times("<link name='a'/>", 190000), "a second link is called 'a'");
  refuses(times("<a/>", 390000), "the robot has no <link>");
  refuses("<link name='" + std::string(40000000, 'a') + "'/>", "longer than 16 MiB");
  refuses("<link name='a'><collision><geometry><box size='" + times("1 ", 8000000) + "'/></geometry></collision></link>", "and must have 3");
  refuses("<link name='a'/><joint name='" + std::string(16000000, 'a') + "' type='none'/>", "joint 'aaaa");
  // All is well until urdfdom has read it.
  const std::string joint = "<link name='b'/><joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>";
  refuses("<link name='a'>" + times("<collision><geometry><sphere radius='1'/></geometry></collision>", 60000) + "</link>" + joint,
          "urdfdom does not take joint 'j'");
  std::string many = "<link name='a'/>";
  for (int i = 0; i < 30000; ++i) {
    const std::string n = std::to_string(i);
    many += "<link name='" + n + "'/><joint name='" + n + "' type='fixed'><parent link='a'/><child link='" + n + "'/></joint>";
  }
  refuses(many + joint, "urdfdom does not take joint 'j'");
  std::string attributes, links, joints, meshes;
  for (int i = 0; i < 190000; ++i) attributes += " a" + std::to_string(i) + "='<'";
  refuses("\n<link" + attributes + "/>", "big.urdf:3: a tag has more than 200 attributes");
  // A ring of links, and one of massless links.
  for (int i = 0; i < 30000; ++i) {
    const std::string n = std::to_string(i), next = std::to_string((i + 1) % 30000);
    links += "<link name='" + n + "'/>";
    joints += "<joint name='" + n + "' type='fixed'><parent link='" + n + "'/><child link='" + next + "'/></joint>";
  }
  refuses(links + joints, "the joints run in a circle");
  refuses(links + "<link name='last'/>" + joints + "<joint name='last' type='fixed'><parent link='last'/><child link='last'/></joint>", "circle");
  refuses(links, "have no parent");
}

}  // namespace urdf_harm_tests
