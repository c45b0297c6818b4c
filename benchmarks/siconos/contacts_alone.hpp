/// The contacts of a step with joints, as a problem of contacts alone.
#pragma once

#include <delassus/constraints/joints/bounded.hpp>
#include <delassus/problems/friction_problem.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

namespace problems {

using namespace delassus;

/// Where the rows of an item go.
struct Place {
  enum Kind { nowhere, contact, held, given } kind = nowhere;
  Index at = 0;  ///< number of the contact, or of the first held row
  Index island = -1;
};

/// M^(−1/2) of a positive semidefinite M, zero along what redundant rows leave of it.
inline Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& M) {
  const Eigen::VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * M * scale.asDiagonal());
  Eigen::VectorXd root = solver.eigenvalues();
  const double least = 1e-10 * root.maxCoeff();
  for (double& x : root) x = x > least ? 1 / std::sqrt(x) : 0;
  return root.asDiagonal() * solver.eigenvectors().transpose() * scale.asDiagonal();
}

/// The problem that a step's contacts have when its joints hold. With c the contacts and j the rows of
/// joints,
///
///   u_j = W_jc λ_c + W_jj λ_j + d_j = 0   gives   W = W_cc − W_cj W_jj⁺ W_jc,  q = d_c − W_cj W_jj⁺ d_j.
///
/// A motor or drive at its cap pushes with the cap: its impulse goes to q. W is symmetric to the bit. λ is
/// that of the step. Pools are contacts with friction, joints that are equalities, and rows with a cap.
template <class Laws, class Rows, class Operator>
class ContactsAlone {
  static constexpr int pools = Laws::pool_count;
  using Pairs = std::map<std::pair<Index, Index>, Mat3>;

  template <int p>
  using law = std::remove_cvref_t<decltype(std::declval<const Laws&>().template pool<p>().law)>;
  template <int p>
  using item = std::remove_cvref_t<decltype(std::declval<const Laws&>().template pool<p>().item(0))>;
  template <int p>
  static constexpr bool is_contact = Rows::template rows_of<p> == 3 && delassus::inner::has_friction<item<p>>;

 public:
  explicit ContactsAlone(const Problem<Laws, Rows, Operator>& from) : from_(from), places_(pools) {
    for_each_index<pools>([&](auto p) { take<p>(); });
    d_ = Eigen::VectorXd::Zero(held_);
    M_ = Eigen::MatrixXd::Zero(held_, held_);
    B_ = Eigen::MatrixXd::Zero(held_, 3 * Index(q_.size()));
    for_each_index<pools>([&](auto p) { add_rows<p>(); });
    for (Index k = 0; k < from.islands.count(); ++k) eliminate(k);
  }

  /// Whether every contact can still be moved along each axis. Joints that fix both bodies of one leave it no
  /// W of its own, and no problem of contacts alone holds it.
  bool are_free() const { return are_free_; }

  FrictionProblem problem() const {
    std::vector<GivenBlock> blocks;
    for (const auto& [place, block] : W_) {
      const auto [i, j] = place;
      if (block.isZero(0)) continue;
      blocks.push_back({i, j, i == j ? Mat3(0.5 * (block + block.transpose())) : block});
      if (i != j) blocks.push_back({j, i, Mat3(block.transpose())});
    }
    FrictionProblem to = make_friction_problem(friction_, q_, blocks);
    std::copy(lambda_.begin(), lambda_.end(), to.rows.pool<0>().lambda.begin());
    to.h = from_.h;
    return to;
  }

 private:
  template <int p>
  void take() {
    const auto& pool = from_.rows.template pool<p>();
    const auto& laws = from_.laws.template pool<p>();
    places_[p].resize(std::size_t(pool.items()));
    for (Index k = 0; k < from_.islands.count(); ++k)
      for (const Index i : from_.islands.items(p, k)) {
        Place& place = places_[p][std::size_t(i)];
        place.island = k;
        if constexpr (is_contact<p>) {
          place.kind = Place::contact;
        } else if constexpr (std::derived_from<law<p>, Bounded>) {
          const double cap = from_.h * laws.item(i).max_force;
          place.kind = std::abs(pool.lambda[i][0]) < (1 - 1e-12) * cap ? Place::held : Place::given;
        } else {
          static_assert(law<p>::bilateral,
                        "contacts_alone takes contacts, joints that are equalities, and rows with a cap");
          place.kind = Place::held;
        }
      }
    for (Index i = 0; i < pool.items(); ++i) {  // in the order of insertion, whatever the islands
      Place& place = places_[p][std::size_t(i)];
      if (place.kind == Place::held) {
        place.at = held_;
        held_ += Rows::template rows_of<p>;
        island_of_row_.insert(island_of_row_.end(), Rows::template rows_of<p>, place.island);
      }
      if constexpr (is_contact<p>)
        if (place.kind == Place::contact) {
          place.at = Index(q_.size());
          friction_.push_back(laws.item(i).parameters.friction);
          q_.push_back(pool.d[i]);
          lambda_.push_back(pool.lambda[i]);
          island_of_contact_.push_back(place.island);
        }
    }
  }

  /// W_ab to where it goes, the product with λ_b for a given b.
  template <int a, int b>
  void add_block(Index i, Index j, const auto& block) {
    const Place &row = places_[a][std::size_t(i)], &column = places_[b][std::size_t(j)];
    if (row.kind == Place::nowhere || row.kind == Place::given || column.kind == Place::nowhere) return;
    if (column.kind == Place::given) {
      const auto push = (block * from_.rows.template pool<b>().lambda[j]).eval();
      if constexpr (is_contact<a>)
        q_[std::size_t(row.at)] += push;
      else
        d_.segment(row.at, push.size()) += push;
    } else if constexpr (is_contact<a> && is_contact<b>) {
      if (row.at >= column.at) W_[{row.at, column.at}] = block;
    } else if constexpr (is_contact<b>) {
      B_.block(row.at, 3 * column.at, block.rows(), 3) = block;
    } else if constexpr (!is_contact<a>) {
      M_.block(row.at, column.at, block.rows(), block.cols()) = block;
    }
  }

  template <int a>
  void add_rows() {
    const auto& pool = from_.rows.template pool<a>();
    for (Index i = 0; i < pool.items(); ++i) {
      const Place& row = places_[a][std::size_t(i)];
      if (row.kind == Place::held) d_.segment(row.at, Rows::template rows_of<a>) += pool.d[i];
      if (row.kind != Place::nowhere) add_block<a, a>(i, i, from_.W.template diagonal<a>(i));
      for_each_index<pools>([&](auto b) {
        const auto W = from_.W.template blocks<a, b>();
        for (Index e = W.start[i]; e < W.start[i + 1]; ++e) add_block<a, b>(i, W.column[e], W.block[e]);
      });
    }
  }

  /// Takes the held rows of an island out of W and q.
  void eliminate(Index island) {
    std::vector<Index> rows, contacts;
    for (Index r = 0; r < held_; ++r)
      if (island_of_row_[std::size_t(r)] == island) rows.push_back(r);
    if (rows.empty()) return;
    for (Index c = 0; c < Index(q_.size()); ++c)
      if (island_of_contact_[std::size_t(c)] == island && !B_.middleCols<3>(3 * c).isZero(0))
        contacts.push_back(c);
    const Eigen::MatrixXd M = M_(rows, rows), root = inverse_root(0.5 * (M + M.transpose()));
    const Eigen::VectorXd d = root * Eigen::VectorXd(d_(rows));
    std::vector<Eigen::MatrixXd> Y;
    for (const Index c : contacts) Y.push_back(root * Eigen::MatrixXd(B_(rows, Eigen::seqN(3 * c, 3))));
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      q_[std::size_t(contacts[i])] -= Y[i].transpose() * d;
      for (std::size_t j = 0; j <= i; ++j) {
        Mat3& block = W_.try_emplace({contacts[i], contacts[j]}, Mat3::Zero()).first->second;
        const Vec3 before = block.diagonal();
        block -= Y[i].transpose() * Y[j];
        if (i == j && (block.diagonal().array() <= 1e-9 * before.array()).any()) are_free_ = false;
      }
    }
  }

  const Problem<Laws, Rows, Operator>& from_;
  std::vector<std::vector<Place>> places_;
  Index held_ = 0;
  bool are_free_ = true;
  std::vector<Index> island_of_row_, island_of_contact_;
  std::vector<double> friction_;
  std::vector<Vec3> q_, lambda_;
  Eigen::VectorXd d_;      ///< of held rows
  Eigen::MatrixXd M_, B_;  ///< W_jj, W_jc
  Pairs W_;                ///< blocks with column ≤ row
};

template <class Laws, class Rows, class Operator>
FrictionProblem contacts_alone(const Problem<Laws, Rows, Operator>& from) {
  return ContactsAlone<Laws, Rows, Operator>(from).problem();
}

}  // namespace problems
