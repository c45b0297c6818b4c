/// Contacts with friction given as a matrix: a problem without bodies, for the same solvers.
#pragma once

#include <delassus/compliance/assembled.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/solvers/problem.hpp>

#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Coulomb's law on rows that somebody else has linearised: an item is a friction coefficient.
struct GivenContact : Coulomb {
  static constexpr bool is_contact = true;  ///< it is a `ContactLaw`

  /// Coulomb's functions take it for its parameters.
  struct Item {
    Parameters parameters{};
    operator const Parameters&() const { return parameters; }
  };
};

namespace inner {
using GivenRows = RowSystem<double, Widths<>, 3>;
}

/// u = W λ + q with 0 ≤ u_n ⟂ λ_n ≥ 0 and Coulomb's law, per contact (n, t₁, t₂): W (1/kg) in `W`, q (m/s) is
/// `rows.pool<0>().d`, λ (N·s) `rows.pool<0>().lambda`, μ in `laws`. W need not be symmetric. All contacts
/// are one island, so that the errors are those of the whole.
using FrictionProblem =
    Problem<Constraints<GivenContact>, inner::GivenRows, AssembledCompliance::Operator<inner::GivenRows>>;

/// One block of W: the velocity that contact `column`'s impulse gives contact `row`.
struct GivenBlock {
  /// Of the contact that moves, from 0.
  Index row, column;  ///< of the contact whose impulse it is
  Mat3 block;  ///< 1/kg, axes n, t₁, t₂ of either contact
};

/// A friction problem from its parts. `blocks` in any order, one on every diagonal place and none twice; λ
/// begins at zero. `first_indefinite_contact` (`definiteness.hpp`) tells a W that no bodies have.
inline FrictionProblem make_friction_problem(const std::vector<double>& friction, const std::vector<Vec3>& q,
                                             const std::vector<GivenBlock>& blocks) {
  const Index n = Index(friction.size());
  DELASSUS_EXPECT(q.size() == friction.size(), "friction problem: " + std::to_string(friction.size()) +
                                                   " coefficients, but " + std::to_string(q.size()) +
                                                   " velocities");
  FrictionProblem p;
  auto& pool = p.rows.pool<0>();
  pool.reset(n);
  for (Index i = 0; i < n; ++i) {
    inner::expect_not_negative("friction problem: friction of contact " + std::to_string(i), friction[i]);
    DELASSUS_EXPECT(is_finite(q[i]), "friction problem: the velocity of contact " + std::to_string(i) + " is not finite");
    pool.d[i] = q[i];
    p.laws.pool<0>().items.push_back({{friction[i]}});
  }
  p.W.resize_like(p.rows);
  const auto W = p.W.blocks<0, 0>();
  std::vector<char> has_diagonal(n, 0);
  for (const GivenBlock& b : blocks) {
    DELASSUS_EXPECT(b.row >= 0 && b.row < n && b.column >= 0 && b.column < n,
                    "friction problem: block (" + std::to_string(b.row) + ", " + std::to_string(b.column) +
                        ") lies outside of " + std::to_string(n) + " contacts");
    DELASSUS_EXPECT(is_finite(b.block), "friction problem: block (" + std::to_string(b.row) + ", " + std::to_string(b.column) +
                                            ") is not finite");
    if (b.row != b.column) ++W.start[b.row + 1];
  }
  for (Index i = 0; i < n; ++i) W.start[i + 1] += W.start[i];
  std::vector<Index> next(W.start.begin(), W.start.end() - 1);
  W.column.resize(W.start[n]);
  W.block.resize(W.start[n]);
  for (const GivenBlock& b : blocks) {
    if (b.row == b.column) {
      DELASSUS_EXPECT(!has_diagonal[b.row], "friction problem: the diagonal block of contact " +
                                                std::to_string(b.row) + " is given twice");
      has_diagonal[b.row] = 1;
      p.W.diagonal<0>(b.row) = b.block;
    } else {
      W.column[next[b.row]] = b.column;
      W.block[next[b.row]++] = b.block;
    }
  }
  std::vector<Index> last(n, -1);
  for (Index i = 0; i < n; ++i) {
    DELASSUS_EXPECT(has_diagonal[i],
                    "friction problem: the diagonal block of contact " + std::to_string(i) + " is missing");
    for (Index e = W.start[i]; e < W.start[i + 1]; ++e) {
      DELASSUS_EXPECT(last[W.column[e]] != i, "friction problem: block (" + std::to_string(i) + ", " +
                                                  std::to_string(W.column[e]) + ") is given twice");
      last[W.column[e]] = i;
    }
  }
  p.islands.take_all(ArraysOf(p.rows).all());
  return p;
}

namespace inner {

/// A contact whose law has a μ.
template <class Item>
inline constexpr bool has_friction = requires(const Item& item) {
  item.parameters.friction;
};

}  // namespace inner

/// The contacts with friction of a loop's problem, from all its islands, with the λ they have there. Contacts
/// between bodies that cannot move are left out, W being zero on them. Joints and other rows cannot be
/// written in this form.
template <class Laws, class Rows, class Operator>
FrictionProblem friction_problem(const Problem<Laws, Rows, Operator>& from) {
  constexpr int pools = Laws::pool_count;
  std::vector<std::vector<Index>> number(pools);
  std::vector<double> friction;
  std::vector<Vec3> q, lambda;
  for_each_index<pools>([&](auto p) {
    const auto& pool = from.rows.template pool<p>();
    using Item = typename std::remove_cvref_t<decltype(from.laws.template pool<p>())>::Item;
    number[p].assign(pool.items(), -1);
    for (Index k = 0; k < from.islands.count(); ++k)
      for (const Index i : from.islands.items(p, k)) number[p][i] = 0;
    if constexpr (Rows::template rows_of<p> == 3 && inner::has_friction<Item>) {
      for (Index i = 0; i < pool.items(); ++i) {
        if (number[p][i] < 0) continue;
        number[p][i] = Index(q.size());
        friction.push_back(from.laws.template pool<p>().item(i).parameters.friction);
        q.push_back(pool.d[i].template cast<double>());
        lambda.push_back(pool.lambda[i].template cast<double>());
      }
    } else {
      DELASSUS_EXPECT(pool.items() == 0,
                      "friction_problem: pool " + std::to_string(int(p)) + " has " +
                          std::to_string(pool.items()) +
                          " constraints that are not contacts with friction; this form holds those alone");
    }
  });
  std::vector<GivenBlock> blocks;
  for_each_index<pools>([&](auto a) {
    for_each_index<pools>([&](auto b) {
      if constexpr (Rows::template rows_of<a> == 3 && Rows::template rows_of<b> == 3) {
        const auto W = from.W.template blocks<a, b>();
        for (Index i = 0; i < Index(number[a].size()); ++i) {
          if (number[a][i] < 0) continue;
          if (a == b)
            blocks.push_back(
                {number[a][i], number[a][i], from.W.template diagonal<a>(i).template cast<double>()});
          for (Index e = W.start[i]; e < W.start[i + 1]; ++e)
            if (number[b][W.column[e]] >= 0)
              blocks.push_back({number[a][i], number[b][W.column[e]], W.block[e].template cast<double>()});
        }
      }
    });
  });
  FrictionProblem to = make_friction_problem(friction, q, blocks);
  to.rows.template pool<0>().lambda = lambda;
  to.h = from.h;
  return to;
}

}  // namespace delassus
