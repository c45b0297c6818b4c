/// What a refinement of a law must be: its arguments and what it returns.
#pragma once

#include <delassus/rows/local.hpp>

#include <concepts>

namespace delassus::inner {

/// A law with the types that its refinements are called with: `Given` is its item, or what a contact hands to the laws inside.
template <class L, class G, class M, class W, bool in_contact>
struct AskedLaw {
  using Law = L;
  using Given = G;
  using Memory = M;
  using World = W;
  using T = typename W::Scalar;
  using Vector = Vec<L::rows, T>;
  using Matrix = Mat<L::rows, L::rows, T>;
  static constexpr bool is_in_contact = in_contact;
};

template <class A>
concept HasPrepare = requires(const typename A::Law& law, const typename A::Matrix& W, typename A::Memory& memory) {
  { law.prepare(W, memory) } -> std::same_as<void>;
} || requires(const typename A::Law& law, const typename A::Given& given, const typename A::Matrix& W, typename A::Memory& memory) {
  { law.prepare(given, W, 1.0, memory) } -> std::same_as<void>;
};
/// One that takes a temporary would change a copy.
template <class A>
concept HasClamp = requires(const typename A::Law& law, const typename A::Given& given, typename A::Vector& lambda) {
  { law.clamp(given, lambda) } -> std::same_as<void>;
  requires !requires { law.clamp(given, typename A::Vector(lambda)); };
} || (!A::is_in_contact && requires(const typename A::Law& law, const typename A::Given& given, typename A::Vector& lambda,
                                    const typename A::Memory& memory) {
  { law.clamp(given, lambda, memory) } -> std::same_as<void>;
  requires !requires { law.clamp(given, typename A::Vector(lambda), memory); };
});
template <class A>
concept HasNaturalMap = requires(const typename A::Law& law, const typename A::Given& given, const typename A::Vector& x,
                                 typename A::T scale) {
  { law.natural_map(given, x, x, scale) } -> std::same_as<typename A::Vector>;
};
template <class A>
concept HasNaturalSquares = requires(const typename A::Law& law, const typename A::Given& given, const typename A::Vector& x,
                                     typename A::T scale) {
  { law.natural_squares(given, x, x, scale) } -> std::same_as<Vec<2, typename A::T>>;
};
template <class A>
concept HasProjectionStep = requires(const typename A::Law& law, const typename A::Given& given, const typename A::Vector& x,
                                     const typename A::Matrix& W) {
  { law.projection_step(given, W, x, x) } -> std::same_as<typename A::Vector>;
};
template <class A>
concept HasTangent = requires(const typename A::Law& law, const typename A::Given& given, Local<A::Law::rows>& c) {
  { law.tangent(given, c) } -> std::same_as<Mat<A::Law::rows, A::Law::rows>>;
} || requires(const typename A::Law& law, const typename A::Given& given, Local<A::Law::rows>& c, const typename A::Memory& memory) {
  { law.tangent(given, c, memory) } -> std::same_as<Mat<A::Law::rows, A::Law::rows>>;
};
template <class A>
concept HasConvexTangent = requires(const typename A::Law& law, const typename A::Given& given, Local<A::Law::rows>& c) {
  { law.convex_tangent(given, c, 1.0) } -> std::same_as<Mat<A::Law::rows, A::Law::rows>>;
};
template <class A>
concept HasIsSliding = requires(const typename A::Law& law, const typename A::Given& given, const typename A::Vector& lambda) {
  { law.is_sliding(given, lambda) } -> std::same_as<bool>;
};
template <class A>
concept HasCheck = (A::is_in_contact && requires(const typename A::Law& law) {
  { law.check() } -> std::same_as<void>;
}) || (!A::is_in_contact && requires(const typename A::Law& law, const typename A::Given& given) {
  { law.check(given) } -> std::same_as<void>;
});
template <class A>
concept HasSpeed = requires(const typename A::Law& law, const typename A::Given& given) {
  { law.speed(given) } -> std::convertible_to<double>;
};
template <class A>
concept HasFollow = requires(const typename A::Law& law, typename A::Given& given, const typename A::World& world) {
  { law.follow(given, world) } -> std::same_as<void>;
};
template <class A>
concept HasBreaks = requires(const typename A::Law& law, const typename A::Given& given, const Vec<A::Law::rows>& lambda) {
  { law.breaks(given, lambda, 1.0) } -> std::same_as<bool>;
};
template <class A>
concept HasRestitution = requires(const typename A::Law& law, const typename A::Given& given) {
  { law.restitution(given) } -> std::convertible_to<double>;
};
template <class A>
concept HasSetFriction = requires(const typename A::Law& law, typename A::Given& given) {
  { law.set_friction(given, 1.0) } -> std::same_as<void>;
};
template <class A>
concept HasSetRestitution = requires(const typename A::Law& law, typename A::Given& given) {
  { law.set_restitution(given, 1.0) } -> std::same_as<void>;
};

}  // namespace delassus::inner
