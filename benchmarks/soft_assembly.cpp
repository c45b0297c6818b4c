// Also built with: -march=native
//
// A of a bent box of corotational tetrahedra, as the body set assembles it in every step, against a list of
// triplets and Eigen's setFromTriplets, turn by turn in one run; CPU time of one thread. Arguments: cells
// along the edges.
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include "against.hpp"

#include <Eigen/SparseCore>

#include <array>

using namespace delassus;

namespace {

/// A bent box of corotational tetrahedra, and what the other way to its A needs: K of every element at rest.
struct BentBox {
  using Soft = TetrahedralFem<Corotational>;
  Soft set;
  TetrahedralMesh mesh;
  std::vector<std::array<std::array<Mat3, 4>, 4>> K;
  std::vector<Mat3> R;
  std::vector<double> mass;
  static constexpr double h2 = 1e-4;

  explicit BentBox(const std::array<Index, 3>& cells) {
    const Corotational material{.young = 1e4};
    const Vec3 size(cells[0], cells[1], cells[2]);
    const auto body =
        set.add({.mesh = box_mesh(Vec3(0.01 * size), cells), .elasticity = material, .density = 1000});
    mesh = set.mesh(body);
    for (Index k = 0; k < set.blocks(); ++k) {
      const Vec3 x = mesh.points[k];
      set.place(set.node(body, k), {x.x() + 2 * x.z() * x.z(), x.y(), x.z() - 2 * x.x() * x.z()});
      mass.push_back(set.mass(k));
    }
    const Lame lame(material.young, material.poisson);
    R.resize(mesh.tetrahedra.size());
    for (Index e = 0; e < Index(R.size()); ++e) {
      const auto t = inner::LinearTetrahedron(mesh, e, lame).points[0];
      const auto at = Linear{.young = material.young, .poisson = material.poisson}.at(Mat3::Identity());
      K.emplace_back();
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) K.back()[a][b] = t.volume * at.block(t.gradient[a], t.gradient[b]);
    }
    turn();
  }
  void turn() {
    const Lame lame(1, 0);
    for (Index e = 0; e < Index(R.size()); ++e) {
      inner::LinearTetrahedron::Corners x;
      for (int a = 0; a < 4; ++a) x[a] = set.pose(mesh.tetrahedra[e][a]).position;
      const SingularValues F =
          singular_values(inner::LinearTetrahedron(mesh, e, lame).points[0].deformation(x));
      R[e] = F.U * F.V.transpose();
    }
  }
  void triplets(std::vector<Eigen::Triplet<double>>& to) const {
    to.clear();
    for (std::size_t e = 0; e < R.size(); ++e) {
      const auto& t = mesh.tetrahedra[e];
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
          const Mat3 B = h2 * (R[e] * K[e][a][b] * R[e].transpose());
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) to.emplace_back(3 * t[a] + r, 3 * t[b] + c, B(r, c));
        }
    }
    for (Index i = 0; i < 3 * Index(mass.size()); ++i) to.emplace_back(i, i, mass[i / 3]);
  }
};

/// K of all elements into A. Ours is the body set's own `assemble`, less what its forces and the elements'
/// turns take; theirs has the turns given, multiplies R K Rᵀ of the blocks at rest and fills a list of
/// triplets. `whole` is `assemble` with forces and turns.
void assembly_against_triplets(benchmark::State& state) {
  BentBox bent({Index(state.range(0)), Index(state.range(1)), Index(state.range(2))});
  std::vector<Eigen::Triplet<double>> list;
  Eigen::SparseMatrix<double> A(3 * bent.set.blocks(), 3 * bent.set.blocks());
  std::vector<double> whole, ours, theirs;
  bent.set.assemble({.mass = 1, .stiffness = BentBox::h2});  // warm
  for (auto _ : state) {
    if (whole.size() % 10 == 0)
      theirs.push_back(against::seconds([&] {
        bent.triplets(list);
        A.setFromTriplets(list.begin(), list.end());
      }));
    const double forces = against::seconds([&] { bent.set.assemble({.mass = 1}); });
    whole.push_back(against::seconds([&] { bent.set.assemble({.mass = 1, .stiffness = BentBox::h2}); }));
    ours.push_back(whole.back() - forces);
    state.SetIterationTime(whole.back());
  }
  state.counters["theirs_ms"] = 1e3 * against::median(theirs);
  state.counters["ours_ms"] = 1e3 * against::median(ours);
  state.counters["whole_ms"] = 1e3 * against::median(whole);
  state.counters["times_faster"] = against::median(theirs) / against::median(ours);
  state.counters["times_faster_whole"] = against::median(theirs) / against::median(whole);
}

}  // namespace

// 512, 3000 and 10 000 nodes.
BENCHMARK(assembly_against_triplets)
    ->Args({7, 7, 7})
    ->Args({9, 14, 19})
    ->Args({19, 19, 24})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
