/// Friction problems in the HDF5 form of FCLIB, the Frictional Contact Library. Needs the component hdf5.
#pragma once

#include <delassus/adapters/hdf5_file.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/problems/definiteness.hpp>
#include <delassus/problems/friction_problem.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace delassus {

// A local problem u = W r + q of FCLIB:
//
//   /fclib_local/spacedim           3
//   /fclib_local/W/{m, n, nzmax, nz, p, i, x}
//                                   W by scalars: nz ≥ 0: triplets, p columns and i rows; nz = −1: compressed
//                                   columns, p where each begins; nz = −2: compressed rows
//   /fclib_local/vectors/{q, mu}    3 n and n numbers, rows (n, t₁, t₂)
//   /fclib_local/info/…             texts
//   /guesses/number_of_guesses, /guesses/1/r, /solution/{u, r}
//
// Source: [AcaryEtAl2014].

namespace inner {

/// One number of W.
struct FclibEntry {
  Index row, column;
  double value;
};

/// Where each number of W stands, in any of the three forms.
inline std::vector<FclibEntry> fclib_entries(const Hdf5File& in, Index size) {
  const std::string W = "/fclib_local/W/";
  const int form = in.integer(W + "nz"), most = in.integer(W + "nzmax");
  in.expect(form >= -2 && most >= 0 && form <= most,
            "W/nz = " + std::to_string(form) + " is no form of a matrix: >= 0, -1 or -2");
  const std::vector<int> p = in.integers(W + "p"), i = in.integers(W + "i");
  const std::vector<double> x = in.numbers(W + "x");
  const std::size_t count = form >= 0   ? std::size_t(form)
                            : p.empty() ? 0
                                        : std::size_t(std::max(p.back(), 0));
  in.expect(x.size() >= count && i.size() >= count && p.size() >= (form >= 0 ? count : std::size_t(size) + 1),
            "the arrays of W are shorter than its " + std::to_string(count) + " entries");
  std::vector<FclibEntry> entries;
  const auto add = [&](Index row, Index column, double value) {
    in.expect(row >= 0 && row < size && column >= 0 && column < size && std::isfinite(value),
              "entry (" + std::to_string(row) + ", " + std::to_string(column) + ") of W is " + text(value) +
                  "; its indices must lie below " + std::to_string(size) + ", its value must be finite");
    entries.push_back({row, column, value});
  };
  if (form >= 0) {
    for (std::size_t e = 0; e < count; ++e) add(i[e], p[e], x[e]);
    return entries;
  }
  in.expect(p[0] == 0 && std::is_sorted(p.begin(), p.begin() + size + 1) && std::size_t(p[size]) == count,
            "W/p must grow from 0 to the number of entries");
  for (Index k = 0; k < size; ++k)
    for (int e = p[k]; e < p[k + 1]; ++e) form == -1 ? add(i[e], k, x[e]) : add(k, i[e], x[e]);
  return entries;
}

/// The blocks that have an entry; entries of one place add up.
inline std::vector<GivenBlock> fclib_blocks(std::vector<FclibEntry> entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const FclibEntry& a, const FclibEntry& b) {
    return a.row / 3 != b.row / 3 ? a.row / 3 < b.row / 3 : a.column / 3 < b.column / 3;
  });
  std::vector<GivenBlock> blocks;
  for (const FclibEntry& e : entries) {
    const Index i = e.row / 3, j = e.column / 3;
    if (blocks.empty() || blocks.back().row != i || blocks.back().column != j)
      blocks.push_back({i, j, Mat3::Zero()});
    blocks.back().block(e.row % 3, e.column % 3) += e.value;
  }
  return blocks;
}

inline std::vector<double> flat(std::span<const Vec3> x) {
  std::vector<double> numbers;
  for (const Vec3& v : x) numbers.insert(numbers.end(), v.data(), v.data() + 3);
  return numbers;
}

}  // namespace inner

/// The local problem of an FCLIB file; λ is its first guess, or zero where it has none. A global problem, one
/// of two dimensions and one with equality rows are refused: InvalidArgument names file and reason.
inline FrictionProblem read_fclib(const std::string& path) {
  const auto in = inner::Hdf5File::open(path);
  in.expect(!in.has("/fclib_global"), "it holds a global problem (M, H); only local ones (W, q) are read");
  in.expect(in.has("/fclib_local"), "it has no group fclib_local, where FCLIB keeps a local problem");
  const int dimensions = in.integer("/fclib_local/spacedim");
  in.expect(dimensions == 3, "its contacts have " + std::to_string(dimensions) + " rows; only 3 are read");
  in.expect(!in.has("/fclib_local/V") && !in.has("/fclib_local/R"),
            "it has equality rows (V, R), for which a friction problem has no place");
  const int size = in.integer("/fclib_local/W/n");
  in.expect(size >= 0 && size % 3 == 0 && in.integer("/fclib_local/W/m") == size,
            "W must be square, with three rows a contact, not " +
                std::to_string(in.integer("/fclib_local/W/m")) + " x " + std::to_string(size));
  const std::size_t n = std::size_t(size) / 3;
  const std::vector<double> friction = in.numbers("/fclib_local/vectors/mu", n);
  const std::vector<Vec3> q = in.vectors("/fclib_local/vectors/q", n);
  for (const double mu : friction) in.expect(mu >= 0, "friction " + inner::text(mu) + " must be >= 0");
  const std::vector<GivenBlock> blocks = inner::fclib_blocks(inner::fclib_entries(in, size));
  for (const GivenBlock& b : blocks) {
    in.expect(is_finite(b.block), "entries of W add up to what is not finite");
    in.expect(b.row != b.column || b.block.diagonal().minCoeff() > 0,
              "the diagonal of W must be > 0, also at contact " + std::to_string(b.row));
  }
  FrictionProblem p;
  try {
    p = make_friction_problem(friction, q, blocks);
  } catch (const InvalidArgument& error) {
    const std::string sentence = error.what();
    in.expect(false, sentence.substr(sentence.rfind(": ") + 2));
  }
  const Index indefinite = first_indefinite_contact(p);
  in.expect(indefinite < 0, "W of contacts 0 to " + std::to_string(indefinite) + " is indefinite: some impulses do negative work, λᵀ W λ < 0");
  if (in.has("/guesses") && in.has("/guesses/1")) p.rows.pool<0>().lambda = in.vectors("/guesses/1/r", n);
  return p;
}

/// The solution's impulses, N·s.
inline std::vector<Vec3> read_fclib_solution(const std::string& path, Index contacts) {
  return inner::Hdf5File::open(path).vectors("/solution/r", std::size_t(contacts));
}

/// The problem in a new file, by columns of W, all nine entries of each block; its λ becomes the one guess
/// where it is not zero. `description` goes to its info.
inline void write_fclib(const std::string& path, const FrictionProblem& p,
                        const std::string& description = "") {
  const auto& pool = p.rows.pool<0>();
  const auto W = p.W.blocks<0, 0>();
  const Index n = pool.items();
  std::vector<inner::FclibEntry> entries;
  const auto add = [&](Index i, Index j, const Mat3& block) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) entries.push_back({3 * i + r, 3 * j + c, block(r, c)});
  };
  std::vector<double> mu;
  for (Index i = 0; i < n; ++i) {
    mu.push_back(p.laws.pool<0>().item(i).parameters.friction);
    add(i, i, p.W.diagonal<0>(i));
    for (Index e = W.start[i]; e < W.start[i + 1]; ++e) add(i, W.column[e], W.block[e]);
  }
  std::sort(entries.begin(), entries.end(), [](const inner::FclibEntry& a, const inner::FclibEntry& b) {
    return a.column != b.column ? a.column < b.column : a.row < b.row;
  });
  DELASSUS_EXPECT(
      entries.size() <= std::size_t(std::numeric_limits<int>::max()),
      "write_fclib: " + std::to_string(entries.size()) + " entries of W are more than FCLIB counts");
  std::vector<int> start(std::size_t(3 * n) + 1, 0), row;
  std::vector<double> value;
  for (const auto& e : entries) {
    ++start[std::size_t(e.column) + 1];
    row.push_back(e.row);
    value.push_back(e.value);
  }
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];

  auto out = inner::Hdf5File::create(path);
  for (const char* group : {"/fclib_local", "/fclib_local/W", "/fclib_local/vectors", "/fclib_local/info"})
    out.group(group);
  out.write("/fclib_local/spacedim", 3);
  out.write("/fclib_local/W/m", int(3 * n));
  out.write("/fclib_local/W/n", int(3 * n));
  out.write("/fclib_local/W/nzmax", int(value.size()));
  out.write("/fclib_local/W/nz", -1);
  out.write("/fclib_local/W/p", start);
  out.write("/fclib_local/W/i", row);
  out.write("/fclib_local/W/x", value);
  out.write("/fclib_local/vectors/q", inner::flat(pool.d));
  out.write("/fclib_local/vectors/mu", mu);
  out.write_text("/fclib_local/info/title", "written by delassus");
  out.write_text("/fclib_local/info/description", description);
  if (std::all_of(pool.lambda.begin(), pool.lambda.end(), [](const Vec3& x) { return is_zero(x); })) return;
  out.group("/guesses");
  out.group("/guesses/1");
  out.write("/guesses/number_of_guesses", 1);
  out.write("/guesses/1/r", inner::flat(pool.lambda));
  out.write("/guesses/1/u", std::vector<double>(std::size_t(3 * n), 0.0));
}

/// p's λ, and the velocities d + W λ, as the solution in a file that has the problem and no solution yet.
inline void write_fclib_solution(const std::string& path, const FrictionProblem& p) {
  auto out = inner::Hdf5File::open(path, true);
  out.expect(!out.has("/solution"), "it has a solution already, which is not written over");
  const int size = out.integer("/fclib_local/W/n"), own = 3 * int(p.rows.pool<0>().items());
  out.expect(size == own,
             "its W has " + std::to_string(size) + " rows, the solution has " + std::to_string(own));
  std::vector<Vec3> u;
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i) u.push_back(p.W.residual<0>(p.rows, i));
  out.group("/solution");
  out.write("/solution/u", inner::flat(u));
  out.write("/solution/r", inner::flat(p.rows.pool<0>().lambda));
}

}  // namespace delassus
