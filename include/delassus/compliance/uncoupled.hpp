/// The Delassus operator of bodies whose blocks know nothing of each other: cheap, and wrong where they are coupled.
#pragma once

#include <delassus/compliance/assembled.hpp>

namespace delassus {

/// Where A couples the blocks of a set, W takes each block's mass alone.
struct MassAlone {
  static constexpr bool is_whole = false;  ///< read by `BasicAssembledCompliance`
};

/// W̃ = Σ H M⁻¹ Hᵀ for particles coupled by springs under an implicit integrator; W itself where nothing couples. The
/// corrective motion takes A⁻¹ whole, so what is solved is not what is done: the rows are violated by (W − W̃) λ after a
/// step. `PredictiveScheme` leaves (W − W̃) Δλ of that, Δλ the change of λ from step to step.
using UncoupledCompliance = BasicAssembledCompliance<MassAlone>;

}  // namespace delassus
