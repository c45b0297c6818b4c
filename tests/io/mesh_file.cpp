#include <delassus/io/mesh_file.hpp>

#include <delassus/geometry/box_mesh.hpp>

#include <cstdio>
#include <fstream>
#include <string>

#include "catch.hpp"

using namespace delassus;

namespace {

// Two tetrahedra with the corners of a cube and, between them, a node of a curve, an edge and a triangle;
// tags with gaps.
const std::string version_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
3 7 "a $Nodes name"
$EndPhysicalNames
$Nodes
6
10 0 0 0
2 1 0 0
30 0 1 0
4 0 0 1
99 5 5 5
5 1 1 1.5
$EndNodes
$Elements
5
1 15 2 0 1 99
2 1 2 0 1 10 99
3 2 2 0 1 10 2 30
4 4 2 7 1 10 2 30 4
5 4 2 7 1 2 30 4 5
$EndElements
)";

const std::string version_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
1 0 0 1
99 5 5 5 0
1 0 0 0 1 1 1.5 0 0
$EndEntities
$Nodes
2 6 2 99
1 1 1 1
99
5 5 5 0.25
3 1 0 5
10
2
30
4
5
0 0 0
1 0 0
0 1 0
0 0 1
1 1 1.5
$EndNodes
$Elements
2 3 1 3
2 1 2 1
3 10 2 30
3 1 4 2
4 10 2 30 4
5 2 30 4 5
$EndElements
)";

const std::string vtk_lists = R"(# vtk DataFile Version 3.0
a title of many words, ASCII or not
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 double
0 0 0  1 0 0  0 1 0
0 0 1  5 5 5  1 1 1.5
METADATA
INFORMATION 0

CELLS 3 14
3 0 1 2
4 0 1 2 3
4 1 2 3 5
CELL_TYPES 3
5 10 10
POINT_DATA 6
SCALARS x double 1
)";

const std::string vtk_offsets = R"(# vtk DataFile Version 5.1
title
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 float
0 0 0  1 0 0  0 1 0
0 0 1  5 5 5  1 1 1.5
CELLS 4 11
OFFSETS vtktypeint64
0 3 7 11
CONNECTIVITY vtktypeint64
0 1 2 0 1 2 3 1 2 3 5
CELL_TYPES 3
5 10 10
)";

void check_is_the_pair(const TetrahedralMesh& mesh) {
  REQUIRE(mesh.points.size() == 5);
  REQUIRE(mesh.tetrahedra.size() == 2);
  CHECK(mesh.points[4] == Vec3(1, 1, 1.5));
  CHECK(mesh.tetrahedra[0] == std::array<Index, 4>{0, 1, 2, 3});
  CHECK(mesh.tetrahedra[1] == std::array<Index, 4>{1, 2, 3, 4});
  CHECK(std::abs(volume(mesh, 0) - 1.0 / 6) < 1e-15);
  CHECK(std::abs(volume(mesh, 1) - 2.5 / 6) < 1e-15);  // its face's plane is x + y + z = 1
  check_mesh(mesh, "mesh");
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

std::string refusal(const std::string& text) {
  try {
    text.starts_with("# vtk") ? parse_vtk(text, "m") : parse_gmsh(text, "m");
  } catch (const InvalidArgument& e) {
    return e.what();
  }
  return {};
}

bool refuses(const std::string& text, const std::string& because) {
  return refusal(text).find(because) != std::string::npos;
}

}  // namespace

TEST_CASE(
    "tetrahedra are read from Gmsh's versions 2.2 and 4.1 and from VTK's lists and offsets, the rest is left "
    "out") {
  check_is_the_pair(parse_gmsh(version_2, "m"));
  check_is_the_pair(parse_gmsh(version_4, "m"));
  check_is_the_pair(parse_vtk(vtk_lists, "m"));
  check_is_the_pair(parse_vtk(vtk_offsets, "m"));
}

TEST_CASE("a mesh file is told apart by how it begins") {
  const std::string path = "mesh_file_test.msh";
  for (const std::string& text : {version_4, vtk_lists}) {
    std::ofstream(path) << text;
    check_is_the_pair(read_tetrahedral_mesh(path));
  }
  std::remove(path.c_str());
  CHECK_THROWS_AS(read_tetrahedral_mesh(path), InvalidArgument);
}

TEST_CASE("a mesh file that cannot be used is refused with its line and the reason") {
  CHECK(refuses(replaced(version_2, "2.2 0 8", "2.2 1 8"), "binary"));
  CHECK(refuses(replaced(version_2, "2.2 0 8", "4.0 0 8"), "neither 2.2 nor 4.1"));
  CHECK(refuses(replaced(version_2, "10 2 30 4\n", "10 2 31 4\n"),
                "m, line 22: there is no node with the tag 31"));
  CHECK(refuses(replaced(version_2, "0 0 1\n", "0 nan 1\n"), "line 13"));
  CHECK(refuses(replaced(version_2, "4 4 2 7 1 10 2 30 4", "4 11 2 7 1 10 2 30 4"), "ten nodes"));
  CHECK(refuses(replaced(version_4, "3 1 4 2", "3 1 77 2"), "type 77"));
  CHECK(refuses(version_4.substr(0, 200), "the file ends where"));
  CHECK(refuses("hello", "'hello' stands where a section"));
  CHECK(refuses(version_2.substr(0, version_2.find("$Elements")), "no tetrahedron"));
  CHECK(refuses(version_4.substr(version_4.find("$Elements")), "before $Nodes"));
  CHECK(refuses(replaced(vtk_lists, "ASCII\nDATASET", "BINARY\nDATASET"), "binary"));
  CHECK(refuses(replaced(vtk_lists, "UNSTRUCTURED_GRID", "POLYDATA"), "UNSTRUCTURED_GRID"));
  CHECK(refuses(replaced(vtk_lists, "4 1 2 3 5", "4 1 2 3 6"), "the number of a point"));
  CHECK(refuses(replaced(vtk_lists, "CELL_TYPES 3\n5 10 10", "CELL_TYPES 2\n10 10"),
                "do not speak of the same cells"));
  CHECK(refuses(replaced(vtk_lists, "CELLS 3 14\n3 0 1 2", "CELLS 3 14\nx 0 1 2"), "corners of a cell"));
  CHECK(refuses(replaced(vtk_offsets, "0 3 7 11", "0 3 7 12"), "an offset"));
  CHECK(refuses("# vtk DataFile Version 3.0", "'ASCII'"));
  // A second list of fewer points would leave cells that name points which are no more.
  CHECK(refuses(replaced(vtk_lists, "CELL_TYPES", "POINTS 1 double\n0 0 0\nCELL_TYPES"), "second time"));
  CHECK(refuses(replaced(vtk_lists, "CELL_TYPES", "CELLS 1 2\n1 0\nCELL_TYPES"), "second time"));
  CHECK(refuses(replaced(version_2, "$EndNodes", "$EndNodes\n$Nodes\n1\n30 0 0 0\n$EndNodes"),
                "two nodes have the tag 30"));
}

TEST_CASE("tetrahedra with nodes on their edges are read from both kinds of files, each with its order") {
  const std::string path = "mesh_file_ten_nodes.msh";
  const QuadraticTetrahedralMesh one =
      quadratic({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}, {{0, 1, 2, 3}}});
  std::string nodes, points;
  for (std::size_t k = 0; k < 10; ++k) {
    const Vec3& p = one.points[std::size_t(one.tetrahedra[0][k])];
    const std::string place =
        std::to_string(int(p[0])) + " " + std::to_string(int(p[1])) + " " + std::to_string(int(p[2])) + "\n";
    nodes += std::to_string(k + 1) + " " + place;
    points += place;
  }
  const std::string
      // Gmsh's ninth node is on the edge (2, 3), its tenth on (1, 3); VTK's the other way round.
      gmsh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n" + nodes +
             "$EndNodes\n$Elements\n1\n1 11 0 1 2 3 4 5 6 7 8 10 9\n$EndElements\n",
      vtk = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 double\n" +
            points + "CELLS 1 11\n10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n24\n";
  for (const std::string& text : {gmsh, vtk}) {
    std::ofstream(path) << text;
    const QuadraticTetrahedralMesh mesh = read_quadratic_tetrahedral_mesh(path);
    check_mesh(mesh, "mesh");
    REQUIRE(mesh.tetrahedra.size() == 1);
    for (std::size_t k = 0; k < 10; ++k)
      CHECK(mesh.points[std::size_t(mesh.tetrahedra[0][k])] == one.points[std::size_t(one.tetrahedra[0][k])]);
    CHECK_THROWS_WITH(read_tetrahedral_mesh(path),
                      Catch::Contains("ten nodes") || Catch::Contains("no tetra"));
  }
  std::remove(path.c_str());
}

TEST_CASE("hexahedra are read from both kinds of files, the tetrahedra beside them are left out") {
  const std::string path = "mesh_file_hexahedra.msh",
                    points = "0 0 0  1 0 0  1 1 0  0 1 0  0 0 2  1 0 2  1 1 2  0 1 2  5 5 5\n";
  std::string nodes;
  const HexahedralMesh box = hexahedral_box({1, 1, 2}, {1, 1, 1});
  const int around[8] = {0, 1, 3, 2, 4, 5, 7, 6};
  for (int k = 0; k < 8; ++k) {
    const Vec3& p = box.points[around[k]];
    for (const double x : {10.0 + k, p[0], p[1], p[2]}) nodes += std::to_string(int(x)) + " ";
    nodes += "\n";
  }
  const std::string
      gmsh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n" + nodes +
             "$EndNodes\n$Elements\n2\n1 4 0 10 11 12 14\n"
             "2 5 2 1 1 10 11 12 13 14 15 16 17\n$EndElements\n",
      vtk = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n" +
            points + "CELLS 2 14\n4 0 1 2 8\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 2\n10 12\n";
  for (const std::string& text : {gmsh, vtk}) {
    std::ofstream(path) << text;
    const HexahedralMesh mesh = read_hexahedral_mesh(path);
    check_mesh(mesh, "mesh");
    CHECK(mesh.points.size() == 8);
    REQUIRE(mesh.hexahedra.size() == 1);
    CHECK(std::abs(volume(mesh, 0) - 2) < 1e-14);
    CHECK(mesh.points[mesh.hexahedra[0][6]] == Vec3(1, 1, 2));
  }
  std::ofstream(path) << replaced(gmsh, "2 5 2 1 1", "2 17 2 1 1");
  CHECK_THROWS_WITH(read_hexahedral_mesh(path), Catch::Contains("more than eight nodes"));
  std::ofstream(path) << replaced(vtk, "10 12", "10 10");
  CHECK_THROWS_WITH(read_hexahedral_mesh(path),
                    Catch::Contains("is a tetrahedron") || Catch::Contains("no hexahedron"));
  std::ofstream(path) << replaced(vtk, "4 0 1 2 8\n8 0 1 2 3 4 5 6 7", "8 0 1 2 3 4 5 6 7\n4 0 1 2 8");
  CHECK_THROWS_WITH(read_hexahedral_mesh(path),
                    Catch::Contains("cell 1 is a hexahedron without eight corners"));
  std::remove(path.c_str());
}
