#include "catch.hpp"

#include <delassus/geometry/triangle_mesh.hpp>
#include <delassus/io/stl.hpp>

#include <cstring>
#include <limits>

namespace stl_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

using Facets = std::vector<std::array<Vec3, 3>>;

const Facets tetrahedron_facets = {{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0)},
                                   {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)},
                                   {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0)},
                                   {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}};

std::string stl_text(const Facets& facets, const std::string& name = " four faces") {
  std::string text = "solid" + name + "\n";
  for (const auto& facet : facets) {
    text += "  facet normal nan 0 0\n    outer loop\n";
    for (const Vec3& v : facet)
      text += "      vertex " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " +
              std::to_string(v[2]) + "\r\n";
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid" + name + "\n";
}

std::string stl_bytes(const Facets& facets, std::uint32_t count, const std::string& head = "made by a test") {
  std::string bytes = head;
  bytes.resize(80, ' ');
  const auto put = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  put(count);
  for (const auto& facet : facets) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const Vec3& v : facet)
      for (const double x : v) put(float(x));
    put(std::uint16_t(7));
  }
  return bytes;
}

}  // namespace

TEST_CASE("an STL text and the same in bytes become the same closed surface of merged vertices") {
  for (const std::string& file :
       {stl_text(tetrahedron_facets), stl_bytes(tetrahedron_facets, 4),
        stl_bytes(tetrahedron_facets, 4, "solid by a program that should not say so"),
        stl_text(tetrahedron_facets, "")}) {
    const TriangleList list = parse_stl(file, "four.stl");
    CHECK(list.vertices == std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}});
    CHECK(list.triangles == std::vector<std::array<Index, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}});
    CHECK(TriangleMesh(list.vertices, list.triangles).is_closed());
  }
}

TEST_CASE("an STL text may hold several solids, capital letters, minus zeros and needles that are left out") {
  Facets two = {tetrahedron_facets[0], {Vec3(0, 0, 0), Vec3(0, -0.0, 0), Vec3(5, 0, 0)}};
  std::string text = stl_text(two, " facet of a name");
  for (char& c : text) c = char(std::toupper(c));
  const TriangleList list = parse_stl("\n" + text + stl_text({tetrahedron_facets[3]}), "two.stl");
  CHECK(list.triangles.size() == 2);
  CHECK(list.vertices.size() == 5);
}

TEST_CASE("a damaged STL file is refused with its line or its byte") {
  const auto refusal = [](const std::string& bytes, const std::string& sentence) {
    CHECK_THROWS_WITH(parse_stl(bytes, "a.stl"), Contains("a.stl") && Contains(sentence));
  };
  const std::string text = stl_text(tetrahedron_facets), bytes = stl_bytes(tetrahedron_facets, 4);
  refusal("", "byte 0: the file ends within the 84 bytes");
  refusal("solid nothing\nendsolid\n", "there is no triangle");
  refusal("a mesh", "byte 6: the file ends");
  refusal(text.substr(0, 150), "the file ends where");
  refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", "line 4: 'nan' is no finite number");
  refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1e999\n",
          "line 4: '1e999' is no finite number");
  refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n",
          "line 5: 'endloop' stands where 'vertex' should");
  refusal("solid x\nfaces\n", "line 2: 'faces' stands where 'facet' or 'endsolid' should");
  refusal(stl_bytes(tetrahedron_facets, 5), "byte 80: 5 triangles take 334 bytes, but the file has 284");
  refusal(stl_bytes(tetrahedron_facets, 4000000000u), "byte 80: 4000000000 triangles");
  refusal(stl_bytes({}, 0), "there is no triangle");
  refusal(bytes.substr(0, 200), "byte 80: 4 triangles take 284 bytes, but the file has 200");
  Facets broken = tetrahedron_facets;
  broken[1][2][1] = std::numeric_limits<double>::quiet_NaN();
  refusal(stl_bytes(broken, 4), "byte 174: a coordinate of a vertex is not finite");
  CHECK_THROWS_WITH(read_stl("/nowhere/a.stl"), Contains("cannot open '/nowhere/a.stl'"));
}

TEST_CASE("each beginning of an STL file is refused or is a surface") {
  for (const std::string& whole : {stl_text(tetrahedron_facets), stl_bytes(tetrahedron_facets, 4)})
    for (std::size_t length = 0; length < whole.size(); ++length) {
      try {
        const TriangleList list = parse_stl(whole.substr(0, length), "part.stl");
        REQUIRE(list.triangles.size() == 4);  // only the end of the last line is missing
        REQUIRE(length + 20 > whole.size());
      } catch (const InvalidArgument& refused) {
        REQUIRE_THAT(refused.what(), Contains("part.stl"));
      }
    }
}

}  // namespace stl_tests
