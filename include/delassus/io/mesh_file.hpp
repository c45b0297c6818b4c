/// Tetrahedral and hexahedral meshes from the files of Gmsh and VTK.
#pragma once

#include <delassus/geometry/hexahedral_mesh.hpp>
#include <delassus/geometry/quadratic_tetrahedral_mesh.hpp>
#include <delassus/geometry/tetrahedral_mesh.hpp>
#include <delassus/io/inner/text_reader.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace delassus {
namespace inner {

/// What the cells of a mesh are to Gmsh and to VTK, and how many points they have. Both name the points in
/// our order, but for the last two of ten, which Gmsh exchanges.
template <class Mesh>
struct CellType;
template <>
struct CellType<TetrahedralMesh> {
  static constexpr int gmsh = 4, vtk = 10, points = 4;
  static constexpr const char* count = "four";
};
template <>
struct CellType<QuadraticTetrahedralMesh> {
  static constexpr int gmsh = 11, vtk = 24, points = 10;
  static constexpr const char* count = "ten";
};
template <>
struct CellType<HexahedralMesh> {
  static constexpr int gmsh = 5, vtk = 12, points = 8;
  static constexpr const char* count = "eight";
};

/// The mesh without the points that no cell names: those of the surfaces and curves that such files hold too.
template <class Mesh>
Mesh without_loose_points(const Mesh& mesh) {
  std::vector<Index> place(mesh.points.size(), -1);
  for (const auto& t : mesh.cells())
    for (const Index i : t) place[i] = 0;
  Mesh kept{{}, mesh.cells()};
  for (std::size_t i = 0; i < place.size(); ++i)
    if (place[i] == 0) {
      place[i] = Index(kept.points.size());
      kept.points.push_back(mesh.points[i]);
    }
  for (auto& t : kept.cells())
    for (Index& i : t) i = place[i];
  return kept;
}

/// Reads the sections $Nodes and $Elements of versions 2.2 and 4.1; nodes and elements have tags, in any
/// order.
template <class Mesh>
class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& path) : in_(text, path) {}

  Mesh mesh() {
    bool has_nodes = false;
    while (!in_.is_at_end()) {
      const std::string section(in_.word("a section"));
      if (section == "$MeshFormat")
        format();
      else if (section == "$Nodes")
        nodes(), has_nodes = true;
      else if (section == "$Elements") {
        if (!has_nodes) in_.refuse_here("$Elements stand before $Nodes");
        elements();
      } else if (section.empty() || section[0] != '$') {
        in_.refuse_here("'" + section.substr(0, 40) + "' stands where a section, $Nodes say, should begin");
      }
      const std::string end = std::string("$End").append(section, 1);
      while (in_.word(end) != end) {
      }
    }
    if (mesh_.cells().empty())
      in_.refuse_here(std::string("the file holds no ") + Mesh::cell + " of " + CellType<Mesh>::count +
                      " nodes");
    return without_loose_points(mesh_);
  }

 private:
  static constexpr int most = std::numeric_limits<int>::max();

  void format() {
    const std::string version(in_.word("the version of the format"));
    if (version != "2.2" && version != "4.1")
      in_.refuse_here("version " + version +
                      " of Gmsh's format is neither 2.2 nor 4.1; save the mesh as one of them");
    is_in_blocks_ = version == "4.1";
    if (in_.integer("the kind of file", 0, 1) == 1)
      in_.refuse_here("the file is binary; save the mesh as ASCII");
  }

  void nodes() {
    const int blocks = is_in_blocks_ ? in_.integer("the number of blocks of nodes", 0, most) : 1;
    int count = in_.integer("the number of nodes", 0, most);
    if (is_in_blocks_) in_.word("the lowest tag"), in_.word("the highest tag");
    for (int b = 0; b < blocks; ++b) {
      int dimension = 0;
      bool is_parametric = false;
      if (is_in_blocks_) {
        dimension = in_.integer("the dimension of an entity", 0, 3);
        in_.word("the tag of an entity");
        is_parametric = in_.integer("whether nodes have parameters, 0 or 1,", 0, 1) == 1;
        count = in_.integer("the number of nodes of a block", 0, most);
      }
      const std::size_t first = mesh_.points.size();
      for (int i = 0; i < count; ++i) {
        tags_.emplace_back(in_.integer("the tag of a node", 0, most), Index(first) + i);
        if (!is_in_blocks_) mesh_.points.push_back(in_.vector("a coordinate"));
      }
      for (int i = 0; is_in_blocks_ && i < count; ++i) {
        mesh_.points.push_back(in_.vector("a coordinate"));
        for (int k = 0; is_parametric && k < dimension; ++k) in_.number("a parameter");
      }
    }
    std::sort(tags_.begin(), tags_.end());
    const auto twice = std::adjacent_find(tags_.begin(), tags_.end(),
                                          [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twice != tags_.end()) in_.refuse_here("two nodes have the tag " + std::to_string(twice->first));
  }

  Index node() {
    const int tag = in_.integer("the tag of a node", 0, most);
    const auto found = std::lower_bound(tags_.begin(), tags_.end(), std::pair<int, Index>(tag, 0));
    if (found == tags_.end() || found->first != tag)
      in_.refuse_here("there is no node with the tag " + std::to_string(tag));
    return found->second;
  }

  /// How many nodes an element of Gmsh's type 1, 2, … has.
  int nodes_of(int type) const {
    constexpr int count[] = {0, 2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13};
    if (type == 11 && CellType<Mesh>::points == 4)
      in_.refuse_here(
          "the tetrahedra have ten nodes; read them by read_quadratic_tetrahedral_mesh, or save the mesh "
          "with "
          "elements of order 1");
    if (CellType<Mesh>::points == 8 && (type == 12 || type == 17))
      in_.refuse_here("the hexahedra have more than eight nodes; save the mesh with elements of order 1");
    if (type < 1 || type >= int(std::size(count)))
      in_.refuse_here("elements of type " + std::to_string(type) + " are not known");
    return count[type];
  }

  void element(int type) {
    if (type != CellType<Mesh>::gmsh) {
      for (int k = nodes_of(type); k > 0; --k) in_.word("the tag of a node");
      return;
    }
    auto& t = mesh_.cells().emplace_back();
    for (Index& i : t) i = node();
    if (CellType<Mesh>::points == 10) std::swap(*(t.end() - 2), *(t.end() - 1));
  }

  void elements() {
    const int blocks = is_in_blocks_ ? in_.integer("the number of blocks of elements", 0, most) : 1;
    int count = in_.integer("the number of elements", 0, most), type = 0;
    if (is_in_blocks_) in_.word("the lowest tag"), in_.word("the highest tag");
    for (int b = 0; b < blocks; ++b) {
      if (is_in_blocks_) {
        in_.word("the dimension of an entity"), in_.word("the tag of an entity");
        type = in_.integer("the type of elements", 0, most);
        count = in_.integer("the number of elements of a block", 0, most);
      }
      for (int e = 0; e < count; ++e) {
        in_.word("the tag of an element");
        if (!is_in_blocks_) {
          type = in_.integer("the type of an element", 0, most);
          for (int k = in_.integer("the number of tags", 0, most); k > 0; --k) in_.word("a tag");
        }
        element(type);
      }
    }
  }

  TextReader in_;
  Mesh mesh_;
  std::vector<std::pair<int, Index>> tags_;  ///< of a node, and where its point is
  bool is_in_blocks_ = false;
};

/// The cells of one kind of an unstructured grid in VTK's legacy format.
template <class Mesh>
Mesh vtk_mesh(std::string_view text, const std::string& path) {
  // No list is longer than the text.
  const int most = int(std::min(text.size(), std::size_t(std::numeric_limits<int>::max())));
  if (!text.starts_with("# vtk DataFile Version"))
    refuse(path + ": a VTK file begins with '# vtk DataFile Version'");
  // The second line is a title of any words.
  const std::size_t first = text.find('\n'),
                    second = first < text.size() ? text.find('\n', first + 1) : first;
  TextReader in(second < text.size() ? text.substr(second) : std::string_view(),
                path + " (from its third line)");
  if (in.word("'ASCII'") != "ASCII") in.refuse_here("the file is binary; save the mesh as ASCII");
  Mesh mesh;
  std::vector<Index> start{0}, corners;
  std::vector<int> types;
  const auto point = [&] { return in.integer("the number of a point", 0, int(mesh.points.size()) - 1); };
  while (types.empty() && !in.is_at_end()) {
    const std::string_view word = in.word("a key word");
    if (word == "DATASET" && in.word("'UNSTRUCTURED_GRID'") != "UNSTRUCTURED_GRID")
      in.refuse_here("the data set is no UNSTRUCTURED_GRID");
    if (word == "POINTS") {
      if (!mesh.points.empty()) in.refuse_here("POINTS stand there a second time");
      mesh.points.resize(in.integer("the number of points", 0, most));
      in.word("the type of the coordinates");
      for (Vec3& p : mesh.points) p = in.vector("a coordinate");
    } else if (word == "CELLS") {
      if (start.size() != 1 || !corners.empty()) in.refuse_here("CELLS stand there a second time");
      const int count = in.integer("the number of cells", 0, most),
                size = in.integer("the size of the list", 0, most);
      std::string_view next = in.word("the first cell");
      if (next == "OFFSETS") {
        in.word("the type of the offsets");
        start.clear();
        for (int i = 0; i < count; ++i)
          start.push_back(in.integer("an offset", start.empty() ? 0 : start.back(), size));
        if (in.word("'CONNECTIVITY'") != "CONNECTIVITY")
          in.refuse_here("after the offsets stands CONNECTIVITY");
        in.word("the type of the numbers");
        for (int i = 0; i < size; ++i) corners.push_back(point());
      } else {
        for (int i = 0; i < count; ++i, next = {}) {
          int length = 0;
          if (i > 0)
            length = in.integer("the number of corners of a cell", 0, size);
          else if (std::from_chars(next.data(), next.data() + next.size(), length).ec != std::errc{} ||
                   length < 0)
            in.refuse_here("'" + std::string(next.substr(0, 40)) + "' is no number of corners of a cell");
          for (int k = 0; k < length; ++k) corners.push_back(point());
          start.push_back(Index(corners.size()));
        }
      }
    } else if (word == "CELL_TYPES") {
      types.resize(in.integer("the number of cells", 1, most));
      for (int& type : types) type = in.integer("the type of a cell", 0, most);
    }
  }
  if (types.size() + 1 != start.size() || start.back() > Index(corners.size()))
    in.refuse_here("CELLS and CELL_TYPES do not speak of the same cells");
  for (std::size_t c = 0; c < types.size(); ++c)
    if (types[c] == CellType<Mesh>::vtk) {
      if (start[c + 1] - start[c] != CellType<Mesh>::points)
        in.refuse_here("cell " + std::to_string(c) + " is a " + Mesh::cell + " without " +
                       CellType<Mesh>::count + " corners");
      auto& t = mesh.cells().emplace_back();
      std::copy_n(corners.begin() + start[c], CellType<Mesh>::points, t.begin());
    }
  if (mesh.cells().empty()) in.refuse_here(std::string("the file holds no ") + Mesh::cell);
  return without_loose_points(mesh);
}

template <class Mesh>
Mesh read_mesh(const std::string& path) {
  const std::string text = read_text(path);
  return text.starts_with("# vtk") ? vtk_mesh<Mesh>(text, path) : GmshReader<Mesh>(text, path).mesh();
}

}  // namespace inner

/// The tetrahedra of a Gmsh file (.msh, ASCII, version 2.2 or 4.1), other elements left out, and their
/// points.
inline TetrahedralMesh parse_gmsh(std::string_view text, const std::string& path) {
  return inner::GmshReader<TetrahedralMesh>(text, path).mesh();
}

/// The tetrahedra (cells of type 10) of an unstructured grid in VTK's legacy format, ASCII, with cells as
/// lists (up to version 4.2) or with offsets (5.1), and their points.
inline TetrahedralMesh parse_vtk(std::string_view text, const std::string& path) {
  return inner::vtk_mesh<TetrahedralMesh>(text, path);
}

/// A mesh from a file of either kind, told apart by how it begins. Throws InvalidArgument with file, line and
/// reason. What is flat or inside out is refused later, by who takes the mesh: `oriented(mesh)` turns round
/// what is inside out.
inline TetrahedralMesh read_tetrahedral_mesh(const std::string& path) {
  return inner::read_mesh<TetrahedralMesh>(path);
}

/// The tetrahedra of ten nodes of such a file (type 11 of Gmsh, 24 of VTK), other elements left out.
inline QuadraticTetrahedralMesh read_quadratic_tetrahedral_mesh(const std::string& path) {
  return inner::read_mesh<QuadraticTetrahedralMesh>(path);
}

/// The hexahedra of eight nodes of such a file (type 5 of Gmsh, 12 of VTK), other elements left out.
inline HexahedralMesh read_hexahedral_mesh(const std::string& path) {
  return inner::read_mesh<HexahedralMesh>(path);
}

}  // namespace delassus
