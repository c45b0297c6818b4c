/// Meshes: inline, from a file, or built in, each read when a geom first asks for it.
#pragma once

#include <delassus/adapters/mjcf/builtin_mesh.hpp>
#include <delassus/adapters/mjcf/compiler.hpp>
#include <delassus/adapters/mjcf/mesh_mass.hpp>
#include <delassus/io/obj.hpp>
#include <delassus/io/stl.hpp>
#include <delassus/model/model.hpp>

#include <cctype>
#include <string>

namespace delassus::inner::mjcf {

/// What `mesh` says that a class may say before it.
struct MeshSpec {
  Vec3 scale = {1, 1, 1};
  MeshInertia inertia = MeshInertia::legacy;
};

inline void read(const Element& e, MeshSpec& s, Skipped& skipped) {
  e.read("scale", s.scale);
  if (const int k = e.choice("inertia", {"convex", "legacy", "exact", "shell"}); k >= 0)
    s.inertia = MeshInertia(k);
  if (int most = -1; e.read("maxhullvert", most) && most >= 0)
    skipped.add_once(e, "maxhullvert", "maxhullvert: hulls keep all their vertices");
}

/// A mesh in the model, and what a solid of it weighs.
struct LoadedMesh {
  Index mesh = -1;
  MassProperties solid;  ///< per density, in the frame of the mesh
};

inline std::string file_stem(const std::string& file) { return std::filesystem::path(file).stem().string(); }

/// The path of a mesh's or height field's file; empty where it is not found.
inline std::string asset_path(const Element& e, const Document& document, const Compiler& c,
                              const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path file = c.strip_path ? fs::path(e.text("file")).filename() : fs::path(e.text("file"));
  return document.folders().find((fs::path(folder) / file).string(),
                                 {document.folder(), folder_of(e.file()->path)});
}

inline RawMesh mesh_of_file(const Element& e, const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& letter : ending) letter = char(std::tolower(static_cast<unsigned char>(letter)));
  const auto raw = [](TriangleList list) {
    return RawMesh{std::move(list.vertices), std::move(list.triangles)};
  };
  if (ending == ".obj") return raw(read_obj_list(path));
  if (ending == ".stl") return raw(read_stl(path));
  e.refuse("the mesh file '" + path + "' ends with '" + ending +
           "'; OBJ and STL are read, so convert it to one of them");
}

inline RawMesh inline_mesh(const Element& e, const Budget& budget) {
  RawMesh mesh;
  const std::vector<double> x = e.numbers("vertex"), corners = e.numbers("face");
  if (x.size() % 3 != 0)
    e.refuse("vertex of a mesh has " + std::to_string(x.size()) + " numbers, no multiple of 3");
  if (corners.size() % 3 != 0)
    e.refuse("face of a mesh has " + std::to_string(corners.size()) + " numbers, no multiple of 3");
  budget.expect_points(e, double(x.size()) / 3);
  for (std::size_t i = 0; i < x.size(); i += 3) mesh.vertices.push_back({x[i], x[i + 1], x[i + 2]});
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    std::array<Index, 3> t;
    for (std::size_t k = 0; k < 3; ++k) {
      const double corner = corners[i + k];
      if (!(corner >= 0 && corner < double(mesh.vertices.size())) || corner != std::floor(corner))
        e.refuse("corner " + text(corner) + " of face " + std::to_string(i / 3) + " is none of the " +
                 std::to_string(mesh.vertices.size()) + " vertices, which are counted from 0");
      t[k] = Index(corner);
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

/// Moved by refpos, turned back by refquat, then scaled.
inline void place_vertices(const Element& e, const Vec3& scale, RawMesh& mesh) {
  Vec3 origin = zero<Vec3>();
  e.read("refpos", origin);
  std::array<double, 4> q{1, 0, 0, 0};
  if (e.read("refquat", q, 4) && q == std::array<double, 4>{}) e.refuse("refquat of a mesh is zero");
  const Mat3 turn = rotation_matrix(unit(Quat(q[0], q[1], q[2], q[3])));
  for (Vec3& v : mesh.vertices) {
    v = transposed_times(turn, Vec3(v - origin));
    for (int k = 0; k < 3; ++k) v[k] *= scale[k];
  }
  if (scale[0] * scale[1] * scale[2] < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// Whether a mesh's data can be had at all.
inline bool is_there(const Element& e, const Document& document, const Compiler& c) {
  return !e.has("file") || !asset_path(e, document, c, c.mesh_folder).empty();
}

inline LoadedMesh load_mesh(const Element& e, const MeshSpec& s, const Document& document, const Compiler& c,
                            const std::string& name, Model& model, Budget& budget) {
  if (e.has("file") + (e.has("vertex") && !e.has("file")) + e.has("builtin") > 1)
    e.refuse("a mesh has one of file, vertex and builtin");
  RawMesh raw;
  if (e.has("builtin")) {
    raw = builtin_mesh(e, budget);
  } else if (e.has("file")) {
    const std::string path = asset_path(e, document, c, c.mesh_folder);
    if (path.empty())
      e.refuse("the mesh file '" + e.text("file") + "' is not found; name its folder in MjcfOptions::files");
    raw = mesh_of_file(e, path);
  } else {
    raw = inline_mesh(e, budget);
  }
  budget.take_points(e, double(raw.vertices.size()));
  if (raw.vertices.size() < 4)
    e.refuse("a mesh needs at least 4 vertices and has " + std::to_string(raw.vertices.size()));
  place_vertices(e, s.scale, raw);
  MeshInertia way = c.exact_mesh_inertia && s.inertia == MeshInertia::legacy ? MeshInertia::exact : s.inertia;
  LoadedMesh loaded{.mesh = Index(model.meshes.size())};
  try {
    if (raw.triangles.empty()) {
      const ConvexHull hull(raw.vertices);
      raw.triangles = hull_triangles(hull);
      raw.vertices.assign(hull.vertices().begin(), hull.vertices().end());
      if (way != MeshInertia::shell) way = MeshInertia::exact;
    }
    loaded.solid = mesh_solid(raw.vertices, raw.triangles, way);
  } catch (const InvalidArgument& error) {
    const std::string reason = error.what();
    e.refuse("the mesh has no hull: " + reason.substr(reason.find(": ") + 2));
  }
  if (!(loaded.solid.mass > 1e-15) || !(loaded.solid.mass <= 1e50))
    e.refuse("the mesh encloses " + text(loaded.solid.mass) +
             " m³, which is no volume; turn its faces outwards, or say inertia='shell'");
  model.meshes.push_back({name, std::move(raw.vertices), std::move(raw.triangles)});
  return loaded;
}

}  // namespace delassus::inner::mjcf
