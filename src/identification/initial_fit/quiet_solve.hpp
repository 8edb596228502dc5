#pragma once

#include <ceres/problem.h>
#include <ceres/solver.h>

namespace zwidth::internal {

/// ceres::Solve() on one thread, which prints nothing: a step that fails, or a residual that is not finite, it tells by glog
/// whatever `logging_type` says. The level of glog is the process's: it is put back when the last solve has ended.
[[nodiscard]] ceres::Solver::Summary quiet_solve(ceres::Solver::Options options, ceres::Problem& problem);

}  // namespace zwidth::internal
