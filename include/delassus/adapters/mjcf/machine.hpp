/// A whole machine out of its documents.
#pragma once

#include <delassus/adapters/mjcf/copies.hpp>
#include <delassus/adapters/mjcf/equalities.hpp>
#include <delassus/adapters/mjcf/keys.hpp>
#include <delassus/adapters/mjcf/masses.hpp>
#include <delassus/adapters/mjcf/options.hpp>
#include <delassus/adapters/mjcf/tendons.hpp>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace delassus::inner::mjcf {

inline Source& open_source(Reading& r, const std::string& text, const std::string& path);

/// A model among the assets; a file is read once.
inline void read_model_asset(Reading& r, const Element& e, Source& source) {
  const std::string file = e.required("file");
  const std::string path = r.folders.find(file, {source.document->folder(), folder_of(e.file()->path)});
  if (path.empty())
    e.refuse("the model file '" + file.substr(0, 200) +
             "' is not found; name its folder in MjcfOptions::files");
  const std::string key = Document::canonical(path);
  for (const std::string& open : r.open_models)
    if (open == key) e.refuse("the model file '" + file + "' has itself among its assets, without end");
  if (r.open_models.size() > 50) e.refuse("model files lie within each other deeper than 50");
  Source* found = nullptr;
  for (const auto& old : r.sources)
    if (Document::canonical(old->document->root().file()->path) == key) found = old.get();
  if (!found) found = &open_source(r, read_text(path), path);
  const std::string name = e.text("name", found->document->root().text("model").c_str());
  if (!source.models.try_emplace(name, found).second)
    e.refuse("there are two models '" + name + "' among the assets");
}

inline void read_asset(Reading& r, const Element& e, Source& source) {
  const std::string_view kind = e.name();
  if (kind == "model") return read_model_asset(r, e, source);
  if (kind != "mesh" && kind != "hfield") return;
  std::string name = e.text("name");
  if (name.empty()) name = file_stem(e.text("file"));
  const bool is_new =
      kind == "mesh"
          ? source.meshes.try_emplace(name, Named{e, &source.classes.of(e, "class", source.classes.main())})
                .second
          : source.fields.try_emplace(name, e).second;
  if (!is_new)
    e.refuse("the name '" + name + "' is given to two of kind " + std::string(kind) + "; rename one");
}

/// Parses a document and reads what comes before its bodies.
inline Source& open_source(Reading& r, const std::string& text, const std::string& path) {
  r.open_models.push_back(Document::canonical(path));
  r.sources.push_back(std::make_unique<Source>(std::make_unique<Document>(text, path, r.folders, r.skipped, r.budget)));
  Source& source = *r.sources.back();
  const Document& document = *source.document;
  document.for_each_section("compiler", [&](const Element& e) { read(e, source.compiler, r.skipped); });
  document.for_each_section("default", [&](const Element& e) {
    source.classes.read_section(document, e, source.compiler, r.skipped);
  });
  document.for_each_section("asset", [&](const Element& section) {
    document.for_each(section, [&](const Element& e) { read_asset(r, e, source); });
  });
  document.for_each_section("worldbody",
                            [&](const Element& e) { index_named(source, e, source.classes.main()); });
  for (const char* section : {"extension", "deformable"})
    document.for_each_section(section, [&](const Element& e) {
      if (e.xml()->FirstChildElement()) r.skipped.add(e, std::string(section) + " is left out");
    });
  document.for_each_section("sensor", [&](const Element& e) {
    if (e.xml()->FirstChildElement()) r.skipped.add_once(e, "sensor", "sensors: nothing measures here");
  });
  r.open_models.pop_back();
  return source;
}

/// Puts joints, geoms and sites into the order of their bodies, as the file's keyframes count them.
template <class T, class BodyOf>
std::vector<Index> sort_by_body(std::vector<T>& all, BodyOf&& body_of) {
  std::vector<Index> order(all.size()), to(all.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return body_of(a) < body_of(b); });
  std::vector<T> sorted;
  sorted.reserve(all.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    to[std::size_t(order[i])] = Index(i);
    sorted.push_back(std::move(all[std::size_t(order[i])]));
  }
  all = std::move(sorted);
  return to;
}

inline void sort_by_bodies(Reading& r) {
  Model& model = r.model;
  std::vector<Index> owner(model.joints.size(), -1);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Index j : model.bodies[b].joints) owner[std::size_t(j)] = Index(b);
  const std::vector<Index> joints =
      sort_by_body(model.joints, [&](Index j) { return owner[std::size_t(j)]; });
  for (model::Body& body : model.bodies)
    for (Index& j : body.joints) j = joints[std::size_t(j)];
  for (Copy& copy : r.copies) {
    copy.joints.assign(joints.size(), false);
    for (Index j = copy.first_joint; j < copy.end_joint; ++j)
      copy.joints[std::size_t(joints[std::size_t(j)])] = true;
  }
  r.names.renumber(Kind::joint, joints);
  const auto by_body = [](const auto& all) { return [&](Index i) { return all[std::size_t(i)].body; }; };
  r.names.renumber(Kind::geom, sort_by_body(model.geometries, by_body(model.geometries)));
  r.names.renumber(Kind::site, sort_by_body(model.sites, by_body(model.sites)));
}

inline void read_machine(Reading& r, const std::string& text, const std::string& path) {
  Model& model = r.model;
  Source& source = open_source(r, text, path);
  const Document& document = *source.document;
  model.name = document.root().text("model", file_stem(path).c_str());
  model.time_step = 0.002;
  Flags flags;
  document.for_each_section("option",
                            [&](const Element& e) { read_option(document, e, flags, model, r.skipped); });
  r.copies.push_back({&source, 0, 0, 0, {}});
  document.for_each_section("worldbody", [&](const Element& world) {
    if (world.xml()->FirstAttribute()) world.refuse("worldbody has no attributes");
    read_children(r, world, {source, 0, -1, {}, &source.classes.main(), 0});
  });
  r.copies.front().end_joint = Index(model.joints.size());
  for (std::size_t i = 1; i < r.sources.size(); ++i)
    r.sources[i]->document->for_each_section("option", [&](const Element& e) {
      r.skipped.add_once(e, "option",
                         "option: time step, gravity and flags are those of the outermost model");
    });
  sort_by_bodies(r);
  set_masses(r);
  expect_masses(r);
  read_tendons(r);
  read_equalities(r);
  const Controls controls = read_actuators(r);
  read_contacts(r);
  read_keys(r, controls);
  apply(flags, model);
}

}  // namespace delassus::inner::mjcf
