/// Every wrapper is hollow around nothing and around what it is not made for, so that the loop's checks can
/// say so; around its kind it is not.
#include <delassus/collision/native.hpp>
#include <delassus/collision/seamless.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/contact/sequential_restitution.hpp>
#include <delassus/constraints/joints/breakable.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/solvers/with_deadline.hpp>
#include <delassus/stabilisation/baumgarte.hpp>
#include <delassus/stabilisation/with_compliance.hpp>

namespace delassus {
namespace {

template <auto make>
inline constexpr bool is_hollow = inner::IsHollow<decltype(make())>;

template <template <class> class Layer>
consteval bool checks_its_backend() {
  using Sound = Layer<NativeCollision>;
  return !inner::IsHollow<Sound> && inner::IsHollow<Layer<inner::Absent>> && inner::IsHollow<Layer<double>> &&
         inner::IsHollow<Layer<GaussSeidel>> && inner::IsHollow<Layer<Sound>> &&
         inner::IsHollow<Layer<Layer<double>>>;
}
static_assert(checks_its_backend<WithFilter>() && checks_its_backend<WithSurfaces>() &&
              checks_its_backend<WithCompounds>() && checks_its_backend<WithMeshes>() && checks_its_backend<Seamless>());
static_assert(is_hollow<[] { return WithFilter{}; }> && is_hollow<[] { return WithSurfaces{}; }> &&
              is_hollow<[] { return WithCompounds{}; }> &&
              is_hollow<[] { return WithMeshes{}; }> && is_hollow<[] { return Seamless{}; }>);
static_assert(is_hollow<[] {
                return WithFilter{3, true};
              }> &&
              is_hollow<[] {
                return Seamless{GaussSeidel{}, 1e-3};
              }>);

/// From the inside out; the first three go around each other as they like.
static_assert(
    !inner::IsHollow<
        WithFilter<WithSurfaces<WithCompounds<WithMeshes<Seamless<NativeCollision>>>>>> &&
    !inner::IsHollow<Seamless<WithMeshes<NativeCollision>>>);
static_assert(inner::IsHollow<WithSurfaces<WithFilter<NativeCollision>>> &&
              inner::IsHollow<WithCompounds<WithSurfaces<NativeCollision>>> &&
              inner::IsHollow<WithMeshes<WithMeshes<NativeCollision>>>);

static_assert(is_hollow<[] { return WithDeadline{}; }> && is_hollow<[] { return MinimumNorm{}; }> &&
              is_hollow<[] { return WithDeadline{1e-3}; }> && is_hollow<[] {
                return MinimumNorm{Baumgarte{}, 5};
              }> &&
              is_hollow<[] {
                return WithDeadline{WithDeadline{GaussSeidel{}, 1.0}, 1.0};
              }> &&
              is_hollow<[] {
                return MinimumNorm{WithDeadline{MinimumNorm{GaussSeidel{}}, 1.0}, 5};
              }>);
static_assert(!is_hollow<[] {
  return WithDeadline{MinimumNorm{GaussSeidel{}, 5}, 1.0};
}> && !is_hollow<[] {
  return MinimumNorm{WithDeadline{GaussSeidel{}, 1.0}};
}>);

static_assert(is_hollow<[] { return WithCompliance{}; }> && is_hollow<[] { return WithCompliance{1e-7}; }> &&
              is_hollow<[] {
                return WithCompliance{WithCompliance{Baumgarte{}, 1e-7}, 1e-6};
              }> &&
              !is_hollow<[] {
                return WithCompliance{Baumgarte{}, 1e-7};
              }>);

static_assert(is_hollow<[] { return Restitution{}; }> && is_hollow<[] { return SequentialRestitution{}; }> &&
              is_hollow<[] { return Penalty{}; }> && is_hollow<[] { return Restitution{0.5}; }> &&
              is_hollow<[] {
                return SequentialRestitution{Hinge{}, 0.5, 3};
              }> &&
              is_hollow<[] {
                return Penalty{1e5, 50};
              }> &&
              is_hollow<[] {
                return Restitution{Contact{Coulomb{}}, 0.5};
              }>);
static_assert(!is_hollow<[] {
  return Restitution{Coulomb{}, 0.5};
}> && !is_hollow<[] {
  return Penalty{Coulomb{}, 1e5, 50};
}> && !is_hollow<[] {
  return SequentialRestitution{Coulomb{}, 0.5, 3};
}>);

static_assert(requires {
  typename decltype(Breakable{})::no_joint;
  typename decltype(Breakable{5.0})::no_joint;
});
static_assert(std::is_same_v<decltype(Breakable{Hinge{}}), Breakable<Hinge>> &&
              ConstraintLaw<Breakable<Hinge>>);
static_assert(requires {
  typename Breakable<Breakable<Hinge>>::no_joint;
  typename decltype(Coupling{})::no_coordinate;
});

}  // namespace
}  // namespace delassus
