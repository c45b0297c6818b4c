/// What is known while a machine is read: its documents, and the model as far as it has come.
#pragma once

#include <delassus/adapters/mjcf/defaults.hpp>
#include <delassus/adapters/mjcf/names.hpp>
#include <delassus/model/model.hpp>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace delassus::inner::mjcf {

/// An element by its name, and the class that it stands in.
struct Named {
  Element element;
  const Defaults* defaults;
};

/// One document with what it defines.
struct Source {
  explicit Source(std::unique_ptr<Document> from) : document(std::move(from)) {}

  std::unique_ptr<Document> document;
  Compiler compiler;
  Classes classes;
  std::map<std::string, Source*> models;  ///< that it may attach
  std::map<std::string, Named> meshes;
  std::map<std::string, Element> fields;
  std::map<std::string, LoadedMesh> loaded_meshes;
  std::map<std::string, Index> loaded_fields;
  std::map<std::string, Named> bodies, frames;  ///< that it may attach
};

/// A body's parts until it has its mass.
struct BodyParts {
  Element element;
  const Source* source;
  std::vector<MassProperties> geoms;
  bool has_inertial = false;
  MassProperties inertial;
};

/// A copy of a whole document in the model, for its sections beside the bodies.
struct Copy {
  const Source* source;
  int scope;
  Index first_joint, end_joint;  ///< in the order of reading
  std::vector<bool> joints;      ///< which of the model's are of the copy
};

struct Reading {
  Model& model;
  Skipped skipped;
  Budget budget;
  Folders folders;
  Names names;
  std::vector<std::unique_ptr<Source>> sources;
  std::vector<BodyParts> parts;  ///< one a body
  std::vector<Copy> copies;
  std::vector<std::string> open_models;  ///< files that are being read, from the outermost on
  std::vector<const tinyxml2::XMLElement*> open_attached;
};

/// An element of a section beside the bodies, in the scope of one copy.
struct Instance {
  Element element;
  const Source* source;
  int scope;

  std::string name(const Reading& r) const {
    return r.names.scopes[std::size_t(scope)].name(element.text("name"));
  }
  /// What an attribute of it names. Pre: the attribute is among those by which the scope was found.
  Index find(const Reading& r, Kind kind, const char* attribute) const {
    return r.names.find({kind, element.text(attribute)}, scope);
  }
};

/// A body's pose in the world, as the file has it.
inline Pose pose_in_world(const Model& model, Index body) {
  Pose pose;
  for (; body >= 0; body = model.bodies[std::size_t(body)].parent)
    pose = product(model.bodies[std::size_t(body)].pose, pose);
  return pose;
}

}  // namespace delassus::inner::mjcf
