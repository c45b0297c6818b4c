/// The meshes that a URDF names: where their files are, and their triangles in the model.
#pragma once

#include <delassus/adapters/urdf/source.hpp>
#include <delassus/io/obj.hpp>
#include <delassus/io/stl.hpp>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

namespace delassus {

/// How a URDF is read.
struct UrdfOptions {
  Base base = Base::as_file;  ///< what holds the root
  bool strict = false;        ///< refuse what would be named in `Model::skipped`
  /// The folder where names of meshes begin: `mesh.stl`, and `package://arm/mesh.stl` as `arm/mesh.stl`, or
  /// as `mesh.stl`. Empty: that of the file; the folders above it are searched for packages too.
  std::string meshes;
  std::map<std::string, std::string> packages;  ///< the folder of a package; asked first
};

namespace inner::urdf_file {

class Meshes {
 public:
  Meshes(Model& to, const UrdfOptions& options, std::string folder)
      : to_(to), options_(options), folder_(std::move(folder)) {}

  /// The index of a mesh of the model, or −1 with the reason why there is none.
  std::pair<Index, std::string> find(const std::string& name, const Vec3& scale) {
    const auto [known, is_new] = index_of_.emplace(std::tuple(name, scale[0], scale[1], scale[2]),
                                                   std::pair(Index(-1), std::string()));
    if (is_new) known->second = read(name, scale);
    return known->second;
  }

 private:
  using Path = std::filesystem::path;

  std::pair<Index, std::string> read(const std::string& name, const Vec3& scale) {
    const std::string ending = lower_case(Path(name).extension().string());
    if (ending != ".obj" && ending != ".stl") return {-1, "only .obj and .stl are read"};
    const Path path = path_of(name);
    if (path.empty())
      return {-1, "there is no such file; UrdfOptions::meshes and packages say where to look"};
    const TriangleList list = ending == ".obj" ? read_obj_list(path.string()) : read_stl(path.string());
    model::Mesh mesh{.name = name, .vertices = list.vertices, .triangles = list.triangles};
    if (mesh.vertices.size() < 4)
      refuse(path.string() + ": a hull needs four vertices, and there are " +
             std::to_string(mesh.vertices.size()));
    for (Vec3& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) v[k] *= scale[k];
    if (scale[0] * scale[1] * scale[2] < 0)  // a mirror turns triangles over
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    for (int n = 2; !names_.insert(mesh.name).second; ++n) mesh.name = name + "_" + std::to_string(n);
    to_.meshes.push_back(std::move(mesh));
    return {Index(to_.meshes.size()) - 1, ""};
  }

  static bool is_file(const Path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
  }

  /// Empty where there is no file.
  Path path_of(const std::string& name) const {
    const Path here = options_.meshes.empty() ? Path(folder_) : Path(options_.meshes);
    const std::size_t scheme = name.find("://");
    if (scheme == name.npos) return is_file(here / name) ? here / name : Path();
    const std::string rest = name.substr(scheme + 3);
    if (name.substr(0, scheme) == "file") return is_file(rest) ? Path(rest) : Path();
    if (name.substr(0, scheme) != "package") return {};
    const std::string package = rest.substr(0, rest.find('/')),
                      within = rest.substr(std::min(package.size() + 1, rest.size()));
    if (const auto found = options_.packages.find(package); found != options_.packages.end())
      return is_file(Path(found->second) / within) ? Path(found->second) / within : Path();
    for (const Path& candidate : {here / rest, here / within})
      if (is_file(candidate)) return candidate;
    return options_.meshes.empty() ? above(here, rest) : Path();
  }

  /// The file lies in the package, or beside it.
  static Path above(const Path& here, const std::string& rest) {
    std::error_code error;
    Path folder = std::filesystem::absolute(here, error);
    for (int level = 0; level < 16 && !error && folder.has_relative_path(); ++level) {
      folder = folder.parent_path();
      if (is_file(folder / rest)) return folder / rest;
    }
    return {};
  }

  Model& to_;
  const UrdfOptions& options_;
  std::string folder_;
  std::map<std::tuple<std::string, double, double, double>, std::pair<Index, std::string>> index_of_;
  std::set<std::string> names_;
};

}  // namespace inner::urdf_file
}  // namespace delassus
