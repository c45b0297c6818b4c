/// A machine as files describe it: bodies in a tree, their joints, shapes, tendons, actuators and couplings.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>

#include <array>
#include <string>
#include <variant>
#include <vector>

namespace delassus {

/// A plain description, which readers fill and `add` puts into a loop. All of it is in SI units and radians. An index
/// names an element of the list of its kind; −1 names none, or the world.
namespace model {

/// What a joint lets move.
enum class JointKind {
  hinge,  ///< turns about an axis; q in rad
  slide,  ///< moves along an axis; q in m
  ball,   ///< turns about a point; q is a unit quaternion w x y z
  free,   ///< six freedoms; q is a position and a unit quaternion w x y z
};

/// One joint between a body and its parent. Several joints of a body act in their order: each moves the axes of those
/// that follow.
struct Joint {
  std::string name;
  JointKind kind = JointKind::hinge;
  Vec3 point = zero<Vec3>();             ///< in the body's frame, m; of no account for `free`
  Vec3 axis = {0, 0, 1};                 ///< unit, body's frame; of no account for `ball` and `free`
  double reference = 0;                  ///< q in the pose that the tree describes
  bool is_limited = false;
  double lower = 0, upper = 0;           ///< of q; `ball`: 0 and the largest angle
  double damping = 0;                    ///< N·s/m or N·m·s
  double friction_loss = 0;              ///< N or N·m, dry
  double stiffness = 0;                  ///< N/m or N·m/rad
  double spring_reference = 0;           ///< q at which the spring is at rest
  double armature = 0;                   ///< inertia of the rotor seen at the joint, kg or kg·m²
  double effort = 0;                     ///< largest force of a motor on it, N or N·m; 0: not said
  double speed = 0;                      ///< largest rate, m/s or rad/s; 0: not said
};

/// One link. Bodies stand in the list after their parents.
struct Body {
  std::string name;
  Index parent = -1;                     ///< −1: the world
  Pose pose;                             ///< of its frame in the parent's, at the reference of all joints
  double mass = 0;                       ///< kg
  Vec3 centre = zero<Vec3>();            ///< of mass, body's frame, m
  Mat3 inertia = zero<Mat3>();           ///< about the centre, axes of the body's frame, kg·m²
  double gravity_compensation = 0;       ///< share of its weight that is taken off
  bool is_kinematic = false;             ///< moved by the host alone
  std::vector<Index> joints;             ///< in order; none: fixed to the parent
};

/// A plane z = 0 of its own frame, solid below.
struct Plane {};
/// An index in `Model::meshes`, taken as its convex hull.
struct HullOf {
  Index mesh = -1;
};
/// An index in `Model::meshes`, taken triangle by triangle.
struct TrianglesOf {
  Index mesh = -1;
};
/// An index in `Model::height_fields`.
struct FieldOf {
  Index field = -1;
};

/// What a collision sees of a body.
using GeometryShape = std::variant<Sphere, Box, Capsule, Cylinder, Ellipsoid, Plane, HullOf, TrianglesOf, FieldOf>;

struct Geometry {
  std::string name;
  Index body = -1;                       ///< −1: the world
  Pose pose;                             ///< in the body's frame
  GeometryShape shape;                   ///< capsules and cylinders along z
  int contact_freedoms = 3;              ///< 1 frictionless, 3 sliding, 4 and spinning, 6 and rolling
  double friction = 1;                   ///< sliding
  double spinning_friction = 0;          ///< m
  double rolling_friction = 0;           ///< m
  double restitution = 0;
  unsigned type = 1, affinity = 1;       ///< two collide where the type of one meets the affinity of the other
  int priority = 0;                      ///< the friction of a pair is that of the higher
  Vec3 surface_velocity = zero<Vec3>();  ///< of its surface, in its own frame, m/s
  Vec3 surface_spin = zero<Vec3>();      ///< about its own origin, rad/s
};

struct Mesh {
  std::string name;
  std::vector<Vec3> vertices;            ///< m
  std::vector<std::array<Index, 3>> triangles;
};

/// Heights over a grid of columns along x and rows along y, centred on its frame.
struct HeightField {
  std::string name;
  Index rows = 0, columns = 0;
  double half_x = 0, half_y = 0;         ///< m
  double base = 0;                       ///< depth of the solid below z = 0, m
  std::vector<double> heights;           ///< m, row by row, rows from −y up
};

/// q of `joint` is c₀ + c₁ s + c₂ s² + c₃ s³ + c₄ s⁴ past its reference, with s that of `other` past its own; without
/// `other` it is held at c₀.
struct Coupling {
  std::string name;
  Index joint = -1, other = -1;
  bool of_tendons = false;               ///< both name tendons, by their lengths
  std::array<double, 5> coefficients{0, 1, 0, 0, 0};
};

/// A point of one body stays on a point of another.
struct Connect {
  std::string name;
  Index body = -1, other = -1;
  Vec3 point = zero<Vec3>();             ///< in the frame of `body`, m
  Vec3 other_point = zero<Vec3>();       ///< in the frame of `other`, m
};

/// Two bodies stay as they are to each other.
struct Weld {
  std::string name;
  Index body = -1, other = -1;
  Pose pose;                             ///< of `other` in the frame of `body`
};

/// A point that spatial tendons pass and actuators push.
struct Site {
  std::string name;
  Index body = -1;
  Pose pose;
};

/// A share of a joint in the length of a fixed tendon.
struct TendonJoint {
  Index joint = -1;
  double coefficient = 1;
};

/// A length: Σ coefficient · q of joints (fixed), or of the path from site to site (spatial).
struct Tendon {
  std::string name;
  std::vector<TendonJoint> joints;       ///< of a fixed tendon
  std::vector<Index> sites;              ///< of a spatial tendon
  bool is_limited = false;
  double lower = 0, upper = 0;           ///< of the length
  double damping = 0, friction_loss = 0, stiffness = 0;
  double rest_lower = 0, rest_upper = 0; ///< no force of the spring between these lengths
};

enum class Transmission { joint, tendon, site };

/// A force on a joint, a tendon or a site: gain · a + bias₀ + bias₁ l + bias₂ l̇ with l = gear · q, times gear. a is the
/// control, or what a filter of first order with `time_constant` makes of it.
struct Actuator {
  std::string name;
  Transmission transmission = Transmission::joint;
  Index target = -1;
  std::array<double, 6> gear{1, 0, 0, 0, 0, 0};
  double gain = 1;
  std::array<double, 3> bias{0, 0, 0};
  double time_constant = 0;              ///< s; 0: no filter
  bool control_is_limited = false, force_is_limited = false;
  double control_lower = 0, control_upper = 0;
  double force_lower = 0, force_upper = 0;
};

/// Two bodies that never collide.
struct Exclude {
  Index body = -1, other = -1;
};

/// Two geometries that always do, with numbers of their own.
struct Pair {
  Index geometry = -1, other = -1;
  int contact_freedoms = 3;
  double friction = 1, spinning_friction = 0, rolling_friction = 0;
};

struct Keyframe {
  std::string name;
  double time = 0;
  std::vector<double> q, v, activation, control;
};

}  // namespace model

/// What holds the root of a machine.
enum class Base {
  as_file,  ///< what the file says
  free,     ///< nothing: it has six freedoms
  fixed,    ///< the world
};

/// See namespace `model`. `add` of a loop takes it; readers are in `adapters/`.
struct Model {
  std::string name;
  Vec3 gravity = {0, 0, -9.81};
  double time_step = 0;                  ///< s, that the file asks for; 0: none
  bool contacts = true;                  ///< false: nothing collides
  bool parents_collide = false;          ///< a body meets its parent, also where a joint moves both
  std::vector<model::Body> bodies;
  std::vector<model::Joint> joints;
  std::vector<model::Geometry> geometries;
  std::vector<model::Mesh> meshes;
  std::vector<model::HeightField> height_fields;
  std::vector<model::Coupling> couplings;
  std::vector<model::Connect> connects;
  std::vector<model::Weld> welds;
  std::vector<model::Site> sites;
  std::vector<model::Tendon> tendons;
  std::vector<model::Actuator> actuators;
  std::vector<model::Exclude> excludes;
  std::vector<model::Pair> pairs;
  std::vector<model::Keyframe> keyframes;
  /// What the file asks for and nothing here does, a sentence each, with file and line.
  std::vector<std::string> skipped;
};

}  // namespace delassus
