/// Friction problems and their warm starts as plain text, read and written to the last bit.
#pragma once

#include <delassus/io/inner/text.hpp>
#include <delassus/io/inner/text_reader.hpp>
#include <delassus/problems/definiteness.hpp>
#include <delassus/problems/friction_problem.hpp>

#include <algorithm>
#include <charconv>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace delassus {

// A problem file, numbers parted by white space:
//
//   fcp 1 sym|gen            sym: only blocks with j ≤ i stand here, the others are their transposes
//   NC NB                    contacts, blocks that follow
//   μ_1 … μ_NC
//   q_n q_t1 q_t2            NC lines, m/s
//   i j w00 w01 … w22        NB lines, from 0, 3 × 3 row by row, 1/kg; every diagonal block is there, none
//                          twice, and no impulse does negative work, λᵀ W λ ≥ 0
//
// A file of impulses (the guess of a warm start, or a solution): 3 NC numbers, N·s.

namespace inner {

/// Where a block of a file stands.
struct PlaceOfBlock {
  Index row, column;
  int line;
};

/// Refuses the later of two blocks that have one place. Leaves the places sorted.
inline void refuse_repeats(std::vector<PlaceOfBlock>& places, const TextReader& in) {
  std::sort(places.begin(), places.end(), [](const PlaceOfBlock& a, const PlaceOfBlock& b) {
    return a.row != b.row ? a.row < b.row : a.column != b.column ? a.column < b.column : a.line < b.line;
  });
  const PlaceOfBlock* twice = nullptr;
  int first = 0;
  for (std::size_t k = 1; k < places.size(); ++k)
    if (places[k].row == places[k - 1].row && places[k].column == places[k - 1].column && (!twice || places[k].line < twice->line))
      twice = &places[k], first = places[k - 1].line;
  if (twice)
    in.refuse_at(twice->line, "block (" + std::to_string(twice->row) + ", " + std::to_string(twice->column) +
                                  ") is given twice, first on line " + std::to_string(first) + "; take one of them out");
}

/// W_ii as it stands in a file: a diagonal > 0, and symmetric to rounding where W is.
inline void expect_own_block(const GivenBlock& own, bool is_symmetric, const TextReader& in) {
  const std::string of = " of contact " + std::to_string(own.row) + " is ";
  for (int k = 0; k < 3; ++k)
    if (!(own.block(k, k) > 0))
      in.refuse_here("W_" + std::to_string(k) + std::to_string(k) + of + text(own.block(k, k)) + " and must be > 0");
  if (!is_symmetric) return;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j)
      if (std::abs(own.block(i, j) - own.block(j, i)) > 1e-5 * std::max(own.block(i, i), own.block(j, j)))
        in.refuse_here("W_" + std::to_string(i) + std::to_string(j) + of + text(own.block(i, j)) + " and W_" + std::to_string(j) +
                       std::to_string(i) + " is " + text(own.block(j, i)) + ", but a file of the form 'sym' is symmetric; write 'gen' if W is not");
}

}  // namespace inner

/// The problem that `text` holds; `path` is what a refusal calls it. λ is zero.
inline FrictionProblem parse_problem(std::string_view text, const std::string& path) {
  inner::TextReader in(text, path);
  constexpr int most = std::numeric_limits<Index>::max() / 3;
  if (in.word("'fcp'") != "fcp") in.refuse_here("a problem file begins with 'fcp 1'");
  in.integer("the version of the format, 1,", 1, 1);
  const std::string_view form = in.word("'sym' or 'gen'");
  if (form != "sym" && form != "gen")
    in.refuse_here("after 'fcp 1' stands 'sym' or 'gen', not '" + std::string(form) + "'");
  const bool is_symmetric = form == "sym";
  const Index n = in.integer("the number of contacts", 0, most),
              count = in.integer("the number of blocks", 0, most);
  std::vector<double> friction;
  std::vector<Vec3> q;
  for (Index i = 0; i < n; ++i) {
    friction.push_back(in.number("a friction coefficient"));
    if (friction.back() < 0) in.refuse_here("friction " + inner::text(friction.back()) + " must be >= 0");
  }
  for (Index i = 0; i < n; ++i) q.push_back(in.vector("a velocity"));
  std::vector<GivenBlock> blocks;
  std::vector<inner::PlaceOfBlock> places;
  for (Index b = 0; b < count; ++b) {
    GivenBlock given;
    given.row = in.integer("the row of a block", 0, n - 1);
    given.column = in.integer("the column of a block", 0, is_symmetric ? given.row : n - 1);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) given.block(i, j) = in.number("an entry of a block");
    if (given.row == given.column) inner::expect_own_block(given, is_symmetric, in);
    places.push_back({given.row, given.column, in.line()});
    blocks.push_back(given);
    if (is_symmetric && given.row != given.column)
      blocks.push_back({given.column, given.row, Mat3(given.block.transpose())});
  }
  if (!in.is_at_end()) in.refuse_here("the file goes on after its last block");
  inner::refuse_repeats(places, in);
  FrictionProblem p;
  try {
    p = make_friction_problem(friction, q, blocks);
  } catch (const InvalidArgument& error) {
    const std::string sentence = error.what();
    in.refuse_here(sentence.substr(sentence.rfind(": ") + 2));
  }
  if (const Index k = first_indefinite_contact(p); k >= 0)
    for (const inner::PlaceOfBlock& place : places)
      if (place.row == k && place.column == k)
        in.refuse_at(place.line, "W of contacts 0 to " + std::to_string(k) + " is indefinite: some impulses do negative work, λᵀ W λ < 0, " +
                                     "as those of bodies never do; are rows and columns of the blocks as the form says?");
  return p;
}

/// The 3 · `contacts` impulses that `text` holds.
inline std::vector<Vec3> parse_impulses(std::string_view text, const std::string& path, Index contacts) {
  inner::TextReader in(text, path);
  std::vector<Vec3> lambda(contacts);
  for (Vec3& x : lambda) x = in.vector("one of " + std::to_string(contacts) + " × 3 impulses");
  if (!in.is_at_end())
    in.refuse_here("the file goes on after the impulses of " + std::to_string(contacts) + " contacts");
  return lambda;
}

/// The same from a file. Throws InvalidArgument with file, line and reason.
inline FrictionProblem read_problem(const std::string& path) {
  return parse_problem(inner::read_text(path), path);
}
/// 3 · `contacts` impulses from a file. Throws as `read_problem`.
inline std::vector<Vec3> read_impulses(const std::string& path, Index contacts) {
  return parse_impulses(inner::read_text(path), path, contacts);
}

namespace inner {

/// The shortest decimals that read back as the same bits.
inline void append_exact(std::string& out, double value) {
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

inline void append_block(std::string& out, Index i, Index j, const Mat3& block) {
  out += std::to_string(i) + ' ' + std::to_string(j);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) append_exact(out += ' ', block(r, c));
  out += '\n';
}

/// W_ij = W_jiᵀ to the last bit.
inline bool is_symmetric(const FrictionProblem& p) {
  const auto W = p.W.blocks<0, 0>();
  const Index n = p.rows.pool<0>().items();
  for (Index i = 0; i < n; ++i) {
    const Mat3& own = p.W.diagonal<0>(i);
    if (own != Mat3(own.transpose())) return false;
    for (Index e = W.start[i]; e < W.start[i + 1]; ++e) {
      const Index j = W.column[e];
      Index f = W.start[j];
      while (f < W.start[j + 1] && W.column[f] != i) ++f;
      if (f == W.start[j + 1] || W.block[e] != Mat3(W.block[f].transpose())) return false;
    }
  }
  return true;
}

}  // namespace inner

/// The problem without its λ, as `sym` where W is symmetric to the bit.
inline std::string problem_text(const FrictionProblem& p) {
  const auto& pool = p.rows.pool<0>();
  const auto W = p.W.blocks<0, 0>();
  const bool is_symmetric = inner::is_symmetric(p);
  const Index n = pool.items();
  std::string blocks;
  Index count = 0;
  for (Index i = 0; i < n; ++i) {
    inner::append_block(blocks, i, i, p.W.diagonal<0>(i));
    ++count;
    for (Index e = W.start[i]; e < W.start[i + 1]; ++e) {
      if (is_symmetric && W.column[e] > i) continue;
      inner::append_block(blocks, i, W.column[e], W.block[e]);
      ++count;
    }
  }
  std::string out = is_symmetric ? "fcp 1 sym\n" : "fcp 1 gen\n";
  out += std::to_string(n) + ' ' + std::to_string(count) + '\n';
  for (Index i = 0; i < n; ++i) {
    if (i > 0) out += ' ';
    inner::append_exact(out, p.laws.pool<0>().item(i).parameters.friction);
  }
  out += '\n';
  for (const Vec3& q : pool.d) {
    for (int k = 0; k < 3; ++k) inner::append_exact(k > 0 ? out += ' ' : out, q[k]);
    out += '\n';
  }
  return out + blocks;
}

/// N·s, one number a line, to the last bit.
inline std::string impulses_text(std::span<const Vec3> lambda) {
  std::string out;
  for (const Vec3& impulse : lambda)
    for (const double x : impulse) inner::append_exact(out, x), out += '\n';
  return out;
}

/// Throws InvalidArgument naming `path` when it cannot be written.
inline void write_problem(const std::string& path, const FrictionProblem& p) {
  inner::write_file(path, problem_text(p));
}
/// The same for impulses, N·s.
inline void write_impulses(const std::string& path, std::span<const Vec3> lambda) {
  inner::write_file(path, impulses_text(lambda));
}

}  // namespace delassus
