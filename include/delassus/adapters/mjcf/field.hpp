/// Height fields.
#pragma once

#include <delassus/adapters/mjcf/mesh.hpp>
#include <delassus/model/model.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace delassus::inner::mjcf {

/// Rows and columns as they stand in MuJoCo's own binary form: two 32-bit counts and floats, rows from −y up.
inline void read_field_file(const Element& e, const std::string& path, model::HeightField& to,
                            Budget& budget) {
  const std::string bytes = read_text(path);
  std::int32_t count[2] = {0, 0};
  if (bytes.size() >= 8) std::memcpy(count, bytes.data(), 8);
  const double points = double(count[0]) * count[1];
  if (count[0] < 2 || count[1] < 2 || double(bytes.size()) != 8 + 4 * points)
    e.refuse("the file '" + path +
             "' is no height field: two counts of at least 2 and as many floats; images are not read");
  budget.take_points(e, points);
  to.rows = count[0];
  to.columns = count[1];
  for (std::size_t at = 8; at < bytes.size(); at += 4) {
    float height;
    std::memcpy(&height, bytes.data() + at, 4);
    if (!std::isfinite(height)) e.refuse("the file '" + path + "' has a height that is not finite");
    to.heights.push_back(height);
  }
}

inline void read_inline_field(const Element& e, model::HeightField& to, Budget& budget) {
  int rows = 0, columns = 0;
  if (!e.read("nrow", rows) || !e.read("ncol", columns) || rows < 2 || columns < 2)
    e.refuse("a height field without a file needs nrow and ncol, each at least 2");
  budget.take_points(e, double(rows) * columns);
  to.rows = rows;
  to.columns = columns;
  const std::size_t count = std::size_t(rows) * std::size_t(columns);
  if (!e.has("elevation")) return to.heights.assign(count, 0);
  const std::vector<double> given = e.numbers("elevation");
  if (given.size() != count)
    e.refuse("elevation has " + std::to_string(given.size()) +
             " numbers and must have nrow * ncol = " + std::to_string(count));
  for (int row = rows - 1; row >= 0; --row)  // the text begins with the row that lies farthest along y
    to.heights.insert(to.heights.end(), given.begin() + std::ptrdiff_t(row) * columns,
                      given.begin() + std::ptrdiff_t(row + 1) * columns);
}

/// Heights run from 0 to the third number of `size`, whatever those of the file are.
inline Index load_field(const Element& e, const Document& document, const Compiler& c,
                        const std::string& name, Model& model, Budget& budget) {
  std::array<double, 4> size{};
  if (e.read("size", size, 4) != 4) e.refuse("a height field needs a size of four numbers");
  for (const double s : size)
    if (!(s > 0)) e.refuse("size of a height field has " + text(s) + "; all four must be above 0");
  model::HeightField field{.name = name, .half_x = size[0], .half_y = size[1], .base = size[3]};
  if (e.has("file")) {
    const std::string path = asset_path(e, document, c, c.mesh_folder);
    if (path.empty())
      e.refuse("the file '" + e.text("file") +
               "' of the height field is not found; name its folder in MjcfOptions::files");
    read_field_file(e, path, field, budget);
  } else {
    read_inline_field(e, field, budget);
  }
  const auto [low, high] = std::minmax_element(field.heights.begin(), field.heights.end());
  const double lowest = *low, range = *high - *low;
  for (double& h : field.heights) h = range > 1e-14 ? size[2] * ((h - lowest) / range) : 0;
  model.height_fields.push_back(std::move(field));
  return Index(model.height_fields.size()) - 1;
}

}  // namespace delassus::inner::mjcf
