#include "identification/initial_fit/least_squares.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "identification/initial_fit/quiet_solve.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

/// The search is for y: x itself where that is a logarithm, else log x, or log x / (bound - x) where x is bounded above.
/// So there are no bounds, at which Ceres is slow.
class SearchCoordinates {
 public:
  SearchCoordinates(const FitModel& model, Eigen::VectorXd start) : model_(model), y(std::move(start)) {
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      if (may_be_zero(i)) put(i, y(i));
    }
  }

  /// x of a coordinate that may be 0.
  void put(Eigen::Index i, double x) { y(i) = searched(x, bound(i)); }

  [[nodiscard]] bool may_be_zero(Eigen::Index i) const {
    return model_.coordinates()[static_cast<std::size_t>(i)].kind == Coordinate::Kind::not_negative;
  }
  [[nodiscard]] double x(Eigen::Index i) const {
    if (!may_be_zero(i)) return y(i);
    return std::isfinite(bound(i)) ? bound(i) / (1.0 + std::exp(-y(i))) : std::exp(y(i));
  }
  [[nodiscard]] Eigen::VectorXd x() const {
    Eigen::VectorXd all(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) all(i) = x(i);
    return all;
  }
  /// dx / dy
  [[nodiscard]] double slope(Eigen::Index i) const {
    if (!may_be_zero(i)) return 1.0;
    return x(i) * (1.0 - x(i) / bound(i));
  }

 private:
  [[nodiscard]] double bound(Eigen::Index i) const { return model_.coordinates()[static_cast<std::size_t>(i)].bound; }
  [[nodiscard]] static double searched(double x, double bound) {
    if (!std::isfinite(bound)) return std::log(x);
    constexpr double inside = 0.9;
    const double share = std::min(x / bound, inside);
    return std::log(share / (1.0 - share));
  }

  const FitModel& model_;

 public:
  Eigen::VectorXd y;  ///< what Ceres varies
};

/// The misfits of all frequencies and their slopes at one position. One evaluation of the plant gives them all, so they
/// are computed before Ceres asks for them one by one.
class SharedEvaluation : public ceres::EvaluationCallback {
 public:
  SharedEvaluation(const FitModel& model, const FitData& data, Misfit misfit, const SearchCoordinates& position)
      : model_(model), data_(data), misfit_(misfit), position_(position) {}

  void PrepareForEvaluation(bool with_slopes, bool is_new_position) override {
    if (!is_new_position && (has_slopes_ || !with_slopes)) return;
    try {
      if (with_slopes) {
        ResponseWithSlopes at_x = model_.slopes_at(position_.x(), data_.frequencies);
        values_ = std::move(at_x.values);
        slopes_ = std::move(at_x.slopes);
      } else {
        values_ = model_.response_at(position_.x(), data_.frequencies);
      }
      has_slopes_ = with_slopes;
      is_valid_ = true;
    } catch (const Error&) {  // the poles were not found there: Ceres steps back
      is_valid_ = false;
    }
  }

  [[nodiscard]] bool is_valid() const { return is_valid_; }

  [[nodiscard]] std::complex<double> misfit(Eigen::Index i) const {
    const std::complex<double> measured = data_.measured[static_cast<std::size_t>(i)];
    if (misfit_ == Misfit::logarithmic) return std::log(values_(i) / measured);
    return (values_(i) - measured) * weight(i);
  }

  [[nodiscard]] std::complex<double> slope(Eigen::Index i, Eigen::Index coordinate) const {
    const std::complex<double> of_y = slopes_(i, coordinate) * position_.slope(coordinate);
    return misfit_ == Misfit::logarithmic ? of_y / values_(i) : of_y * weight(i);
  }

 private:
  /// Real and imaginary part each have half the variance.
  [[nodiscard]] double weight(Eigen::Index i) const {
    return std::numbers::sqrt2 / data_.deviations[static_cast<std::size_t>(i)];
  }

  const FitModel& model_;
  const FitData& data_;
  Misfit misfit_;
  const SearchCoordinates& position_;
  Eigen::VectorXcd values_;
  Eigen::MatrixXcd slopes_;
  bool has_slopes_ = false;
  bool is_valid_ = false;
};

/// Real and imaginary part of the misfit at one frequency.
class PointMisfit : public ceres::CostFunction {
 public:
  PointMisfit(const SharedEvaluation& shared, Eigen::Index point, Eigen::Index coordinates)
      : shared_(shared), point_(point) {
    set_num_residuals(2);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(coordinates));
  }

  bool Evaluate(const double* const*, double* residuals, double** jacobians) const override {
    if (!shared_.is_valid()) return false;
    const std::complex<double> misfit = shared_.misfit(point_);
    residuals[0] = misfit.real();
    residuals[1] = misfit.imag();
    if (!std::isfinite(residuals[0]) || !std::isfinite(residuals[1])) return false;
    if (jacobians && jacobians[0]) {
      const int n = parameter_block_sizes()[0];
      for (int j = 0; j < n; ++j) {
        const std::complex<double> slope = shared_.slope(point_, j);
        // Ceres would print its own lines about it.
        if (!std::isfinite(slope.real()) || !std::isfinite(slope.imag())) return false;
        jacobians[0][j] = slope.real();
        jacobians[0][n + j] = slope.imag();
      }
    }
    return true;
  }

 private:
  const SharedEvaluation& shared_;
  Eigen::Index point_;
};

/// (x_i - towards_i) strength_i for every coordinate.
class PullMisfit : public ceres::CostFunction {
 public:
  PullMisfit(const Pull& pull, const SearchCoordinates& position) : pull_(pull), position_(position) {
    set_num_residuals(static_cast<int>(pull.towards.size()));
    mutable_parameter_block_sizes()->push_back(num_residuals());
  }

  bool Evaluate(const double* const*, double* residuals, double** jacobians) const override {
    const Eigen::Index n = pull_.towards.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      residuals[i] = (position_.x(i) - pull_.towards(i)) * pull_.strength(i);
      if (!std::isfinite(residuals[i])) return false;
      if (!jacobians || !jacobians[0]) continue;
      for (Eigen::Index j = 0; j < n; ++j) {
        jacobians[0][i * n + j] = i == j ? pull_.strength(i) * position_.slope(i) : 0.0;
        if (!std::isfinite(jacobians[0][i * n + j])) return false;
      }
    }
    return true;
  }

 private:
  const Pull& pull_;
  const SearchCoordinates& position_;
};

double cost_at(ceres::Problem& problem) {
  double cost = 0.0;
  const bool is_valid = problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return is_valid ? cost : std::numeric_limits<double>::infinity();
}

/// From 0 itself the search could not leave: each coordinate near it starts as far away as costs nothing. Of a start that
/// is a minimum already the largest distance would make another one.
void leave_zero(ceres::Problem& problem, SearchCoordinates& position) {
  constexpr double farthest = 1e-4;
  constexpr double nearest = 1e-10;
  constexpr double nothing = 0.01;
  const double most = (1.0 + nothing) * cost_at(problem);
  for (Eigen::Index i = 0; i < position.y.size(); ++i) {
    if (!position.may_be_zero(i) || position.x(i) >= farthest) continue;
    const double own = position.x(i);
    double x = farthest;
    for (; x > std::max(own, nearest); x *= 0.1) {
      position.put(i, x);
      if (cost_at(problem) <= most) break;
    }
    position.put(i, std::max({x, own, nearest}));
  }
}

/// Puts each coordinate that has come close to 0 onto it, where that costs nothing; and one that ran away, as a damper that
/// holds two bodies together does, to where it is as good: a device of 1e10 times its other numbers cannot be judged.
void settle_at_ends(ceres::Problem& problem, SearchCoordinates& position) {
  constexpr double close = 1e-2;
  constexpr double far = 1e8;
  constexpr double nothing = 1e-6;
  const double cost = cost_at(problem);
  for (Eigen::Index i = 0; i < position.y.size(); ++i) {
    if (!position.may_be_zero(i)) continue;
    const double x = position.x(i);
    if (x > close && x <= far) continue;
    const double y = position.y(i);
    position.put(i, x > far ? far : 0.0);
    if (!(cost_at(problem) <= (1.0 + nothing) * cost)) position.y(i) = y;
  }
}

/// Whether the last fifth of the iterations gained nothing that the noise would show: a long flat valley.
bool hardly_gains(const ceres::Solver::Summary& summary) {
  if (summary.termination_type != ceres::NO_CONVERGENCE || summary.iterations.size() < 10) return false;
  const std::size_t before = summary.iterations.size() - summary.iterations.size() / 5;
  constexpr double gained = 0.02;  // of half the sum of squares: a fifth of a standard deviation
  return summary.iterations[before].cost - summary.final_cost < gained;
}

}  // namespace

LeastSquares least_squares(const FitModel& model, const FitData& data, const Eigen::VectorXd& start,
                           const LeastSquaresOptions& options, const Pull& pull) {
  SearchCoordinates position(model, start);
  SharedEvaluation shared(model, data, options.misfit, position);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &shared;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  const double per_part = options.misfit == Misfit::weighted ? std::numbers::sqrt2 : 1.0;
  const std::unique_ptr<ceres::LossFunction> loss =
      options.robust_threshold > 0.0 ? std::make_unique<ceres::HuberLoss>(per_part * options.robust_threshold)
                                     : nullptr;
  for (std::size_t i = 0; i < data.frequencies.size(); ++i) {
    problem.AddResidualBlock(new PointMisfit(shared, static_cast<Eigen::Index>(i), start.size()), loss.get(),
                             position.y.data());
  }
  if (pull.strength.size() > 0) problem.AddResidualBlock(new PullMisfit(pull, position), nullptr, position.y.data());

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.most_iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = 1e-8;
  solver.gradient_tolerance = 1e-12;
  leave_zero(problem, position);
  const ceres::Solver::Summary summary = quiet_solve(solver, problem);
  settle_at_ends(problem, position);
  return {position.x(), summary.final_cost, summary.termination_type == ceres::CONVERGENCE || hardly_gains(summary)};
}

}  // namespace zwidth::internal
