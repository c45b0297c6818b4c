#include "catch.hpp"

#include <delassus/io/obj.hpp>

using namespace delassus;
using Catch::Matchers::Contains;

TEST_CASE("an OBJ text becomes a mesh: fans, slashes, indices from behind, and lines that say nothing") {
  const char* pyramid =
      "# a pyramid\r\nmtllib x.mtl\nv -1 -1 0\r\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nv 0 0 1.5e0\n"
      "f 4//1 3//1 2//1 1//1\nf 1/1 2/2 5/3\nf 2 3 -1 # the side\n\nf 3 4 5\nf -2 -5 -1";
  const TriangleMesh mesh = parse_obj(pyramid, "pyramid.obj");
  CHECK(mesh.triangle_count() == 6);
  CHECK(mesh.vertices().size() == 5);
  CHECK(mesh.triangles()[0] == std::array<Index, 3>{3, 2, 1});
  CHECK(mesh.triangles()[1] == std::array<Index, 3>{3, 1, 0});
  CHECK(mesh.triangles()[5] == std::array<Index, 3>{3, 0, 4});
  CHECK(mesh.triangle(0).normal == Vec3(0, 0, -1));
  CHECK(mesh.bounds().high == Vec3(1, 1, 1.5));
}

TEST_CASE("an OBJ text that cannot be a mesh is refused with its line") {
  CHECK_THROWS_WITH(parse_obj("v 1 2\n", "a.obj"),
                    Contains("a.obj:1: coordinate '' of a vertex is no finite number"));
  CHECK_THROWS_WITH(parse_obj("v 1 2 x\n", "a.obj"), Contains("coordinate 'x'"));
  CHECK_THROWS_WITH(parse_obj("v 1 nan 3\n", "a.obj"), Contains("a.obj:1: coordinate 'nan'"));
  CHECK_THROWS_WITH(parse_obj("v 0 0 0\nf 1 2 3\n", "a.obj"),
                    Contains("a.obj:2: vertex 2 is not among the 1 above"));
  CHECK_THROWS_WITH(parse_obj("v 0 0 0\nf 0 1 1\n", "a.obj"), Contains("vertex 0"));
  CHECK_THROWS_WITH(parse_obj("v 0 0 0\nf 1 1\n", "a.obj"), Contains("a face of 2 corners"));
  CHECK_THROWS_WITH(parse_obj("v 0 0 0\nf a b c\n", "a.obj"), Contains("corner 'a' of a face is no index"));
  CHECK_THROWS_WITH(parse_obj("", "a.obj"), Contains("a.obj: there is no face"));
  CHECK_THROWS_WITH(read_obj("/nowhere/a.obj"), Contains("cannot open '/nowhere/a.obj'"));
}

TEST_CASE("the vertices and faces of an OBJ text are read apart from a surface") {
  const TriangleList two = parse_obj_list("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n", "twice.obj");
  CHECK(two.vertices.size() == 3);
  CHECK(two.triangles.size() == 2);
  CHECK(parse_obj_list("v 0 0 0\n", "a.obj").triangles.empty());
}
