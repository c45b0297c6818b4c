#include <delassus/io/vtk.hpp>

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/io/inner/text_reader.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "scratch_path.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <sstream>

namespace vtk_tests {

using namespace delassus;

namespace {

/// Of what closed faces hold, m³, by the divergence theorem.
double volume(const inner::Polygons& solid) {
  double six = 0;
  for (const auto& face : solid.faces)
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      six += dot(solid.points[std::size_t(face[0])], cross(solid.points[std::size_t(face[k])], solid.points[std::size_t(face[k + 1])]));
  return six / 6;
}

/// Each edge is there once in each direction.
bool is_closed(const inner::Polygons& solid) {
  std::map<std::pair<Index, Index>, int> edges;
  for (const auto& face : solid.faces)
    for (std::size_t k = 0; k < face.size(); ++k) ++edges[{face[k], face[(k + 1) % face.size()]}];
  for (const auto& [edge, count] : edges)
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  return true;
}

}  // namespace

TEST_CASE("the polygons of solids are closed and hold their volume") {
  const double pi = std::numbers::pi;
  const std::pair<Shape, double> solids[] = {
      {Sphere{0.3}, 4 / 3. * pi * 0.027},         {Box{1, 2, 3}, 6},
      {Capsule{0.3, 1}, pi * (0.09 + 4 / 3. * 0.027)}, {Cylinder{0.3, 1}, pi * 0.09},
      {Cone{0.3, 1}, pi * 0.03},                  {Ellipsoid{0.1, 0.2, 0.3}, 4 / 3. * pi * 0.006}};
  for (const auto& [shape, exact] : solids) {
    const inner::Polygons solid = inner::polygons_of(recorded_body(shape), zero<Vec3>(), 1);
    CAPTURE(int(shape.kind));
    CHECK(is_closed(solid));
    // A polygon of 24 sides in a circle has 1 − π²·4/(6·24²) = 0.9886 of its area; half a circle in 12 rings takes as much again.
    CHECK(volume(solid) <= exact * (1 + 1e-12));
    CHECK(volume(solid) >= 0.97 * exact);
  }
}

namespace {

/// A dumb-bell of two spheres and a ball that fall on a floor, and what VTK and a page are told of it.
auto falling(const std::string& path) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, WithCompounds{NativeCollision{}}, Recorder{"Fall", "", 1e3}, VtkRecorder{path}};
  auto& set = bodies<RigidBodies>(loop.world());
  const CompoundPart parts[] = {{.shape = Sphere{0.2}, .position = {-0.5, 0, 0}}, {.shape = Sphere{0.2}, .position = {0.5, 0, 0}}};
  const Compound bell(parts);
  const Shape shape = loop.data().template policy<role::Collision>().add(bell);
  set.add({.position = {0, 0, 0.25}, .mass = bell.mass(), .inertia = bell.inertia(), .shape = shape});
  set.add({.position = {0, 3, 0.15}, .mass = 1, .shape = Sphere{0.1}});
  set.add_fixed(HalfSpace{});
  return loop;
}

void take_away(const std::filesystem::path& path) {
  std::filesystem::remove_all(path.string() + "_vtk");
  std::filesystem::remove(path.string() + ".pvd");
}

/// Parses the .pvd as XML and reads each of its files by VTK. A line a file: time, numbers of points, contacts, lines and polygons, the sum of
/// impulses along z, the least z of a normal at a contact, and the middle of the box around the polygons of body 1.
constexpr const char* reader = R"py(
import os, sys
import xml.etree.ElementTree as ET
try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    sys.exit(77)
for data in ET.parse(sys.argv[1]).getroot().find('Collection'):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(os.path.dirname(sys.argv[1]), data.get('file')))
    reader.Update()
    out = reader.GetOutput()
    normals, impulses, bodies = out.GetPointData().GetArray('normal'), out.GetPointData().GetArray('impulse'), out.GetCellData().GetArray('body')
    contacts = [out.GetCell(k).GetPointId(0) for k in range(out.GetNumberOfVerts())]
    low, high = [1e9] * 3, [-1e9] * 3
    for k in range(out.GetNumberOfCells()):
        if bodies.GetValue(k) == 1:
            for p in range(out.GetCell(k).GetNumberOfPoints()):
                x = out.GetPoint(out.GetCell(k).GetPointId(p))
                low, high = [min(a, b) for a, b in zip(low, x)], [max(a, b) for a, b in zip(high, x)]
    print(data.get('timestep'), out.GetNumberOfPoints(), len(contacts), out.GetNumberOfLines(), out.GetNumberOfPolys(),
          sum(impulses.GetTuple3(p)[2] for p in contacts), min([normals.GetTuple3(p)[2] for p in contacts] + [1]),
          *[(a + b) / 2 for a, b in zip(low, high)])
)py";

}  // namespace

TEST_CASE("a compound is drawn part by part") {
  const std::filesystem::path path = scratch_path("parts");
  auto loop = falling(path.string());
  for (int k = 0; k < 10; ++k) loop.step(0.01);
  const Recording& recording = loop.get<Recorder>().recording();
  REQUIRE(recording.bodies.size() == 4);
  const double radii[] = {0.2, 0.2, 0.1};
  for (std::size_t b = 0; b < 3; ++b) {
    CHECK(recording.bodies[b].shape.kind == ShapeKind::sphere);
    CHECK(recording.bodies[b].shape.size[0] == radii[b]);
  }
  REQUIRE(recording.frames.size() == 10);
  const Pose bell = bodies<RigidBodies>(loop.world()).pose(0);
  // Both sides multiply the same numbers: a few roundings of 1 m.
  CHECK((recording.frames.back().poses[0].position - bell.to_world({-0.5, 0, 0})).norm() < 1e-14);
  CHECK((recording.frames.back().poses[1].position - bell.to_world({0.5, 0, 0})).norm() < 1e-14);
  CHECK(bell.position[2] < 0.24);  // it has moved
  inner::check_recording(recording);
  take_away(path);
}

TEST_CASE("a height field is drawn as its triangles") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, WithMeshes{NativeCollision{}}, Recorder{"Hill", ""}};
  const double heights[] = {0, 0, 0.1, 0, 0.2, 0};
  const Shape hill = loop.data().policy<role::Collision>().add(HeightField(3, 2, 1, 1, heights));
  bodies<RigidBodies>(loop.world()).add_fixed(hill);
  loop.step(0.01);
  const RecordedBody& body = loop.get<Recorder>().recording().bodies.at(0);
  CHECK(body.vertices.size() == 6);
  CHECK(body.faces.size() == 4);  // two for each of two cells
  double highest = 0;
  for (const Vec3& v : body.vertices) highest = std::max(highest, v[2]);
  CHECK(highest == 0.2);
}

TEST_CASE("VTK reads back what a loop writes for it") {
  const std::filesystem::path path = scratch_path("read back"), script = scratch_path("reader.py"), answer = scratch_path("answer.txt");
  auto loop = falling(path.string());
  for (int k = 0; k < 20; ++k) loop.step(0.01);
  inner::write_file(script.string(), reader);
  const int status = std::system(("/usr/bin/python3 '" + script.string() + "' '" + path.string() + ".pvd' >'" + answer.string() + "' 2>&1").c_str());
  const std::string text = std::filesystem::exists(answer) ? inner::read_text(answer.string()) : "";
  std::filesystem::remove(script), std::filesystem::remove(answer), take_away(path);
  if (status == 77 * 256 || status == 127 * 256) {
    WARN("no VTK for /usr/bin/python3 (apt-get install python3-vtk9): nothing is read back");
    return;
  }
  INFO(text);
  REQUIRE(status == 0);
  const Recording& recording = loop.get<Recorder>().recording();
  REQUIRE(recording.frames.size() == 20);
  std::istringstream lines(text);
  std::size_t most_contacts = 0;
  for (const RecordedFrame& frame : recording.frames) {
    double time = -1, impulse = 0, normal = 0;
    std::size_t points = 0, contacts = 0, edges = 0, polygons = 0;
    Vec3 middle = zero<Vec3>();
    lines >> time >> points >> contacts >> edges >> polygons >> impulse >> normal >> middle[0] >> middle[1] >> middle[2];
    REQUIRE(lines);
    std::size_t faces = 0, corners = frame.contacts.size() + 2 * frame.lines.size();
    for (const RecordedBody& body : recording.bodies) {
      const inner::Polygons own = inner::polygons_of(body, zero<Vec3>(), 1);
      faces += own.faces.size(), corners += own.points.size();
    }
    double sum = 0;
    for (const RecordedContact& c : frame.contacts) sum += c.impulse[2];
    CHECK(time == frame.time);
    CHECK(points == corners);
    CHECK(contacts == frame.contacts.size());
    CHECK(edges == frame.lines.size());
    CHECK(polygons == faces);
    // Single precision: each number is sure to 6e-8 of itself, and places are below 4 m.
    CHECK(std::abs(impulse - sum) <= 1e-7 * std::abs(sum));
    CHECK((middle - frame.poses[1].position).norm() < 1e-6);
    if (contacts > 0) CHECK(std::abs(normal + 1) < 1e-6);  // the floor is B
    most_contacts = std::max(most_contacts, contacts);
  }
  CHECK(most_contacts == 3);
}

TEST_CASE("a recorder for VTK refuses what it cannot write") {
  using Catch::Matchers::Contains;
  CHECK_THROWS_WITH((AnimationLoop{World{RigidBodies{}}, VtkRecorder{}}), Contains("has no path"));
  CHECK_THROWS_WITH((AnimationLoop{World{RigidBodies{}}, VtkRecorder{"a", -1}}), Contains("frames_per_second"));
  CHECK_THROWS_WITH(VtkSeries("/proc/no/such"), Contains("cannot make the folder '/proc/no/such_vtk'"));
  VtkSeries series(scratch_path("series").string());
  CHECK_THROWS_WITH(series.add(std::vector{recorded_body(Sphere{1})}, RecordedFrame{}), Contains("0 poses for 1 bodies"));
  take_away(scratch_path("series"));
}

}  // namespace vtk_tests
