/// Triangle meshes from Wavefront OBJ files.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/geometry/triangle_list.hpp>
#include <delassus/geometry/triangle_mesh.hpp>
#include <delassus/io/inner/text_reader.hpp>

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

namespace delassus {
namespace inner {

/// The lines `v` and `f` of a file; all others are passed over.
class ObjReader : public TriangleList {
 public:
  ObjReader(std::string_view text, std::string name) : name_(std::move(name)) {
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      ++line_;
      rest_ = text.substr(0, end);
      text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
      const std::string_view key = word();
      if (key == "v") read_vertex();
      if (key == "f") read_face();
    }
  }

 private:
  std::string where() const { return name_ + ":" + std::to_string(line_); }

  std::string_view word() {
    const std::size_t first = rest_.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    rest_.remove_prefix(first);
    const std::string_view found = rest_.substr(0, rest_.find_first_of(" \t\r"));
    rest_.remove_prefix(found.size());
    return found;
  }

  void read_vertex() {
    Vec3 v;
    for (int k = 0; k < 3; ++k) {
      const std::string_view w = word();
      const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), v[k]);
      DELASSUS_EXPECT(
          error == std::errc{} && end == w.data() + w.size() && std::isfinite(v[k]),
          where() + ": coordinate '" + std::string(w) + "' of a vertex is no finite number; write v x y z");
    }
    vertices.push_back(v);
  }

  /// A corner is an index from 1, or from −1 back from the newest vertex; what follows a slash is not for us.
  Index corner(std::string_view w) const {
    w = w.substr(0, w.find('/'));
    Index i = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), i);
    DELASSUS_EXPECT(error == std::errc{} && end == w.data() + w.size(),
                    where() + ": corner '" + std::string(w) + "' of a face is no index; write f 1 2 3");
    const Index count = Index(vertices.size()), v = i < 0 ? count + i : i - 1;
    DELASSUS_EXPECT(
        v >= 0 && v < count && i != 0,
        where() + ": vertex " + std::to_string(i) + " is not among the " + std::to_string(count) + " above");
    return v;
  }

  /// A polygon becomes a fan about its first corner.
  void read_face() {
    std::array<Index, 3> t{-1, -1, -1};
    int count = 0;
    for (std::string_view w = word(); !w.empty() && w[0] != '#'; w = word(), ++count) {
      const Index v = corner(w);
      if (count == 0) t[0] = v;
      t[1] = t[2];
      t[2] = v;
      if (count >= 2) triangles.push_back(t);
    }
    DELASSUS_EXPECT(count >= 3,
                    where() + ": a face of " + std::to_string(count) + " corners; it needs at least 3");
  }

  std::string name_;
  std::string_view rest_;
  Index line_ = 0;
};

}  // namespace inner

/// The mesh of the lines `v x y z` (m) and `f …` in a text; polygons must be convex. `name` stands in what is
/// thrown, with the line: `name:3: …`.
inline TriangleMesh parse_obj(std::string_view text, const std::string& name) {
  const inner::ObjReader reader(text, name);
  DELASSUS_EXPECT(!reader.triangles.empty(), name + ": there is no face");
  return TriangleMesh(reader.vertices, reader.triangles);
}

/// Vertices and faces alone, whatever surface they make, or none.
inline TriangleList parse_obj_list(std::string_view text, const std::string& name) { return inner::ObjReader(text, name); }

/// The mesh of a file.
inline TriangleMesh read_obj(const std::string& path) { return parse_obj(inner::read_text(path), path); }

/// The vertices and faces of a file.
inline TriangleList read_obj_list(const std::string& path) { return parse_obj_list(inner::read_text(path), path); }

}  // namespace delassus
