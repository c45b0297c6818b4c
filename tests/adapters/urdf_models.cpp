// Files of other projects, in the folder that DELASSUS_MODELS names: what is read of them equals what urdfdom
// says, worked out here with urdfdom's own rotations in the pose where all joints are at zero.
#include <delassus/adapters/urdf.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace urdf_models_tests {

using namespace delassus;
using Catch::Contains;

namespace {

/// Why a file is refused. All others must be read.
const std::map<std::string, const char*> reasons = {
    {"bullet/hinge.urdf", ":41: joint 'joint_baseLink_childA' is of type 'spherical'"},
    {"bullet/prismatic.urdf",
     ":41: urdfdom does not take joint 'joint_baseLink_childA': joint limit: no effort"},
    {"bullet/humanoid.urdf",
     ":28: link 'link1_2' has no mass, and no fixed joint holds it to a link that has"},
};

std::vector<std::filesystem::path> urdf_files() {
  std::vector<std::filesystem::path> files;
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS is not set: the files of other projects are left out");
    return files;
  }
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(folder) / "urdf"))
    if (entry.path().extension() == ".urdf") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// With its folder.
std::string name_of(const std::filesystem::path& file) {
  return (file.parent_path().filename() / file.filename()).string();
}

Vec3 vec(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

/// A frame in the root's.
struct Frame {
  urdf::Rotation turn;
  urdf::Vector3 place;

  Vec3 of_point(const urdf::Vector3& p) const { return vec(turn * p) + vec(place); }
  Vec3 of_vector(const urdf::Vector3& v) const { return vec(turn * v); }
  Frame then(const urdf::Pose& p) const { return {turn * p.rotation, turn * p.position + place}; }
};
Frame frame_of(const urdf::Link& link) {
  if (!link.getParent()) return {};
  return frame_of(*link.getParent()).then(link.parent_joint->parent_to_joint_origin_transform);
}

struct Sum {
  double mass = 0;
  Vec3 moment = zero<Vec3>();  // of mass, about the root's origin
  Mat3 second = Mat3::Zero();  // Σ m r rᵀ of points, from the inertias
};

/// The second moment of mass about the root's origin: Σ = ½ tr(I) 1 − I about the centre, and m c cᵀ.
void add_link(Sum& to, const urdf::Link& link) {
  if (!link.inertial) return;
  const urdf::Inertial& i = *link.inertial;
  const Frame at = frame_of(link).then(i.origin);
  const double s[3][3] = {{(i.iyy + i.izz - i.ixx) / 2, -i.ixy, -i.ixz},
                          {-i.ixy, (i.izz + i.ixx - i.iyy) / 2, -i.iyz},
                          {-i.ixz, -i.iyz, (i.ixx + i.iyy - i.izz) / 2}};
  const Vec3 axes[3] = {at.of_vector({1, 0, 0}), at.of_vector({0, 1, 0}), at.of_vector({0, 0, 1})},
             centre = vec(at.place);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) to.second += s[r][c] * axes[r] * axes[c].transpose();
  to.mass += i.mass;
  to.moment += i.mass * centre;
  to.second += i.mass * centre * centre.transpose();
}

/// The same of a body of the model, at `pose`.
Sum sum_of(const model::Body& body, const Pose& pose) {
  const Mat3 inertia = pose.rotation * body.inertia * pose.rotation.transpose();
  const Vec3 centre = pose.to_world(body.centre);
  Sum sum{.mass = body.mass, .moment = body.mass * centre};
  sum.second = 0.5 * inertia.trace() * Mat3::Identity() - inertia + body.mass * centre * centre.transpose();
  return sum;
}

std::vector<Pose> poses_of(const Model& m) {
  std::vector<Pose> poses;
  for (const model::Body& b : m.bodies) {
    const Pose parent = b.parent < 0 ? Pose{} : poses[std::size_t(b.parent)];
    poses.push_back({parent.to_world(b.pose.position), parent.rotation * b.pose.rotation});
  }
  return poses;
}

/// Which body has a link, −1 for the world: the one of its name, or that of the site of its name.
std::map<std::string, Index> owners_of(const Model& m) {
  std::map<std::string, Index> owners;
  for (std::size_t i = 0; i < m.bodies.size(); ++i) owners[m.bodies[i].name] = Index(i);
  for (const model::Site& s : m.sites) owners[s.name] = s.body;
  return owners;
}

/// urdfdom's own reading, its words on the console left out.
urdf::ModelInterfaceSharedPtr reading_of(const std::string& path) {
  console_bridge::noOutputHandler();
  auto made = urdf::parseURDFFile(path);
  console_bridge::restorePreviousOutputHandler();
  return made;
}

void check_joint(const Model& m, const std::vector<Pose>& poses, const std::map<std::string, Index>& owners,
                 const urdf::ModelInterface& r, const urdf::Joint& joint) {
  INFO(joint.name);
  const auto found = std::find_if(m.joints.begin(), m.joints.end(),
                                  [&](const model::Joint& j) { return j.name == joint.name; });
  REQUIRE(found != m.joints.end());
  const Index index = Index(found - m.joints.begin()), owner = owners.at(joint.child_link_name);
  REQUIRE(owner >= 0);
  const model::Body& body = m.bodies[std::size_t(owner)];
  CHECK(body.joints == std::vector<Index>{index});
  CHECK(body.parent == owners.at(joint.parent_link_name));
  CHECK(found->kind ==
        (joint.type == urdf::Joint::PRISMATIC ? model::JointKind::slide : model::JointKind::hinge));
  const Frame at = frame_of(*r.getLink(joint.child_link_name));
  CHECK((poses[std::size_t(owner)].to_world(found->point) - vec(at.place)).norm() < 1e-9);
  CHECK((poses[std::size_t(owner)].rotation * found->axis - at.of_vector(joint.axis) / vec(joint.axis).norm())
            .norm() < 1e-9);
  CHECK(found->is_limited == (joint.type != urdf::Joint::CONTINUOUS));
  if (joint.limits) {
    CHECK(
        (!found->is_limited || (found->lower == joint.limits->lower && found->upper == joint.limits->upper)));
    CHECK(found->effort == joint.limits->effort);
    CHECK(found->speed == joint.limits->velocity);
  }
  CHECK(found->damping == (joint.dynamics ? joint.dynamics->damping : 0));
  CHECK(found->friction_loss == (joint.dynamics ? joint.dynamics->friction : 0));
  const auto coupled = std::find_if(m.couplings.begin(), m.couplings.end(),
                                    [&](const model::Coupling& c) { return c.joint == index; });
  REQUIRE((coupled != m.couplings.end()) == bool(joint.mimic));
  if (joint.mimic) {
    CHECK(m.joints[std::size_t(coupled->other)].name == joint.mimic->joint_name);
    CHECK(coupled->coefficients ==
          std::array<double, 5>{joint.mimic->offset, joint.mimic->multiplier, 0, 0, 0});
  }
}

void check_masses(const Model& m, const std::vector<Pose>& poses, const std::map<std::string, Index>& owners,
                  const urdf::ModelInterface& r) {
  std::vector<Sum> wanted(m.bodies.size());
  for (const auto& [name, link] : r.links_) {
    INFO(name);
    REQUIRE(owners.count(name) == 1);
    if (owners.at(name) >= 0) add_link(wanted[std::size_t(owners.at(name))], *link);
  }
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    INFO(m.bodies[i].name);
    const Sum sum = sum_of(m.bodies[i], poses[i]);
    CHECK(sum.mass == wanted[i].mass);
    CHECK((sum.moment - wanted[i].moment).norm() <= 1e-9 * wanted[i].moment.norm() + 1e-15);
    CHECK((sum.second - wanted[i].second).norm() <= 1e-9 * wanted[i].second.norm());
    CHECK((poses[i].position - vec(frame_of(*r.getLink(m.bodies[i].name)).place)).norm() < 1e-9);
  }
}

}  // namespace

TEST_CASE(
    "URDF files of other projects are read as urdfdom reads them, or refused for a reason that is known") {
  int are_read = 0, are_refused = 0;
  for (const auto& file : urdf_files()) {
    const std::string path = file.string();
    INFO(path);
    if (const auto reason = reasons.find(name_of(file)); reason != reasons.end()) {
      CHECK_THROWS_WITH(read_urdf(path), Contains(path + reason->second));
      ++are_refused;
      continue;
    }
    const Model m = read_urdf(path);
    const auto r = reading_of(path);
    REQUIRE(r);
    const std::vector<Pose> poses = poses_of(m);
    const std::map<std::string, Index> owners = owners_of(m);
    check_masses(m, poses, owners, *r);
    std::size_t moving = 0, collisions = 0, absent = 0;
    for (const auto& [name, joint] : r->joints_)
      if (joint->type != urdf::Joint::FIXED) check_joint(m, poses, owners, *r, *joint), ++moving;
    const bool is_free = !m.joints.empty() && m.joints[0].kind == model::JointKind::free;
    CHECK(m.joints.size() == moving + is_free);
    CHECK(is_free == (r->getRoot()->name != "world" && owners.at(r->getRoot()->name) >= 0));
    for (const auto& [name, link] : r->links_) collisions += link->collision_array.size();
    for (const std::string& s : m.skipped) absent += s.find("collision mesh") != s.npos;
    CHECK(m.geometries.size() + absent == collisions);
    for (const std::string& s : m.skipped) CHECK_THAT(s, Catch::StartsWith(path + ":"));
    ++are_read;
  }
  if (are_read > 0) CHECK(are_refused == 3);
}

TEST_CASE("the base of each URDF file of other projects can be asked for") {
  for (const auto& file : urdf_files()) {
    if (reasons.count(name_of(file))) continue;
    INFO(file.string());
    const Model fixed = read_urdf(file.string(), {.base = Base::fixed});
    for (const model::Joint& j : fixed.joints) CHECK(j.kind != model::JointKind::free);
    try {
      const Model free = read_urdf(file.string(), {.base = Base::free});
      CHECK(free.joints.at(0).kind == model::JointKind::free);
    } catch (const InvalidArgument& refused) {
      CHECK_THAT(refused.what(), Contains(": the root '") && Contains("has no mass"));
    }
  }
}

}  // namespace urdf_models_tests
