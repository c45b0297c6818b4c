#include <delassus/io/replay_page.hpp>

#include "catch.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

using namespace delassus;

namespace {

/// `bodies` boxes on spirals for `seconds`, `contacts` a frame, 1000 steps a second with nine stages.
Recording spirals(int bodies, double seconds, int contacts) {
  Recording scene{.name = "spirals", .caption = "Nothing here obeys a law."};
  scene.bodies.push_back(recorded_body(HalfSpace{}, true));
  for (int b = 0; b < bodies; ++b) scene.bodies.push_back(recorded_body(Box{1, 1, 1}));
  for (int s = 0; s < 9; ++s) scene.steps.stages.push_back({"stage " + std::to_string(s), {}});
  for (int step = 0; step < int(seconds * 1000); ++step) {
    const double t = step / 1000.0;
    scene.steps.time.push_back(t);
    for (auto* series : {&scene.steps.energy, &scene.steps.residual, &scene.steps.sweeps})
      series->push_back(1 + std::sin(t));
    for (auto& stage : scene.steps.stages) stage.milliseconds.push_back(0.1);
    if (!scene.wants_frame(t)) continue;
    RecordedFrame frame{.time = t, .poses = {{}}};
    for (int b = 0; b < bodies; ++b)
      frame.poses.push_back(
          {Vec3(std::sin(t + b), std::cos(t + b), b), Quat(std::cos(t), std::sin(t), 0, 0)});
    for (int c = 0; c < contacts; ++c) frame.contacts.push_back({Vec3(c, 0, 0), Vec3(0, 0, c)});
    scene.frames.push_back(frame);
  }
  return scene;
}

}  // namespace

TEST_CASE("frames come at their rate whatever the step") {
  Recording scene;
  int step = 0;
  for (; step <= 700; ++step)
    if (scene.wants_frame(step / 70.0)) scene.frames.push_back({.time = step / 70.0});
  REQUIRE(scene.frames.size() == 301);  // 10 s at 30 a second, both ends
}

TEST_CASE("six scenes, one of 200 bodies and one of 101, make a page below 5 MB") {
  std::vector<Recording> scenes{spirals(200, 10, 600), spirals(101, 10, 200)};
  for (int i = 0; i < 4; ++i) scenes.push_back(spirals(20, 10, 80));
  const std::string page = replay_page("Six scenes", scenes);
  REQUIRE(page.size() < 5'000'000);
  REQUIRE(page.size() > 3'000'000);  // and the room is used
}

TEST_CASE("a page that cannot fit is as small as the coarsest plan makes it") {
  const std::vector<Recording> scenes{spirals(50, 2, 100)};
  const inner::ReplayPlan plan = inner::plan_for(scenes, 0);
  REQUIRE(plan.frames_per_second == 10);
  REQUIRE(plan.contacts == 32);
}

TEST_CASE("the planned size of the frames is the written one") {
  const Recording scene = spirals(7, 1, 40);
  const inner::ReplayPlan plan{.frames_per_second = 30, .contacts = 32};
  std::string text;
  inner::FrameWriter(scene, plan).append_to(text);
  // Names of the fields, three ranges and a time of at most ten characters a frame, padding of seven base64
  // texts.
  const double frames = double(inner::kept_frames(scene, 30).size());
  REQUIRE(std::abs(double(text.size()) - double(inner::planned_bytes(scene, plan))) < 300 + 10 * frames);
}

TEST_CASE("of too many contacts the largest impulses stay, in their own order") {
  RecordedFrame frame;
  for (const double size : {3.0, 9.0, 1.0, 9.0, 7.0})
    frame.contacts.push_back({Vec3::Zero(), Vec3(0, 0, size)});
  REQUIRE(inner::kept_contacts(frame, 3) == std::vector<std::size_t>{1, 3, 4});
  frame.contacts[1].impulse[0] = std::nan("");
  REQUIRE(inner::kept_contacts(frame, 3) == std::vector<std::size_t>{0, 3, 4});
}

TEST_CASE("a series is thinned to its largest, mean or last values") {
  const std::array values{1.0, 5.0, 3.0, 2.0, std::nan(""), 4.0, 8.0};
  REQUIRE(inner::reduced(values, 3, inner::Keep::largest) == std::vector<double>{5, 4, 8});
  REQUIRE(inner::reduced(values, 3, inner::Keep::mean) == std::vector<double>{3, 3, 8});
  REQUIRE(inner::reduced(values, 3, inner::Keep::last) == std::vector<double>{3, 4, 8});
  REQUIRE(inner::steps_per_sample(1200) == 1);
  REQUIRE(inner::steps_per_sample(1201) == 2);
}

TEST_CASE("in a series, zero on a logarithmic axis and what is no number have words of their own") {
  const auto written = [](std::vector<double> values, bool is_logarithmic) {
    std::string out;
    inner::append_series(out, std::move(values), is_logarithmic);
    return out;
  };
  // Words 0, 65533, 65534, 65535, lowest byte first: 00 00 fd ff fe ff ff ff.
  REQUIRE(written({1e-8, 1, 0, std::nan("")}, true) == "[-8,0,\"AAD9//7///8=\"]");
  REQUIRE(written({2, 3, std::nan(""), HUGE_VAL}, false) == "[2,3,\"AAD9//////8=\"]");
  REQUIRE(written({}, true) == "[0,0,\"\"]");
  REQUIRE(written({0, 0}, true) == "[0,0,\"/v/+/w==\"]");
}

TEST_CASE("no name, caption or cell can break out of the page") {
  Recording scene = spirals(1, 0.1, 1);
  scene.name = "</script><script>alert(1)</script>";
  scene.caption = "{{data}} <!-- <b>";
  Table table{.title = "<b>", .caption = "a & b", .columns = {"<i>"}};
  table.add({"</td>"});
  const std::string page = replay_page("<title>", std::array{scene}, std::array{table});
  std::size_t closings = 0;
  for (std::size_t at = 0; (at = page.find("</script>", at)) != page.npos; ++at) ++closings;
  REQUIRE(closings == 2);
  REQUIRE(page.find("<!-- ") == page.npos);
  REQUIRE(page.find("{{data}}") != page.npos);  // kept as it was written
  REQUIRE(page.find("<title>&lt;title&gt;</title>") != page.npos);
  REQUIRE(page.find("&lt;/td&gt;") != page.npos);
}

TEST_CASE("the page asks for nothing from outside") {
  const std::string page = replay_page("Offline", std::array{spirals(1, 0.1, 1)});
  for (const char* address : {"http:", "https:", "src=", "url(", "import(", "fetch("})
    REQUIRE(page.find(address) == page.npos);
  REQUIRE(page.find("default-src 'none'") != page.npos);
}

TEST_CASE("numbers in tables are written as in print") {
  REQUIRE(inner::cell_html(Cell(-5e-6)) == "−5 × 10<sup>−6</sup>");
  REQUIRE(inner::cell_html(Cell(1234567)) == "1&#8239;234&#8239;567");
  REQUIRE(inner::cell_html(Cell(-1234)) == "−1234");
  REQUIRE(inner::cell_html(Cell(0.125)) == "0.125");
  REQUIRE(inner::cell_html(Cell("10000 e")) == "10000 e");
}

TEST_CASE("a pose that is not finite repeats the last one") {
  Recording good{.name = "a", .bodies = {recorded_body(Sphere{1})}};
  for (const double x : {0.0, 1.0, 1.0}) good.frames.push_back({.time = x, .poses = {{Vec3(x, 0, 0)}}});
  good.frames[2].time = 2;
  Recording bad = good;
  bad.frames[2].poses[0].position[0] = std::nan("");
  REQUIRE(replay_page("", std::array{good}) == replay_page("", std::array{bad}));
}

TEST_CASE("what does not hold together is refused, by name") {
  Recording scene = spirals(2, 0.1, 0);
  scene.frames[1].poses.pop_back();
  REQUIRE_THROWS_WITH(replay_page("", std::array{scene}),
                      "delassus: recording 'spirals': frame #1 has 2 poses for 3 bodies");
  scene = spirals(2, 0.1, 0);
  scene.steps.stages[0].milliseconds.pop_back();
  REQUIRE_THROWS_WITH(replay_page("", std::array{scene}),
                      "delassus: recording 'spirals': series 'stage 0' has 99 samples for 100 steps");
  scene.frames.clear();
  REQUIRE_THROWS_WITH(replay_page("", std::array{scene}), "delassus: recording 'spirals' has no frame");
}

TEST_CASE("a cone is written by radius and height, an ellipsoid by its semi-axes") {
  RecordedBody body;
  body.shape = Cone{0.5, 2};
  CHECK(inner::shape_json(body) == R"({"kind":"cone","size":[0.5,2]})");
  body.shape = Ellipsoid{1, 2, 3};
  CHECK(inner::shape_json(body) == R"({"kind":"ellipsoid","size":[1,2,3]})");
}

TEST_CASE("the page is written whole, or the path is named") {
  const std::string path = "replay_page_test.html";
  const std::vector<Recording> scenes{spirals(3, 0.5, 2)};
  const std::size_t size = write_replay_page(path, "Three", scenes);
  std::ifstream file(path, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  std::remove(path.c_str());
  REQUIRE(content.str().size() == size);
  REQUIRE(content.str() == replay_page("Three", scenes));
  REQUIRE_THROWS_WITH(
      write_replay_page("/nowhere/index.html", "Three", scenes),
      "delassus: cannot open '/nowhere/index.html' for writing; does its folder exist, and may you "
      "write there?");
}
