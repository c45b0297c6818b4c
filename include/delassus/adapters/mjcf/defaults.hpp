/// Classes: what elements are before they say anything themselves.
#pragma once

#include <delassus/adapters/mjcf/actuator.hpp>
#include <delassus/adapters/mjcf/geom.hpp>
#include <delassus/adapters/mjcf/joint.hpp>
#include <delassus/adapters/mjcf/mesh.hpp>
#include <delassus/adapters/mjcf/relations.hpp>

#include <map>
#include <string>

namespace delassus::inner::mjcf {

/// What `site` says.
struct SiteSpec {
  GeomType type = GeomType::sphere;
  Placement placement;
  Sizes size{0.005, 0.005, 0.005};
};

inline void read(const Element& e, const Compiler& c, SiteSpec& s) {
  s.type = read_type(e, s.type);
  read(e, c, s.placement);
  e.read("size", s.size, 1);
}

/// A class. All actuators of a class share one set of values, whatever they are called: the last that is said
/// holds.
struct Defaults {
  JointSpec joint;
  GeomSpec geom;
  SiteSpec site;
  MeshSpec mesh;
  PairSpec pair;
  EqualitySpec equality;
  TendonSpec tendon;
  ActuatorSpec actuator;
};

/// The classes of a document by name; "main" is there always.
class Classes {
 public:
  Classes() { all_["main"]; }

  /// Reads a section `default`.
  void read_section(const Document& document, const Element& e, const Compiler& c, Skipped& skipped) {
    const std::string name = e.text("class", "main");
    if (name != "main")
      e.refuse("the outermost class is 'main' and not '" + name + "'; put a <default class='" + name +
               "'> within it");
    read_class(document, e, all_["main"], c, skipped);
  }

  const Defaults& main() const { return all_.at("main"); }
  /// The class that an attribute names; `otherwise` where it names none.
  const Defaults& of(const Element& e, const char* attribute, const Defaults& otherwise) const {
    if (!e.has(attribute)) return otherwise;
    const auto found = all_.find(e.text(attribute));
    if (found == all_.end())
      e.refuse("there is no class '" + e.text(attribute).substr(0, 200) +
               "'; define it in a section 'default'");
    return found->second;
  }

 private:
  void read_class(const Document& document, const Element& e, Defaults& d, const Compiler& c,
                  Skipped& skipped) {
    document.for_each(e, [&](const Element& child) {
      const std::string_view name = child.name();
      if (name == "joint")
        read(child, d.joint, skipped);
      else if (name == "geom")
        read(child, c, d.geom, skipped);
      else if (name == "site")
        read(child, c, d.site);
      else if (name == "mesh")
        read(child, d.mesh, skipped);
      else if (name == "pair")
        read(child, d.pair, skipped);
      else if (name == "equality")
        read(child, d.equality, skipped);
      else if (name == "tendon")
        read(child, d.tendon, skipped);
      else if (name != "default" && name != "material" && name != "camera" && name != "light")
        read(child, d.actuator, skipped);
    });
    document.for_each(e, [&](const Element& child) {  // after all of its own, wherever they stand
      if (child.name() != "default") return;
      const std::string name = child.required("class");
      const auto [at, is_new] = all_.try_emplace(name, d);
      if (!is_new || name.empty()) child.refuse("the class '" + name + "' is there already, or has no name");
      read_class(document, child, at->second, c, skipped);
    });
  }

  std::map<std::string, Defaults> all_;
};

}  // namespace delassus::inner::mjcf
