/// Eigen's quaternions and small factorizations, without the parts of their headers that nothing here names.
///
/// `<Eigen/Geometry>` reads singular values, transforms and more with the quaternions, and a compiler keeps all of it in
/// memory, in each file. What is left out here comes with Eigen's own header: a file that uses `Eigen::Isometry3d`
/// includes `<Eigen/Geometry>`, before this library or after it.
#pragma once

#include <delassus/core/cmath.hpp>

#include <Eigen/Core>

// By the guards of Eigen 3.4: of another version, and where a file has read one of these modules before, all
// is read.
#if EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4 && !defined(EIGEN_USE_LAPACKE) &&                   \
    !defined(EIGEN_CHOLESKY_MODULE_H) && !defined(EIGEN_GEOMETRY_MODULE_H) && !defined(EIGEN_LU_MODULE_H) && \
    !defined(EIGEN_QR_MODULE_H) && !defined(EIGEN_SVD_MODULE_H)

#define EIGEN_BDCSVD_H
#define EIGEN_BIDIAGONALIZATION_H
#define EIGEN_COMPLETEORTHOGONALDECOMPOSITION_H
#define EIGEN_FULLPIVOTINGHOUSEHOLDERQR_H
#define EIGEN_HOMOGENEOUS_H
#define EIGEN_HYPERPLANE_H
#define EIGEN_LDLT_H
#define EIGEN_INVERSE_SIZE_4_H
#define EIGEN_LU_H
#define EIGEN_PARAMETRIZEDLINE_H
#define EIGEN_ROTATION2D_H
#define EIGEN_SCALING_H
#define EIGEN_TRANSFORM_H
#define EIGEN_TRANSLATION_H
#define EIGEN_UMEYAMA_H

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#undef EIGEN_BDCSVD_H
#undef EIGEN_BIDIAGONALIZATION_H
#undef EIGEN_COMPLETEORTHOGONALDECOMPOSITION_H
#undef EIGEN_FULLPIVOTINGHOUSEHOLDERQR_H
#undef EIGEN_HOMOGENEOUS_H
#undef EIGEN_HYPERPLANE_H
#undef EIGEN_LDLT_H
#undef EIGEN_INVERSE_SIZE_4_H
#undef EIGEN_LU_H
#undef EIGEN_PARAMETRIZEDLINE_H
#undef EIGEN_ROTATION2D_H
#undef EIGEN_SCALING_H
#undef EIGEN_TRANSFORM_H
#undef EIGEN_TRANSLATION_H
#undef EIGEN_UMEYAMA_H

// So that Eigen's own headers read the rest.
#undef EIGEN_CHOLESKY_MODULE_H
#undef EIGEN_GEOMETRY_MODULE_H
#undef EIGEN_LU_MODULE_H
#undef EIGEN_QR_MODULE_H
#undef EIGEN_SVD_MODULE_H

#else

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#endif
