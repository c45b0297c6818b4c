/// A model's files as one: those that it includes stand in place of `include`.
#pragma once

#include <delassus/adapters/mjcf/known.hpp>
#include <delassus/adapters/mjcf/source.hpp>
#include <delassus/io/inner/text_reader.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace delassus::inner::mjcf {

/// Where files are looked for besides the folder of the one that names them.
struct Folders {
  std::vector<std::string> extra;

  /// The path of a file: in one of `first`, or in an extra folder, whole or by the ends of its path
  /// ("../a/b.xml" is also looked for as "a/b.xml" and "b.xml"). Empty: it is nowhere.
  std::string find(const std::string& file, const std::vector<std::string>& first) const {
    namespace fs = std::filesystem;
    std::error_code none;
    if (file.size() > 4000) return {};
    const fs::path path(file);
    for (const std::string& folder : first)
      if (const fs::path p = fs::path(folder) / path; fs::is_regular_file(p, none)) return p.string();
    std::vector<fs::path> parts;
    for (const fs::path& part : path)
      if (part != ".." && part != "." && part != path.root_path()) parts.push_back(part);
    for (std::size_t from = 0; from < parts.size(); ++from) {
      fs::path tail;
      for (std::size_t k = from; k < parts.size(); ++k) tail /= parts[k];
      for (const std::string& folder : extra)
        if (const fs::path p = fs::path(folder) / tail; fs::is_regular_file(p, none)) return p.string();
    }
    return {};
  }
};

inline std::string folder_of(const std::string& path) {
  return std::filesystem::path(path).parent_path().string();
}

/// The files of one model. Elements stay where they are as long as it lives.
class Document {
 public:
  /// Pre: `text` is what the file holds.
  Document(const std::string& text, const std::string& path, const Folders& folders, Skipped& skipped, Budget& budget)
      : folders_(folders), folder_(folder_of(path)), skipped_(skipped), budget_(budget) {
    const Element root = parse(text, path);
    if (root.name() != "mujoco")
      root.refuse("the first element is '" + std::string(root.name()) + "'; MJCF begins with 'mujoco'");
    check_known("mujoco", root);
    included_.push_back(canonical(path));
    scan(root, "mujoco", 0);
  }

  /// One name for one file, however it is written.
  static std::string canonical(const std::string& path) {
    std::error_code none;
    const auto found = std::filesystem::weakly_canonical(path, none);
    return none ? path : found.string();
  }

  Element root() const { return {files_.front()->xml.RootElement(), files_.front().get()}; }
  const std::string& folder() const { return folder_; }
  const Folders& folders() const { return folders_; }

  /// Calls visit(element) for each child, with those of an included file in place of `include`.
  template <class Visit>
  void for_each(const Element& parent, Visit&& visit) const {
    for (const auto* xml = parent.xml()->FirstChildElement(); xml; xml = xml->NextSiblingElement()) {
      const auto found = includes_.empty() ? includes_.end() : includes_.find(xml);
      if (found == includes_.end())
        visit(Element(xml, parent.file()));
      else
        for_each(Element(found->second->xml.RootElement(), found->second), visit);
    }
  }
  /// The sections of a name, as `worldbody`: there may be several.
  template <class Visit>
  void for_each_section(std::string_view name, Visit&& visit) const {
    for_each(root(), [&](const Element& e) {
      if (e.name() == name) visit(e);
    });
  }

 private:
  static constexpr int deepest = 500;

  Element parse(const std::string& text, const std::string& path) {
    budget_.take_text(path, text);
    files_.push_back(std::make_unique<File>());
    File& file = *files_.back();
    file.path = path;
    const tinyxml2::XMLError error = file.xml.Parse(text.data(), text.size());
    if (error != tinyxml2::XML_SUCCESS) {
      const std::string at = path + ":" + std::to_string(std::max(1, file.xml.ErrorLineNum())) + ": ";
      DELASSUS_EXPECT(error != tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED,
                      at + "elements lie within each other deeper than tinyxml2 reads; put inner parts into "
                           "files that `include` names");
      refuse(at + "this is no XML (" + tinyxml2::XMLDocument::ErrorIDToName(error) + ")");
    }
    const auto* root = file.xml.RootElement();
    DELASSUS_EXPECT(root != nullptr, path + ":1: there is no element");
    if (const auto* second = root->NextSiblingElement())
      Element(second, &file)
          .refuse("an element '" + std::string(second->Name()).substr(0, 40) + "' stands beside '" + root->Name() +
                  "'; a file has one that holds all others");
    return {root, &file};
  }

  /// Names what stands between elements and is none: an element that has lost its `<` becomes a text.
  void skip_texts(const Element& of) {
    for (const auto* node = of.xml()->FirstChild(); node; node = node->NextSibling())
      if (node->ToText() || node->ToUnknown())
        skipped_.add(of, node->GetLineNum(),
                     "'" + beginning(node->Value()) + "' in " + std::string(of.name()) +
                         " is no element, and is passed over");
  }

  /// Reads what is included, and refuses what is not known. A section is the name under which children are
  /// looked up.
  void scan(const Element& parent, std::string_view section, int depth) {
    if (depth > deepest)
      parent.refuse("elements lie within each other deeper than " + std::to_string(deepest));
    skip_texts(parent);
    for (const auto* xml = parent.xml()->FirstChildElement(); xml; xml = xml->NextSiblingElement()) {
      const Element e(xml, parent.file());
      if (!check_known(section, e)) {
        scan_unread(e, depth + 1);
      } else if (e.name() == "include") {
        scan(include(e), section, depth + 1);
      } else {
        scan(e, known::section_of(e.name()), depth + 1);
      }
    }
  }
  /// Of what is of no account: includes and numbers alone.
  void scan_unread(const Element& parent, int depth) {
    if (depth > deepest)
      parent.refuse("elements lie within each other deeper than " + std::to_string(deepest));
    for (const auto* xml = parent.xml()->FirstChildElement(); xml; xml = xml->NextSiblingElement()) {
      const Element e(xml, parent.file());
      if (e.name() == "include") {
        check_known("", e);
        scan_unread(include(e), depth + 1);
      } else {
        check_numbers(e);
        scan_unread(e, depth + 1);
      }
    }
  }

  Element include(const Element& e) {
    if (e.xml()->FirstChildElement()) e.refuse("an include must have no children");
    const std::string file = e.required("file");
    const std::string path = folders_.find(file, {folder_, folder_of(e.file()->path)});
    if (path.empty())
      e.refuse("the file '" + file.substr(0, 200) +
               "' to include is not found; name its folder in MjcfOptions::files");
    const std::string name = canonical(path);
    for (const std::string& old : included_)
      if (old == name) e.refuse("the file '" + file + "' is included already; a file may be included once");
    included_.push_back(name);
    const Element root = parse(read_text(path), path);
    includes_[e.xml()] = root.file();
    return root;
  }

  Folders folders_;
  std::string folder_;
  Skipped& skipped_;
  Budget& budget_;
  std::vector<std::unique_ptr<File>> files_;
  std::vector<std::string> included_;
  std::map<const tinyxml2::XMLElement*, const File*> includes_;
};

}  // namespace delassus::inner::mjcf
