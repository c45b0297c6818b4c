/// Contacts with the other solvers and builders of W: by Newton's method, directly, without a matrix, with a
/// deadline.
#include <delassus/compliance/matrix_free.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/solvers/path_newton.hpp>
#include <delassus/solvers/proximal_newton.hpp>
#include <delassus/stabilisation/whole_violation.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

template <class... Parts>
auto heap_with(Parts... parts) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, parts...};
  add_heap(loop);
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("solvers_more");
  const Options faces{.h = 0.01, .is_redundant = true};
  all.add("heap_proximal_newton", faces, [] { return heap_with(ProximalNewton{.tolerance = 1e-9}); });
  all.add("heap_path_newton", faces, [] { return heap_with(PathNewton{.tolerance = 1e-9}); });
  all.add("heap_matrix_free", faces, [] {
    return heap_with(MatrixFreeCompliance{}, GaussSeidel{.tolerance = 1e-8, .max_iterations = 5000});
  });
  all.add("heap_least_impulses", faces,
          [] { return heap_with(MinimumNorm{AcceleratedGaussSeidel{.tolerance = 1e-9}}, WholeViolation{}); });
  return all.main(argc, argv);
}
