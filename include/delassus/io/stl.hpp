/// Triangles from STL files, text and binary.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/geometry/triangle_list.hpp>
#include <delassus/io/inner/text_reader.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace delassus {
namespace inner {

/// A word in small letters.
inline std::string lower_case(std::string_view word) {
  std::string low(word);
  for (char& c : low)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return low;
}

/// Corners, three a triangle, of a text: solid … facet normal x y z outer loop vertex x y z … endloop
/// endfacet … endsolid.
class StlText {
 public:
  StlText(std::string_view text, const std::string& name) : in_(text, name) {
    while (!in_.is_at_end()) {
      keyword("solid");
      in_.pass_line();  // its name
      while (next("facet' or 'endsolid") == "facet") read_facet();
      if (word_ != "endsolid")
        in_.refuse_here("'" + word_.substr(0, 40) + "' stands where 'facet' or 'endsolid' should");
      in_.pass_line();
    }
  }

  std::vector<Vec3> corners;

 private:
  const std::string& next(const char* wanted) {
    return word_ = lower_case(in_.word(std::string("'") + wanted + "'"));
  }
  void keyword(const char* wanted) {
    if (next(wanted) != wanted)
      in_.refuse_here("'" + word_.substr(0, 40) + "' stands where '" + wanted + "' should");
  }
  void read_facet() {
    keyword("normal");
    for (int k = 0; k < 3; ++k)
      in_.word("a number of a normal");  // the corners say the same; some programs write nan
    keyword("outer");
    keyword("loop");
    for (int corner = 0; corner < 3; ++corner) {
      keyword("vertex");
      corners.push_back(in_.vector("a coordinate of a vertex"));
    }
    keyword("endloop");
    keyword("endfacet");
  }

  TextReader in_;
  std::string word_;
};

/// Little-endian numbers of a binary file: 80 bytes of anything, the count, and 50 bytes a triangle.
class StlBytes {
 public:
  static constexpr std::size_t head = 84, facet = 50;

  explicit StlBytes(std::string_view bytes) : bytes_(bytes) {}

  std::size_t count() const { return integer(80); }
  bool is_whole() const { return bytes_.size() >= head && bytes_.size() == head + facet * count(); }

  std::vector<Vec3> corners(const std::string& name) const {
    DELASSUS_EXPECT(
        bytes_.size() >= head,
        name + ": byte " + std::to_string(bytes_.size()) +
            ": the file ends within the 84 bytes that begin a binary STL; it is neither that nor a text");
    DELASSUS_EXPECT(is_whole(), name + ": byte 80: " + std::to_string(count()) + " triangles take " +
                                    std::to_string(head + facet * count()) + " bytes, but the file has " +
                                    std::to_string(bytes_.size()));
    std::vector<Vec3> list;
    list.reserve(3 * count());
    for (std::size_t at = head; at < bytes_.size(); at += facet)
      for (std::size_t corner = at + 12; corner < at + 48; corner += 12) list.push_back(vertex(corner, name));
    return list;
  }

 private:
  std::uint32_t integer(std::size_t at) const {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value << 8 | std::uint8_t(bytes_[at + k]);
    return value;
  }
  Vec3 vertex(std::size_t at, const std::string& name) const {
    Vec3 v;
    for (int k = 0; k < 3; ++k) {
      const std::size_t here = at + 4 * std::size_t(k);
      v[k] = std::bit_cast<float>(integer(here));
      DELASSUS_EXPECT(std::isfinite(v[k]),
                      name + ": byte " + std::to_string(here) + ": a coordinate of a vertex is not finite");
    }
    return v;
  }

  std::string_view bytes_;
};

/// Equal corners become one vertex, in the order in which they come; triangles of fewer than three are left
/// out.
inline TriangleList joined_corners(const std::vector<Vec3>& corners) {
  std::vector<Index> order(corners.size()), vertex_of(corners.size());
  std::iota(order.begin(), order.end(), 0);
  const auto is_before = [&](Index a, Index b) {
    const Vec3 &x = corners[std::size_t(a)], &y = corners[std::size_t(b)];
    for (int k = 0; k < 3; ++k)
      if (x[k] != y[k]) return x[k] < y[k];
    return a < b;
  };
  std::sort(order.begin(), order.end(), is_before);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_again = i > 0 && corners[std::size_t(order[i])] == corners[std::size_t(order[i - 1])];
    vertex_of[std::size_t(order[i])] =
        is_again ? vertex_of[std::size_t(order[i - 1])] : order[i];  // the first corner there
  }
  TriangleList list;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (vertex_of[c] == Index(c)) {
      vertex_of[c] = Index(list.vertices.size());
      list.vertices.push_back(corners[c]);
    } else {
      vertex_of[c] = vertex_of[std::size_t(vertex_of[c])];
    }
  }
  for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
    const std::array<Index, 3> t{vertex_of[c], vertex_of[c + 1], vertex_of[c + 2]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) list.triangles.push_back(t);
  }
  return list;
}

}  // namespace inner

/// The triangles of an STL file's bytes. It is binary where its length fits its count, also when it begins
/// with "solid". Corners of equal coordinates become one vertex, and triangles that two corners share are
/// left out; normals are not read. STL says no unit: numbers are taken for m. `name` stands in what is
/// thrown, with the line or the byte.
inline TriangleList parse_stl(std::string_view bytes, const std::string& name) {
  const inner::StlBytes binary(bytes);
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  const bool is_text = start != bytes.npos && inner::lower_case(bytes.substr(start, 5)) == "solid" &&
                       bytes.substr(0, inner::StlBytes::head).find('\0') == bytes.npos;
  const TriangleList list = inner::joined_corners(
      is_text && !binary.is_whole() ? inner::StlText(bytes, name).corners : binary.corners(name));
  DELASSUS_EXPECT(!list.triangles.empty(), name + ": there is no triangle");
  return list;
}

/// The triangles of a file.
inline TriangleList read_stl(const std::string& path) { return parse_stl(inner::read_text(path), path); }

}  // namespace delassus
