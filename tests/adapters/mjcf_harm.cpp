// MJCF files that are damaged or mean harm: a machine that is whole, or a sentence with file and line, soon and in little memory.
#include <delassus/adapters/mjcf.hpp>

#include "adapters/bad_files.hpp"
#include "scratch_path.hpp"

namespace mjcf_harm_tests {

using namespace delassus;
using namespace delassus::bad_files;

namespace {

/// A machine with a little of everything.
const File own{"own.xml", R"(<mujoco model="m">
<compiler angle="degree" settotalmass="7" boundmass=".001" boundinertia="1e-9" inertiagrouprange="0 5"/>
<option timestep=".005" gravity="0 0 -9" density="0" viscosity="0" wind="0 0 0" tolerance="1e-8"/>
<size memory="1M" njmax="100"/>
<default><geom density="900" friction=".7 .01 .001" solref=".02 1"/><default class="c"><joint damping=".1"/></default></default>
<asset><mesh name="w" vertex="0 0 0 1 0 0 0 1 0 0 0 1" scale=".1 .2 .3" refpos="0 0 .1" refquat="1 0 0 0"/>
<hfield name="h" nrow="2" ncol="2" size="1 1 .5 .1" elevation="0 1 2 3"/></asset>
<worldbody><geom type="plane" size="1 1 1"/><geom type="hfield" hfield="h"/>
<body name="a" pos="0 0 1" euler="10 20 30" gravcomp=".5"><freejoint/><geom name="g" size=".1" contype="-2147483648" priority="2"/>
<body name="b" pos=".1 0 0" childclass="c"><inertial pos="0 0 .1" mass="2" diaginertia="1 1 1" axisangle="0 0 1 20"/>
<joint name="j" axis="0 1 0" pos="0 0 .1" range="-40 50" ref="5" springref="3" stiffness="2" armature=".1" frictionloss=".01"/>
<geom type="capsule" fromto="0 0 0 0 0 .3" size=".05" mass="1"/><site name="p" pos="0 0 .2"/>
<geom name="g2" type="box" size=".1 .1 .1" xyaxes="1 0 0 0 1 0"/></body></body>
<body name="d" pos="0 2 1"><joint name="k" type="slide" axis="0 0 1"/><inertial pos="0 0 .1" mass="2" fullinertia="1 1 1 .1 .1 .1"/>
<geom type="mesh" mesh="w" zaxis="0 1 1"/><site name="s" pos="0 0 .1" quat="1 1 0 0"/></body></worldbody>
<tendon><fixed name="f" range="-1 1" springlength=".1 .2"><joint joint="j" coef="2"/></fixed>
<spatial name="t" stiffness="3" damping="1"><site site="p"/><site site="s"/></spatial></tendon>
<equality><weld body1="b" body2="d" relpose="0 0 1 1 0 0 0"/><joint joint1="j" joint2="k" polycoef="0 1 0 0 0"/>
<connect body1="a" body2="d" anchor=".1 .2 .3"/></equality>
<actuator><general joint="j" gear="2" ctrlrange="-1 1" forcerange="-9 9" dyntype="filter" dynprm=".1" gainprm="3" biastype="affine"
 biasprm="0 -3 -1"/><position tendon="f" kp="3" kv="1"/><velocity joint="k" kv="2"/></actuator>
<contact><exclude body1="a" body2="d"/><pair geom1="g" geom2="g2" friction="1 1 .1 .1 .1"/></contact>
<keyframe><key name="x" time="1" qpos="0 0 1 1 0 0 0 .1 0" qvel="0 0 0 0 0 0 0 0" ctrl="1 2 3" act="3"/></keyframe>
</mujoco>)"};

Model read(const std::string& text, const std::string& name) { return parse_mjcf(text, name); }

/// How many elements of the words there are below one.
std::size_t count_of(const tinyxml2::XMLElement& in, std::initializer_list<std::string_view> words) {
  std::size_t count = 0;
  for (const auto* e = in.FirstChildElement(); e; e = e->NextSiblingElement())
    count += std::size_t(std::count(words.begin(), words.end(), e->Name())) + count_of(*e, words);
  return count;
}
std::size_t count_in(const tinyxml2::XMLElement& root, const char* section, std::initializer_list<std::string_view> words) {
  std::size_t count = 0;
  for (const auto* e = root.FirstChildElement(section); e; e = e->NextSiblingElement(section)) count += count_of(*e, words);
  return count;
}

/// What the text holds is in the model, or named as left out.
void expect_whole(const Model& model, const std::string& text) {
  tinyxml2::XMLDocument xml;
  REQUIRE(xml.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement& root = *xml.RootElement();
  if (count_of(root, {"include", "replicate", "attach"}) > 0) return;
  const std::size_t skipped = model.skipped.size();
  std::size_t texts = 0;
  for (const char* section : {"worldbody", "tendon", "equality", "actuator", "contact", "keyframe"})
    for (const auto* e = root.FirstChildElement(section); e; e = e->NextSiblingElement(section)) texts += texts_below(*e);
  CHECK(skipped_for(model, "is no element") >= texts);
  const auto expect = [&](std::size_t made, std::size_t wanted) {
    CAPTURE(made, wanted, skipped);
    CHECK(made <= wanted);
    CHECK(made + skipped >= wanted);
  };
  CHECK(model.bodies.size() == count_in(root, "worldbody", {"body"}));
  CHECK(model.joints.size() == count_in(root, "worldbody", {"joint", "freejoint"}));
  CHECK(model.sites.size() == count_in(root, "worldbody", {"site"}));
  expect(model.geometries.size(), count_in(root, "worldbody", {"geom"}));
  expect(model.tendons.size(), count_in(root, "tendon", {"fixed", "spatial"}));
  expect(model.excludes.size() + model.pairs.size(), count_in(root, "contact", {"exclude", "pair"}));
}

}  // namespace

TEST_CASE("numbers that no reckoning bears are refused with their line or do no harm") {
  File file = own;
  REQUIRE(read(file.text, file.path).pairs.size() == 1);
  const auto numbers = numbers_of(file.text);
  CHECK(numbers.size() > 190);
  expect_no_number_gets_through(read, file, true);
  for (const File& other : files_of_others("mjcf", ".xml")) expect_no_number_gets_through(read, other, false);
}

TEST_CASE("mutilated files are refused with file and line or are machines that lack nothing") {
  std::vector<File> files = files_of_others("mjcf", ".xml");
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

TEST_CASE("files that would grow without end are refused in a second and 200 MB") {
  const auto refuses = [](const std::string& inside, const std::string& sentence) {
    expect_refused_soon(read, "<mujoco>\n" + inside + "</mujoco>", "big.xml", sentence);
  };
  const auto times = [](const std::string& word, int n) {
    std::string all;
    for (int i = 0; i < n; ++i) all += word;
    return all;
  };
  refuses("<worldbody><replicate count='1000000000'><geom size='1'/></replicate></worldbody>", "grows beyond 200000 elements");
  refuses("<worldbody><replicate count='199999'><replicate count='199999'><site/></replicate></replicate></worldbody>", "grows beyond");
  refuses("<worldbody>" + times("<replicate count='2'>", 40) + "<site/>" + times("</replicate>", 40) + "</worldbody>", "grows beyond");
  refuses("<worldbody>" + times("<body>", 400000) + "</worldbody>", "deeper than tinyxml2 reads");
  refuses(times("<default class='a'>", 400000), "deeper than tinyxml2 reads");
  refuses("<worldbody>" + times("<geom/>", 3000000) + "</worldbody>", "raise MjcfOptions::most_elements");
  refuses("<worldbody>" + times("<geom/>", 190000) + "</worldbody>", "size 1 of the geom is 0");
  refuses("<worldbody><geom size='" + times("1 ", 4900000) + "'/></worldbody>", "and must have 1 to 3");
  refuses("<worldbody><geom size='" + times("1 ", 20000000) + "'/></worldbody>", "raise MjcfOptions::most_elements");
  refuses("<worldbody><geom size='1' size='1'/></worldbody>", "XML_ERROR_PARSING_ATTRIBUTE");
  std::string attributes;
  for (int i = 0; i < 300000; ++i) attributes += " a" + std::to_string(i) + "='<'";
  refuses("<worldbody>\n<geom" + attributes + "/></worldbody>", "big.xml:3: a tag has more than 200 attributes");
  refuses("<asset><mesh name='m' vertex='" + times("0 ", 4900000) + "'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody>",
          "no multiple of 3");
  refuses("<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='" + times("0 ", 4800000) +
          "'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody>", "which is no volume");
  refuses("<asset><hfield name='h' nrow='2' ncol='2' size='1 1 1 1' elevation='" + times("0 ", 4900000) +
          "'/></asset><worldbody><geom type='hfield' hfield='h'/></worldbody>", "must have nrow * ncol = 4");
  refuses("<worldbody><body name='" + std::string(1000000, 'a') + "'><replicate count='100000'><site name='b'/></replicate></body></worldbody>",
          "raise");
  refuses("<worldbody><replicate count='199' sep='" + std::string(1000000, 'a') + "'><site name='b'/></replicate></worldbody>",
          "letters");
}

TEST_CASE("files that hold themselves are refused in a second and 200 MB") {
  const std::filesystem::path folder = scratch_path("mjcf_harm");
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& text) { std::ofstream(folder / name) << "<mujoco>\n" << text << "</mujoco>"; };
  const auto refuses = [&](const std::string& name, const std::string& sentence) {
    expect_refused_soon([](const std::string&, const std::string& path) { return read_mjcf(path); }, "", (folder / name).string(), sentence);
  };
  write("self.xml", "<include file='self.xml'/>");
  refuses("self.xml", "is included already");
  write("a.xml", "<worldbody><include file='b.xml'/></worldbody>");
  write("b.xml", "<body><include file='./a.xml'/></body>");
  refuses("a.xml", "is included already");
  write("m.xml", "<asset><model name='n' file='m.xml'/></asset><worldbody><attach model='n' prefix='p'/></worldbody>");
  refuses("m.xml", "has itself among its assets");
  // Each file holds the next one twice.
  for (int i = 0; i < 30; ++i) {
    const std::string next = std::to_string(i + 1);
    write("f" + std::to_string(i) + ".xml", "<asset><model name='n' file='f" + next + ".xml'/></asset><worldbody><attach model='n' prefix='a'/>"
                                            "<attach model='n' prefix='b'/></worldbody>");
  }
  write("f30.xml", "<worldbody><geom size='1'/></worldbody>");
  refuses("f0.xml", "grows beyond 200000 elements");
  // A chain of files, each deeper than the one before.
  for (int i = 0; i < 600; ++i)
    std::ofstream(folder / ("c" + std::to_string(i) + ".xml"))
        << "<mujoco><body><include file='c" << i + 1 << ".xml'/></body></mujoco>";
  write("chain.xml", "<worldbody><include file='c0.xml'/></worldbody>");
  refuses("chain.xml", "deeper than 500");
  std::filesystem::remove_all(folder);
}

}  // namespace mjcf_harm_tests
