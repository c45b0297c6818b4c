/// Integrators that make the whole step.
#pragma once

namespace delassus {

namespace inner {
struct StepProbe;
}

/// An integrator that makes its step at once, joints and bodies together, brings all between Detect and Advance:
/// `void move(auto& step) const`.
template <class I>
concept MovesAtOnce = requires(const I& integrator, inner::StepProbe& step) { integrator.move(step); };

}  // namespace delassus
