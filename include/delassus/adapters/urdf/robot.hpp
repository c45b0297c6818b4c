/// The links and joints of a URDF by number, each with its line, and the same as a plain text for urdfdom.
#pragma once

#include <delassus/adapters/urdf/source.hpp>

#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace delassus::inner::urdf_file {

/// What bodies of a link do when they touch: an extension of Bullet's.
struct Touch {
  double friction = 1, rolling = 0, spinning = 0, restitution = 0;
};

struct CollisionElement {
  std::string name, mesh;  ///< `mesh` as the file names it
  int line = 0;
  bool is_capsule = false;  ///< urdfdom sees a cylinder of the same numbers
};

struct LinkElement {
  std::string name;
  int line = 0;
  bool has_inertial = false;
  std::vector<CollisionElement> collisions;
  Touch touch;
  Index joint = -1;                 ///< to its parent
  std::vector<Index> child_joints;  ///< in the order of the file
};

struct JointElement {
  std::string name, mimics;
  int line = 0, mimic_line = 0;
  Index parent = -1, child = -1;
};

/// Names become numbers, so that urdfdom sees nothing of the file but its numbers and the words of URDF.
class Robot {
 public:
  using Element = Source::Element;

  explicit Robot(Source& in) : in_(in) {
    in_.expect_attributes(in_.root());
    name = text(in_.root(), "name");
    check_version();
    in_.skip_all_but(in_.root(), {"link", "joint", "material"});
    for (const Element* e = in_.root().FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
      read_link(*e);
    if (links.empty()) in_.refuse_at(in_.root(), "the robot has no <link>");
    for (const Element* e = in_.root().FirstChildElement("joint"); e; e = e->NextSiblingElement("joint"))
      read_joint(*e);
    plain_ = "<robot name=\"r\">" + plain_ + "</robot>";
    find_order();
  }

  std::string name;
  std::vector<LinkElement> links;
  std::vector<JointElement> joints;
  std::vector<Index> order;  ///< links, parents first, from the root

  const std::string& plain() const { return plain_; }
  const LinkElement& link(Index i) const { return links[std::size_t(i)]; }
  const JointElement& joint(Index j) const { return joints[std::size_t(j)]; }
  /// −1 where there is none.
  Index joint_called(const std::string& wanted) const {
    const auto found = joint_of_.find(wanted);
    return found == joint_of_.end() ? -1 : found->second;
  }

 private:
  std::string text(const Element& of, const char* attribute) const {
    const char* found = of.Attribute(attribute);
    if (!found) in_.refuse_at(of, std::string("<") + of.Name() + "> needs the attribute '" + attribute + "'");
    return found;
  }
  static std::string text_or_none(const Element& of, const char* attribute) {
    const char* found = of.Attribute(attribute);
    return found ? found : "";
  }

  void check_version() const {
    const std::string version = text_or_none(in_.root(), "version");
    if (!version.empty() && version != "1.0" && version != "1")
      in_.refuse_at(in_.root(), "this is version '" + version.substr(0, 40) + "' of URDF; only 1.0 is read");
  }

  /// As it is, without what stands in it.
  void copy(const Element& of, const char* part) {
    if (const Element* e = in_.only(of, part)) {
      in_.skip_all_but(*e, {});
      plain_ += in_.numbers_of(*e);
    }
  }

  void read_link(const Element& e) {
    in_.expect_attributes(e);
    LinkElement link{.name = text(e, "name"), .line = e.GetLineNum()};
    if (!link_of_.emplace(link.name, Index(links.size())).second)
      in_.refuse_at(e, "a second link is called '" + link.name + "'; the first one stands on line " +
                           std::to_string(links[std::size_t(link_of_[link.name])].line));
    in_.skip_all_but(e, {"inertial", "visual", "collision", "contact"});
    plain_ += "<link name=\"" + std::to_string(links.size()) + "\">";
    if (const Element* inertial = in_.only(e, "inertial")) {
      link.has_inertial = true;
      in_.skip_all_but(*inertial, {"origin", "mass", "inertia"});
      plain_ += "<inertial>";
      for (const char* part : {"origin", "mass", "inertia"}) copy(*inertial, part);
      plain_ += "</inertial>";
    }
    for (const Element* c = e.FirstChildElement("collision"); c; c = c->NextSiblingElement("collision"))
      read_collision(*c, link);
    if (const Element* contact = in_.only(e, "contact")) read_touch(*contact, link.touch);
    plain_ += "</link>";
    links.push_back(std::move(link));
  }

  void read_collision(const Element& e, LinkElement& link) {
    in_.expect_attributes(e);
    CollisionElement collision{.name = text_or_none(e, "name"), .line = e.GetLineNum()};
    in_.skip_all_but(e, {"origin", "geometry", "material"});
    const Element* geometry = in_.only(e, "geometry");
    const Element* shape = geometry ? geometry->FirstChildElement() : nullptr;
    if (!shape)
      in_.refuse_at(e, "a collision of link '" + link.name + "' has no shape; give it a <geometry> with one");
    const std::string kind = shape->Name();
    if (kind != "box" && kind != "sphere" && kind != "cylinder" && kind != "capsule" && kind != "mesh")
      in_.refuse_at(*shape, "<" + kind.substr(0, 40) +
                                "> is no shape of URDF; it has box, sphere, cylinder, capsule and mesh");
    if (const Element* second = shape->NextSiblingElement())
      in_.skip(*second, "a second shape in one <geometry>");
    in_.expect_attributes(*shape);
    in_.skip_all_but(*shape, {});
    plain_ += "<collision>";
    copy(e, "origin");
    std::string tag = in_.numbers_of(*shape);
    collision.is_capsule = kind == "capsule";
    if (collision.is_capsule) tag = "<cylinder" + tag.substr(8);
    if (kind == "mesh") {
      collision.mesh = text(*shape, "filename");
      tag = "<mesh filename=\"m\"" + tag.substr(5);
    }
    plain_ += "<geometry>" + tag + "</geometry></collision>";
    link.collisions.push_back(std::move(collision));
  }

  void read_touch(const Element& e, Touch& touch) {
    in_.skip_all_but(e, {"lateral_friction", "rolling_friction", "spinning_friction", "restitution"});
    const auto read = [&](const char* kind, double& to) {
      if (const Element* part = in_.only(e, kind)) to = in_.number(*part, "value", to);
      if (to < 0) in_.refuse_at(e, std::string("<") + kind + "> must be >= 0");
    };
    read("lateral_friction", touch.friction);
    read("rolling_friction", touch.rolling);
    read("spinning_friction", touch.spinning);
    read("restitution", touch.restitution);
    if (touch.restitution > 1) in_.refuse_at(e, "<restitution> must be in [0, 1]");
  }

  void read_joint(const Element& e) {
    in_.expect_attributes(e);
    JointElement joint{.name = text(e, "name"), .line = e.GetLineNum()};
    if (!joint_of_.emplace(joint.name, Index(joints.size())).second)
      in_.refuse_at(e, "a second joint is called '" + joint.name + "'; the first one stands on line " +
                           std::to_string(joints[std::size_t(joint_of_[joint.name])].line));
    const std::string type = text(e, "type");
    static constexpr std::string_view types[] = {"revolute", "continuous", "prismatic",
                                                 "fixed",    "floating",   "planar"};
    if (std::find(std::begin(types), std::end(types), type) == std::end(types))
      in_.refuse_at(e, "joint '" + joint.name + "' is of type '" + type.substr(0, 40) +
                           "', which URDF does not have; it has revolute, continuous, prismatic, fixed, "
                           "floating and planar");
    in_.skip_all_but(e, {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"});
    joint.parent = end_of(e, "parent");
    joint.child = end_of(e, "child");
    LinkElement& child = links[std::size_t(joint.child)];
    if (child.joint >= 0)
      in_.refuse_at(e, "link '" + child.name + "' is the child of joint '" +
                           joints[std::size_t(child.joint)].name +
                           "' already; a URDF is a tree, so close a loop otherwise");
    child.joint = Index(joints.size());
    links[std::size_t(joint.parent)].child_joints.push_back(Index(joints.size()));
    plain_ += "<joint name=\"" + std::to_string(joints.size()) + "\" type=\"" + type + "\"><parent link=\"" +
              std::to_string(joint.parent) + "\"/><child link=\"" + std::to_string(joint.child) + "\"/>";
    for (const char* part : {"origin", "axis", "limit", "dynamics"}) copy(e, part);
    if (const Element* mimic = in_.only(e, "mimic")) {
      joint.mimics = text(*mimic, "joint");
      joint.mimic_line = mimic->GetLineNum();
      plain_ += "<mimic joint=\"m\"" + in_.numbers_of(*mimic).substr(6);
    }
    plain_ += "</joint>";
    joints.push_back(std::move(joint));
  }

  Index end_of(const Element& joint, const char* which) {
    const Element* e = in_.only(joint, which);
    if (!e) in_.refuse_at(joint, "joint '" + text(joint, "name") + "' has no <" + which + ">");
    const std::string link = text(*e, "link");
    const auto found = link_of_.find(link);
    if (found == link_of_.end()) in_.refuse_at(*e, "there is no link '" + link.substr(0, 80) + "'");
    return found->second;
  }

  void find_order() {
    Index root = -1;
    for (Index i = 0; i < Index(links.size()); ++i) {
      if (link(i).joint >= 0) continue;
      if (root >= 0)
        in_.refuse_at(link(i).line, "links '" + link(root).name + "' and '" + link(i).name +
                                        "' have no parent, and only the root may have none");
      root = i;
    }
    if (root < 0)
      in_.refuse_at(links[0].line,
                    "each link is the child of another, so there is no root; the joints run in a circle");
    std::vector<Index> next{root};
    while (!next.empty()) {
      const Index i = next.back();
      next.pop_back();
      order.push_back(i);
      const std::vector<Index>& children = link(i).child_joints;
      for (auto j = children.rbegin(); j != children.rend(); ++j) next.push_back(joint(*j).child);
    }
    if (order.size() == links.size()) return;
    std::vector<bool> is_reached(links.size());
    for (const Index i : order) is_reached[std::size_t(i)] = true;
    const auto lost =
        std::size_t(std::find(is_reached.begin(), is_reached.end(), false) - is_reached.begin());
    in_.refuse_at(links[lost].line, "link '" + links[lost].name + "' does not hang on the root '" +
                                        link(root).name + "'; the joints above it run in a circle");
  }

  Source& in_;
  std::string plain_;
  std::map<std::string, Index> link_of_, joint_of_;
};

}  // namespace delassus::inner::urdf_file
