/// What one constraint adds to the measure of an island.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>

namespace delassus::inner {

/// w = tr(W_ii)/rows, 1/kg.
template <int R, class T>
T weight_of(const Mat<R, R, T>& own) {
  return trace(own) * (T(1) / T(R));
}

/// |F_i(w)|² and |F_i(1)|² of `Measure`, at once where the law knows them so.
template <int p, class Book, int R, class T>
Vec<2, T> natural_squares(Book& book, Index i, const Local<R, T>& c, T weight) {
  if constexpr (requires { book.template natural_squares<p>(i, c, weight); })
    return book.template natural_squares<p>(i, c, weight);
  else
    return {squared_norm(book.template natural_map<p>(i, c, weight)),
            squared_norm(book.template natural_map<p>(i, c, T(1)))};
}

/// The share of constraint i of pool p, which has velocity and impulse of `c`, and without impulses d.
template <int p, class Book, int R, class T>
void add_share(Book& book, Index i, const Local<R, T>& c, const Vec<R, T>& d, MeasureSums& sums) {
  const T weight = weight_of(c.W);
  const Vec<2, T> squares = natural_squares<p>(book, i, c, weight);
  const double square = double(squares[0]), lambda = double(squared_norm(c.lambda));
  sums.residual += square;
  sums.worst = std::max(sums.worst, square);
  sums.siconos += double(squares[1]);
  sums.d += double(squared_norm(d));
  sums.u += double(squared_norm(c.d));
  sums.lambda += lambda;
  sums.reach = std::max(sums.reach, double(weight * weight) * lambda);
}

}  // namespace delassus::inner
