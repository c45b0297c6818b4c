#include "catch.hpp"

#include <delassus/model/check.hpp>

#include <functional>
#include <limits>

namespace model_check_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

/// An arm on the world with one element of every kind.
Model sound_machine() {
  Model m{.name = "arm"};
  const auto body = [&](const char* name, Index parent, std::vector<Index> joints) {
    m.bodies.push_back({.name = name,
                        .parent = parent,
                        .mass = 1,
                        .inertia = identity<Mat3>(),
                        .joints = std::move(joints)});
  };
  body("upper", -1, {0});
  body("lower", 0, {1, 2});
  body("ball", -1, {3});
  for (const char* name : {"shoulder", "elbow", "slide", "loose"}) m.joints.push_back({.name = name});
  m.joints[2].kind = model::JointKind::slide;
  m.joints[3].kind = model::JointKind::free;
  m.joints[1].is_limited = true;
  m.joints[1].upper = 1;
  m.meshes.push_back(
      {.name = "rock", .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .triangles = {{0, 1, 2}}});
  m.height_fields.push_back(
      {.name = "hill", .rows = 2, .columns = 2, .half_x = 1, .half_y = 1, .heights = {0, 0, 0, 1}});
  for (const model::GeometryShape& shape : std::initializer_list<model::GeometryShape>{
           Sphere{1}, Box{1, 1, 1}, Capsule{1, 1}, Cylinder{1, 1}, Ellipsoid{1, 1, 1}, model::Plane{},
           model::HullOf{0}, model::TrianglesOf{0}, model::FieldOf{0}})
    m.geometries.push_back({.body = Index(m.geometries.size()) % 4 - 1, .shape = shape});
  m.couplings.push_back({.joint = 1, .other = 0});
  m.connects.push_back({.body = 1});
  m.welds.push_back({.body = 1, .other = 2});
  m.sites.push_back({.name = "hand", .body = 1});
  m.sites.push_back({.name = "post"});
  m.tendons.push_back({.name = "cable", .sites = {0, 1}});
  m.tendons.push_back({.name = "sum", .joints = {{0, 1}, {2, -1}}});
  m.actuators.push_back({.name = "motor", .target = 1, .time_constant = 0.1});
  m.excludes.push_back({.body = 0, .other = -1});
  m.pairs.push_back({.geometry = 0, .other = 1});
  m.keyframes.push_back({.name = "home",
                         .q = std::vector<double>(10),
                         .v = std::vector<double>(9),
                         .activation = {0},
                         .control = {0}});
  return m;
}

struct Fault {
  const char* sentence;
  std::function<void(Model&)> make;
};

const double nan_of_model = std::numeric_limits<double>::quiet_NaN();

const Fault model_faults[] = {
    {"model 'arm': body 1 'lower': its parent must stand before it",
     [](Model& m) { m.bodies[1].parent = 1; }},
    {"body 0 'upper': its parent", [](Model& m) { m.bodies[0].parent = -2; }},
    {"body 2 'ball': mass is -1 and must be >= 0", [](Model& m) { m.bodies[2].mass = -1; }},
    {"body 2 'ball': mass is nan", [](Model& m) { m.bodies[2].mass = nan_of_model; }},
    {"body 2 'ball': a joint moves it, and neither it", [](Model& m) { m.bodies[2].mass = 0; }},
    {"body 0 'upper': its centre of mass is 1e+308", [](Model& m) { m.bodies[0].centre[1] = 1e308; }},
    {"its inertia is not symmetric", [](Model& m) { m.bodies[0].inertia(0, 1) = 0.1; }},
    {"its inertia is inf", [](Model& m) { m.bodies[0].inertia(0, 0) = HUGE_VAL; }},
    {"is no rotation matrix", [](Model& m) { m.bodies[0].pose.rotation(0, 0) = -1; }},
    {"body 1 'upper': another one has its name", [](Model& m) { m.bodies[1].name = "upper"; }},
    {"body 0 'upper': the index of a joint is 4", [](Model& m) { m.bodies[0].joints = {4}; }},
    {"one of its joints is of another body too",
     [](Model& m) {
       m.bodies[1].joints = {0, 1, 2};
     }},
    {"joint 2 'slide': it is of no body", [](Model& m) { m.bodies[1].joints = {1}; }},
    {"a free joint must be the only one",
     [](Model& m) { m.joints[1].kind = model::JointKind::free, m.joints[1].is_limited = false; }},
    {"joint 0 'shoulder': its axis is no unit vector",
     [](Model& m) {
       m.joints[0].axis = {0, 0, 2};
     }},
    {"joint 1 'elbow': its limits go from 2 to 1", [](Model& m) { m.joints[1].lower = 2; }},
    {"joint 0 'shoulder': damping is -1", [](Model& m) { m.joints[0].damping = -1; }},
    {"geometry 0: the index of its body is 3", [](Model& m) { m.geometries[0].body = 3; }},
    {"geometry 0: its radius is 0 and must be > 0", [](Model& m) { m.geometries[0].shape = Sphere{}; }},
    {"geometry 1: an edge is nan",
     [](Model& m) {
       m.geometries[1].shape = Box{1, nan_of_model, 1};
     }},
    {"geometry 6: the index of its mesh is 1", [](Model& m) { m.geometries[6].shape = model::HullOf{1}; }},
    {"geometry 7: its mesh has no triangle", [](Model& m) { m.meshes[0].triangles.clear(); }},
    {"geometry 6: the mesh of a hull needs four vertices", [](Model& m) { m.meshes[0].vertices.pop_back(); }},
    {"geometry 0: its contact freedoms must be", [](Model& m) { m.geometries[0].contact_freedoms = 2; }},
    {"mesh 0 'rock': the corner of a triangle is 4", [](Model& m) { m.meshes[0].triangles[0][1] = 4; }},
    {"mesh 0 'rock': a vertex is nan", [](Model& m) { m.meshes[0].vertices[2][0] = nan_of_model; }},
    {"height field 0 'hill': it must have rows times columns heights",
     [](Model& m) { m.height_fields[0].heights.pop_back(); }},
    {"coupling 0: only hinges and slides", [](Model& m) { m.couplings[0].other = 3; }},
    {"coupling 0: it couples one thing with itself", [](Model& m) { m.couplings[0].other = 1; }},
    {"coupling 0: the index of its other tendon is 2",
     [](Model& m) { m.couplings[0] = {.joint = 1, .other = 2, .of_tendons = true}; }},
    {"connect 0: it names one body twice", [](Model& m) { m.connects[0].other = 1; }},
    {"weld 0: the index of a body is 9", [](Model& m) { m.welds[0].other = 9; }},
    {"tendon 0 'cable': its path needs two sites", [](Model& m) { m.tendons[0].sites.pop_back(); }},
    {"tendon 1 'sum': it must have joints", [](Model& m) { m.tendons[1].joints.clear(); }},
    {"tendon 1 'sum': only hinges and slides share", [](Model& m) { m.tendons[1].joints[0].joint = 3; }},
    {"actuator 0 'motor': the index of what it moves is 4", [](Model& m) { m.actuators[0].target = 4; }},
    {"actuator 0 'motor': its gain is 1e+200", [](Model& m) { m.actuators[0].gain = 1e200; }},
    {"exclude 0: it names one thing twice", [](Model& m) { m.excludes[0].body = -1; }},
    {"pair 0: the index of a geometry is 99", [](Model& m) { m.pairs[0].other = 99; }},
    {"keyframe 0 'home': its q must have", [](Model& m) { m.keyframes[0].q.pop_back(); }},
    {"keyframe 0 'home': it must have a control",
     [](Model& m) {
       m.keyframes[0].control = {1, 2};
     }},
    {"gravity must be finite", [](Model& m) { m.gravity[2] = nan_of_model; }},
    {"its time step is -1 s", [](Model& m) { m.time_step = -1; }},
};

}  // namespace

TEST_CASE("a sound description passes the check") {
  Model m = sound_machine();
  CHECK_NOTHROW(check(m));
  CHECK_NOTHROW(check(Model{}));
  m.keyframes[0] = {};  // lists that say nothing
  m.bodies[2].is_kinematic = true;
  m.bodies[2].mass = 0;  // the host moves it
  CHECK_NOTHROW(check(m));
}

TEST_CASE("a massless body that a joint moves is sound when a body with mass is fixed to it") {
  Model m = sound_machine();
  m.bodies[1].mass = 0;
  CHECK_THROWS_AS(check(m), InvalidArgument);
  m.bodies.push_back({.name = "tip", .parent = 1, .mass = 1, .inertia = identity<Mat3>()});
  CHECK_NOTHROW(check(m));
}

TEST_CASE("each fault of a description is one sentence that names the element") {
  for (const Fault& fault : model_faults) {
    Model m = sound_machine();
    fault.make(m);
    INFO(fault.sentence);
    CHECK_THROWS_WITH(check(m), Contains(fault.sentence));
  }
}

}  // namespace model_check_tests
