#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"
#include "scratch_path.hpp"

#include <filesystem>
#include <fstream>

namespace mjcf_masses_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

/// A body that moves freely, with these parts.
Model read_body(const std::string& parts, const std::string& before = "", const MjcfOptions& options = {}) {
  return parse_mjcf(
      "<mujoco>" + before + "<worldbody><body><freejoint/>" + parts + "</body></worldbody></mujoco>",
      "text.xml", options);
}
Approx near(double x) { return Approx(x).epsilon(1e-12).margin(1e-14); }
void check_moments(const Mat3& inertia, double xx, double yy, double zz) {
  CHECK(inertia(0, 0) == near(xx));
  CHECK(inertia(1, 1) == near(yy));
  CHECK(inertia(2, 2) == near(zz));
}

constexpr double pi = 3.14159265358979323846;

}  // namespace

TEST_CASE("a body weighs what its geoms do, about their common centre") {
  // Two cubes of 1 kg with edges of 0.2 m, 2 m apart along x: m a²/6 each, and 1 kg · 1 m² each across x.
  const Model m = read_body(
      "<geom type='box' size='.1 .1 .1' mass='1'/><geom type='box' size='.1 .1 .1' mass='1' pos='2 0 0'/>");
  const double own = 0.04 / 6;
  CHECK(m.bodies[0].mass == near(2));
  CHECK(norm(Vec3(m.bodies[0].centre - Vec3(1, 0, 0))) < 1e-15);
  check_moments(m.bodies[0].inertia, 2 * own, 2 * own + 2, 2 * own + 2);
}

TEST_CASE("shells of a density per surface") {
  const auto shell = [](const std::string& shape) {
    return read_body("<geom shellinertia='true' density='2' " + shape + "/>").bodies[0];
  };
  const model::Body ball = shell("size='.5'");  // 4πr², 2/3 m r²
  CHECK(ball.mass == near(2 * pi));
  check_moments(ball.inertia, pi / 3, pi / 3, pi / 3);
  // A box of edges 2, 4, 6: six sides of 8, 12, 24 m², twice each. About z: the sides x = ±1 have 24 m² and
  // mean squares 1 + 4/3, those y = ±2 have 12 m² and 1/3 + 4, those z = ±3 have 8 m² and 1/3 + 4/3.
  const model::Body box = shell("type='box' size='1 2 3'");
  CHECK(box.mass == near(2 * 88));
  CHECK(box.inertia(2, 2) == near(2 * 2 * (24 * (1 + 4. / 3) + 12 * (1. / 3 + 4) + 8 * (1. / 3 + 4. / 3))));
  // A tube of 2πr·2h = 4π m² and two disks of π m² at ±1: about z 4π r² + 2 · π/2, across 4π (1/2 + 1/3) + 2π
  // (1/4 + 1).
  const model::Body cylinder = shell("type='cylinder' size='1 1'");
  CHECK(cylinder.mass == near(2 * 6 * pi));
  check_moments(cylinder.inertia, 2 * pi * (10. / 3 + 2.5), 2 * pi * (10. / 3 + 2.5), 2 * 5 * pi);
  // A tube as above and a ball's shell of 4π m² in two halves, whose centres lie 1/2 beyond the ends:
  // across 4π · 2/3 + 4π (1.5² − 0.5²).
  const model::Body capsule = shell("type='capsule' size='1 1'");
  CHECK(capsule.mass == near(2 * 8 * pi));
  check_moments(capsule.inertia, 2 * pi * (10. / 3 + 8. / 3 + 8), 2 * pi * (10. / 3 + 8. / 3 + 8),
                2 * pi * (4 + 8. / 3));
  // Thomsen's formula is exact for a ball; its moments differ by the 1e-6 m of the difference.
  const model::Body ellipsoid = shell("type='ellipsoid' size='.5 .5 .5'");
  CHECK(ellipsoid.mass == near(2 * pi));
  CHECK(ellipsoid.inertia(0, 0) == Approx(pi / 3).epsilon(1e-5));
}

TEST_CASE("an inertial takes the place of geoms, along its axes or in full") {
  const Model turned =
      read_body("<geom size='1'/><inertial pos='1 2 3' mass='4' diaginertia='1 2 3' euler='0 0 90'/>");
  CHECK(turned.bodies[0].mass == 4);
  CHECK(turned.bodies[0].centre == Vec3(1, 2, 3));
  check_moments(turned.bodies[0].inertia, 2, 1, 3);
  const Model full = read_body("<inertial pos='0 0 0' mass='4' fullinertia='3 2 2.5 .1 .2 -.3'/>");
  CHECK(full.bodies[0].inertia == columns(Vec3(3, 0.1, 0.2), Vec3(0.1, 2, -0.3), Vec3(0.2, -0.3, 2.5)));
  CHECK_THROWS_WITH(read_body("<inertial pos='0 0 0' mass='4' fullinertia='1 1 -1 0 0 0'/>"),
                    Contains("not above 0"));
  CHECK_THROWS_WITH(read_body("<inertial pos='0 0 0'/>"), Contains("inertial needs a mass"));
}

TEST_CASE("the compiler's settotalmass, boundmass, boundinertia, balanceinertia and inertiafromgeom") {
  const std::string ball = "<geom size='.5' mass='2'/>";  // 2/5 m r² = 0.2
  const Model total = read_body(ball, "<compiler settotalmass='6'/>");
  CHECK(total.bodies[0].mass == near(6));
  check_moments(total.bodies[0].inertia, 0.6, 0.6, 0.6);
  const Model bound = read_body(ball, "<compiler boundmass='3' boundinertia='1'/>");
  CHECK(bound.bodies[0].mass == 3);
  check_moments(bound.bodies[0].inertia, 1, 1, 1);
  const std::string odd = "<inertial pos='0 0 0' mass='1' diaginertia='1 1 4'/>";
  CHECK_THROWS_WITH(read_body(odd),
                    Contains("text.xml:1: the principal moments 4, 1, 1") && Contains("balanceinertia"));
  check_moments(read_body(odd, "<compiler balanceinertia='true'/>").bodies[0].inertia, 2, 2, 2);
  CHECK(read_body(ball + odd, "<compiler inertiafromgeom='true'/>").bodies[0].mass == 2);
  CHECK(read_body(ball + "<geom size='.5' mass='5' group='4'/>", "<compiler inertiagrouprange='3 5'/>")
            .bodies[0]
            .mass == 5);
}

TEST_CASE("a body that joints move needs a mass, its own or that of a body fixed to it") {
  CHECK_THROWS_WITH(read_body("<geom size='1' mass='0'/>"), Contains("joints move the body"));
  CHECK(read_body("<body><geom size='1'/></body>").bodies[0].mass == 0);
}

TEST_CASE("a cloud of points weighs as its hull, and a mesh as what its faces enclose") {
  // A box of edges 2, 4, 6 about (1, 0, 0).
  const std::string points = "vertex='0 -2 -3 2 -2 -3 2 2 -3 0 2 -3 0 -2 3 2 -2 3 2 2 3 0 2 3'";
  const std::string faces = " face='0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 2 3 7 2 7 6 1 2 6 1 6 5 0 4 7 0 7 3'";
  for (const std::string& mesh :
       {points, points + faces, points + faces + " inertia='exact'", points + faces + " inertia='convex'"}) {
    const Model m = read_body("<geom type='mesh' mesh='m' density='1' pos='0 5 0'/>",
                              "<asset><mesh name='m' " + mesh + "/></asset>");
    REQUIRE(m.meshes.size() == 1);
    CHECK(std::get<model::HullOf>(m.geometries[0].shape).mesh == 0);
    CHECK(m.bodies[0].mass == near(48));
    CHECK(norm(Vec3(m.bodies[0].centre - Vec3(1, 5, 0))) < 1e-13);
    check_moments(m.bodies[0].inertia, 4. * (16 + 36), 4. * (4 + 36), 4. * (4 + 16));
  }
  // Its six sides of 88 m² as sheets.
  CHECK(read_body("<geom type='mesh' mesh='m' density='1'/>",
                  "<asset><mesh name='m' inertia='shell' " + points + faces + "/></asset>")
            .bodies[0]
            .mass == near(88));
  // Moved by refpos, then scaled.
  const Model placed =
      read_body("<geom type='mesh' mesh='m' density='1'/>",
                "<asset><mesh name='m' refpos='1 0 0' scale='.5 .5 -.5' " + points + faces + "/></asset>");
  CHECK(placed.bodies[0].mass == near(6));
  CHECK(norm(placed.bodies[0].centre) < 1e-13);
  // A box that is fitted to it is it.
  const Model fitted =
      read_body("<geom type='box' mesh='m' mass='1'/>", "<asset><mesh name='m' " + points + "/></asset>");
  CHECK(norm(fitted.geometries[0].pose.position - Vec3(1, 0, 0)) < 1e-13);
  const Box box = std::get<Box>(fitted.geometries[0].shape);
  CHECK(box.x * box.y * box.z == near(48));
}

TEST_CASE("built-in meshes: spheres, cones, superspheres, supertori") {
  const auto volume = [](const std::string& builtin) {
    return read_body("<geom type='mesh' mesh='m' density='1'/>",
                     "<asset><mesh name='m' inertia='exact' builtin=" + builtin + "/></asset>")
        .bodies[0]
        .mass;
  };
  // An inscribed solid is smaller, and nears the smooth one with the square of the size of its faces.
  CHECK(volume("'sphere' params='4'") == Approx(4 * pi / 3).epsilon(3e-3));
  CHECK(volume("'hemisphere' params='10'") == Approx(2 * pi / 3).epsilon(2e-2));
  CHECK(volume("'supersphere' params='64 1 1'") == Approx(4 * pi / 3).epsilon(3e-3));
  CHECK(volume("'supersphere' params='64 .0001 .0001'") == Approx(8).epsilon(2e-1));
  CHECK(volume("'supertorus' params='64 .25 1 1'") == Approx(2 * pi * pi / 16).epsilon(4e-3));
  CHECK(volume("'cone' params='4 0'") == near(2. / 3 * 2));  // a pyramid of height 2 on a square of 2 m²
  CHECK(volume("'cone' params='4 1'") == near(2 * 2));       // a prism
  CHECK_THROWS_WITH(volume("'sphere' params='5'"), Contains("at most 4 divisions"));
  CHECK_THROWS_WITH(volume("'wedge' params='1 1 1 1 1'"), Contains("has no volume"));
}

TEST_CASE("meshes and height fields from files, also from the folders of the options") {
  const std::filesystem::path folder = scratch_path("mjcf_files");
  std::filesystem::create_directories(folder / "meshes");
  std::ofstream(folder / "meshes" / "t.obj")
      << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::int32_t counts[] = {2, 3};
  const float heights[] = {0, 1, 2, 3, 4, 5};
  std::ofstream field(folder / "f.bin", std::ios::binary);
  field.write(reinterpret_cast<const char*>(counts), 8);
  field.write(reinterpret_cast<const char*>(heights), 24);
  field.close();
  const Model m = read_body("<geom type='mesh' mesh='t' density='6'/>",
                            "<compiler meshdir='meshes'/><asset><mesh file='t.obj'/></asset>",
                            {.files = {folder.string()}});
  CHECK(m.bodies[0].mass == near(1));  // 6 · 1/6
  const Model h = parse_mjcf(
      "<mujoco><asset><hfield name='h' file='f.bin' size='1 2 10 .5'/><hfield name='i' nrow='2' ncol='2' "
      "size='1 1 4 1' "
      "elevation='1 2 5 3'/></asset><worldbody><geom type='hfield' hfield='h'/><geom type='hfield' "
      "hfield='i'/></worldbody></mujoco>",
      (folder / "x.xml").string());
  REQUIRE(h.height_fields.size() == 2);
  CHECK(h.height_fields[0].columns == 3);
  CHECK(h.height_fields[0].heights == std::vector<double>{0, 2, 4, 6, 8, 10});
  CHECK(h.height_fields[0].half_y == 2);
  // The text begins with the row that lies farthest along y: 5 3 is the row of −y. From 1 to 5 they become 0
  // to 4.
  CHECK(h.height_fields[1].heights == std::vector<double>{4, 2, 0, 1});
  std::filesystem::remove_all(folder);
  CHECK_THROWS_WITH(read_body("<geom type='mesh' mesh='t'/>", "<asset><mesh file='t.obj'/></asset>"),
                    Contains("text.xml:1: the mesh file 't.obj' is not found"));
  // A geom that only shows a mesh does without.
  const Model shown = read_body(
      "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><geom type='mesh' mesh='t' contype='0' "
      "conaffinity='0'/>",
      "<asset><mesh file='t.obj'/></asset>");
  CHECK(shown.geometries.empty());
  CHECK(shown.skipped.size() == 1);
}

}  // namespace mjcf_masses_tests
