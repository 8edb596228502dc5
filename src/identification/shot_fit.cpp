#include "identification/shot_fit.hpp"

#include <ceres/ceres.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "identification/quiet_solve.hpp"

namespace zwidth::internal {
namespace {

/// Of the logarithm of a mass or a stiffness: one over its deviation beforehand.
constexpr double pull_strength = 0.3;

bool is_logarithmic(const ShotModel& model, Eigen::Index i) {
  const auto k = static_cast<std::size_t>(i);
  return k < model.coordinates().size() && model.coordinates()[k].kind == Coordinate::Kind::logarithmic;
}

Eigen::Map<const Eigen::VectorXd> recorded(const ShotModel& model, const Shot& shot) {
  return {model.records()[shot.record].position.data() + shot.first, static_cast<Eigen::Index>(shot.count)};
}

/// How strongly the element of x is pulled to its value beforehand.
double pull_of(const ShotModel& model, Eigen::Index i) {
  // A constant force is at most about as large as the recorded one.
  const bool is_bias = i >= static_cast<Eigen::Index>(model.coordinates().size());
  return is_logarithmic(model, i) || is_bias ? pull_strength : 0.0;
}

/// Follows the squares of the filtered residuals as shots are played, until they are more than `most`.
class GrowingMisfit {
 public:
  GrowingMisfit(const ShotModel& model, const std::vector<Shot>& shots, const std::vector<ShotNoise>& noise,
                double most)
      : model_(model), shots_(shots), noise_(noise), most_(most), seen_(shots.size(), 0) {}

  bool operator()(std::size_t shot, const Eigen::Ref<const Eigen::VectorXd>& positions) {
    const ShotNoise& filter = noise_[shots_[shot].record];
    const auto order = static_cast<Eigen::Index>(filter.filter.size()) - 1;
    const Eigen::Index begin = std::max<Eigen::Index>(0, seen_[shot] - order);
    const Eigen::Index count = positions.size() - begin;
    if (count <= order) return true;
    seen_[shot] = positions.size();
    const Eigen::VectorXd residuals = positions.tail(count) - recorded(model_, shots_[shot]).segment(begin, count);
    const double own = whitened(filter, residuals).squaredNorm();
    return squares_.fetch_add(own, std::memory_order_relaxed) + own <= most_;
  }

 private:
  const ShotModel& model_;
  const std::vector<Shot>& shots_;
  const std::vector<ShotNoise>& noise_;
  double most_;
  std::vector<Eigen::Index> seen_;  // samples, by shot
  std::atomic<double> squares_ = 0.0;
};

/// What Ceres varies, and the residuals and slopes there: one playing of the records gives those of all shots.
///
/// Ceres asks for slopes where it has come to. Whatever exceeds the cost there by more than twice the function's
/// tolerance it rejects, as what cannot be played: such a point is not played to its end, nor twice.
class SharedShots : public ceres::EvaluationCallback {
 public:
  SharedShots(const ShotModel& model, const std::vector<Shot>& shots, const std::vector<ShotNoise>& noise,
              const ShotFit& start, const Eigen::VectorXd& towards, double tolerance)
      : x(start.x),
        states(start.states),
        model_(model),
        shots_(shots),
        noise_(noise),
        towards_(towards),
        tolerance_(tolerance) {}

  void PrepareForEvaluation(bool with_slopes, bool) override {
    const bool is_known = is_evaluated_ && x == evaluated_x_ && states == evaluated_states_;
    if (is_known && (has_slopes_ || !with_slopes)) return;
    is_evaluated_ = true;
    has_slopes_ = with_slopes;
    evaluated_x_ = x;
    evaluated_states_ = states;
    is_valid_ = with_slopes ? evaluate_slopes() : evaluate_trial();
  }

  [[nodiscard]] bool is_valid() const { return is_valid_; }
  [[nodiscard]] const ShotSlopes& now() const { return now_; }

  Eigen::VectorXd x;
  std::vector<Eigen::VectorXd> states;

 private:
  struct Point {
    Eigen::VectorXd x;
    std::vector<Eigen::VectorXd> states;
  };

  [[nodiscard]] bool evaluate_slopes() {
    rejected_.clear();
    most_squares_ = std::numeric_limits<double>::infinity();
    std::optional<ShotSlopes> slopes = shot_slopes(model_, shots_, noise_, x, states);
    if (!slopes) return false;
    now_ = *std::move(slopes);
    double squares = 0.0;
    for (const Eigen::VectorXd& each : now_.residuals) squares += each.squaredNorm();
    for (Eigen::Index i = 0; i < x.size(); ++i) squares += std::pow(pull_of(model_, i) * (x(i) - towards_(i)), 2);
    most_squares_ = (1.0 + 2.0 * tolerance_) * squares;
    return true;
  }

  [[nodiscard]] bool evaluate_trial() {
    const auto is_here = [&](const Point& each) { return each.x == x && each.states == states; };
    if (std::ranges::any_of(rejected_, is_here)) return false;
    GrowingMisfit misfit(model_, shots_, noise_, most_squares_);
    const std::optional<ShotPositions> residuals = shot_residuals(model_, shots_, x, states, std::ref(misfit));
    if (!residuals) {
      rejected_.push_back({x, states});
      return false;
    }
    now_.residuals.resize(shots_.size());
    for (std::size_t i = 0; i < shots_.size(); ++i) {
      now_.residuals[i] = whitened(noise_[shots_[i].record], (*residuals)[i]);
    }
    return true;
  }

  const ShotModel& model_;
  const std::vector<Shot>& shots_;
  const std::vector<ShotNoise>& noise_;
  const Eigen::VectorXd& towards_;
  double tolerance_;  // of the function
  double most_squares_ = std::numeric_limits<double>::infinity();
  std::vector<Point> rejected_;  // since the last slopes
  ShotSlopes now_;
  Eigen::VectorXd evaluated_x_;
  std::vector<Eigen::VectorXd> evaluated_states_;
  bool is_evaluated_ = false;
  bool has_slopes_ = false;
  bool is_valid_ = false;
};

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class ShotMisfit : public ceres::CostFunction {
 public:
  ShotMisfit(const SharedShots& shared, std::size_t shot, int rows, int parameters, int states)
      : shared_(shared), shot_(shot) {
    set_num_residuals(rows);
    *mutable_parameter_block_sizes() = {parameters, states};
  }

  bool Evaluate(const double* const*, double* residuals, double** jacobians) const override {
    if (!shared_.is_valid()) return false;
    const ShotSlopes& now = shared_.now();
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = now.residuals[shot_];
    if (!jacobians) return true;
    if (jacobians[0]) {
      Eigen::Map<RowMajor>(jacobians[0], num_residuals(), parameter_block_sizes()[0]) = now.of_parameters[shot_];
    }
    if (jacobians[1]) {
      Eigen::Map<RowMajor>(jacobians[1], num_residuals(), parameter_block_sizes()[1]) = now.of_states[shot_];
    }
    return true;
  }

 private:
  const SharedShots& shared_;
  std::size_t shot_;
};

class PriorMisfit : public ceres::CostFunction {
 public:
  PriorMisfit(const ShotModel& model, Eigen::VectorXd towards) : towards_(std::move(towards)) {
    for (Eigen::Index i = 0; i < towards_.size(); ++i) strength_.push_back(pull_of(model, i));
    set_num_residuals(static_cast<int>(towards_.size()));
    mutable_parameter_block_sizes()->push_back(num_residuals());
  }

  bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
    for (Eigen::Index i = 0; i < towards_.size(); ++i) {
      residuals[i] = strength_[static_cast<std::size_t>(i)] * (x[0][i] - towards_(i));
    }
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Map<RowMajor> slopes(jacobians[0], num_residuals(), num_residuals());
    slopes.setZero();
    for (Eigen::Index i = 0; i < towards_.size(); ++i) slopes(i, i) = strength_[static_cast<std::size_t>(i)];
    return true;
  }

 private:
  Eigen::VectorXd towards_;
  std::vector<double> strength_;
};

/// Whether an element of x is at its bound without being held there.
bool is_at_bound(const ShotModel& model, const Eigen::VectorXd& x, const std::vector<bool>& held) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (model.is_bounded(i) && x(i) <= 0.0 && !held[static_cast<std::size_t>(i)]) return true;
  }
  return false;
}

void hold_at_bounds(const ShotModel& model, ShotFit& fit) {
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    if (model.is_bounded(i) && fit.x(i) <= 0.0) fit.held[static_cast<std::size_t>(i)] = true;
  }
}

/// Ends the search where an element of x has come to its bound.
class StopAtBound : public ceres::IterationCallback {
 public:
  StopAtBound(const ShotModel& model, const Eigen::VectorXd& x, const std::vector<bool>& held)
      : model_(model), x_(x), held_(held) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const bool stops = summary.iteration > 0 && is_at_bound(model_, x_, held_);
    return stops ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const ShotModel& model_;
  const Eigen::VectorXd& x_;
  const std::vector<bool>& held_;
};

/// Ends the search where it creeps along a kink of the misfit: as the instants of sticking and slipping change, the
/// slopes promise far more than a step gains, and what it gains is nothing that the noise would show.
class StopCreeping : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    constexpr double kept = 0.2;     // of what the slopes promise
    constexpr double notable = 2.0;  // of the log-likelihood
    constexpr int many = 2;
    if (summary.iteration == 0 || !summary.step_is_successful) return ceres::SOLVER_CONTINUE;
    const bool creeps = summary.relative_decrease < kept && summary.cost_change < notable;
    creeping_ = creeps ? creeping_ + 1 : 0;
    return creeping_ >= many ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  int creeping_ = 0;
};

/// Until the search rests, the iterations run out, or, where asked for, an element of x has come to its
/// bound.
bool search(const ShotModel& model, const std::vector<Shot>& shots, const std::vector<ShotNoise>& noise, ShotFit& fit,
            const Eigen::VectorXd& towards, const ShotFitOptions& options, int& iterations) {
  SharedShots shared(model, shots, noise, fit, towards, options.tolerance);
  // Ceres takes the blocks of a group by their addresses: here in the order of the shots, so that equal records give
  // equal fits to the last digit.
  const std::vector<Eigen::VectorXd> states = shared.states;
  std::ranges::sort(shared.states, {}, [](const Eigen::VectorXd& each) { return each.data(); });
  for (std::size_t i = 0; i < states.size(); ++i) shared.states[i] = states[i];
  shared.PrepareForEvaluation(true, true);
  if (!shared.is_valid()) return false;  // nothing to search from
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &shared;
  ceres::Problem problem(problem_options);
  const auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto order = static_cast<int>(noise[shots[i].record].filter.size()) - 1;
    problem.AddResidualBlock(new ShotMisfit(shared, i, static_cast<int>(shots[i].count) - order,
                                            static_cast<int>(shared.x.size()), static_cast<int>(model.states())),
                             nullptr, shared.x.data(), shared.states[i].data());
    ordering->AddElementToGroup(shared.states[i].data(), 0);
  }
  ordering->AddElementToGroup(shared.x.data(), 1);
  problem.AddResidualBlock(new PriorMisfit(model, towards), nullptr, shared.x.data());
  std::vector<int> held;
  for (std::size_t i = 0; i < fit.held.size(); ++i) {
    if (fit.held[i]) held.push_back(static_cast<int>(i));
  }
  if (held.size() == static_cast<std::size_t>(shared.x.size())) {
    problem.SetParameterBlockConstant(shared.x.data());
  } else if (!held.empty()) {
    problem.SetManifold(shared.x.data(), new ceres::SubsetManifold(static_cast<int>(shared.x.size()), held));
  }
  StopAtBound stop(model, shared.x, fit.held);
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    if (model.is_bounded(i)) problem.SetParameterLowerBound(shared.x.data(), static_cast<int>(i), 0.0);
  }
  ceres::Solver::Options solver;
  StopCreeping creeping;
  solver.callbacks.push_back(&creeping);
  if (options.holds_bounds) {
    solver.callbacks.push_back(&stop);
    solver.update_state_every_iteration = true;
  }
  solver.line_search_interpolation_type = ceres::BISECTION;  // at bounds: others take a Jacobian per step
  solver.max_num_line_search_step_size_iterations = 5;       // a shorter step is the trust region's to find
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering = ordering;
  solver.max_num_iterations = options.most_iterations - iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = 1e-9;
  solver.gradient_tolerance = 1e-14;
  const ceres::Solver::Summary summary = quiet_solve(solver, problem);
  if (!summary.IsSolutionUsable()) return false;
  iterations += static_cast<int>(summary.iterations.size());
  fit.x = shared.x;
  fit.states = shared.states;
  fit.settled = summary.termination_type == ceres::CONVERGENCE;
  return true;
}

}  // namespace

std::optional<ShotPositions> shot_residuals(const ShotModel& model, const std::vector<Shot>& shots,
                                            const Eigen::VectorXd& x, const std::vector<Eigen::VectorXd>& states,
                                            const PlayOn& play_on) {
  const auto played = model.play(x, shots, states, ShotModel::Slopes::none, play_on);
  if (!played) return std::nullopt;
  ShotPositions residuals;
  for (std::size_t i = 0; i < shots.size(); ++i)
    residuals.push_back((*played)[i].positions - recorded(model, shots[i]));
  return residuals;
}

std::optional<ShotSlopes> shot_slopes(const ShotModel& model, const std::vector<Shot>& shots,
                                      const std::vector<ShotNoise>& noise, const Eigen::VectorXd& x,
                                      const std::vector<Eigen::VectorXd>& states) {
  const auto played = model.play(x, shots, states, ShotModel::Slopes::exact);
  if (!played) return std::nullopt;
  const auto coordinates = static_cast<Eigen::Index>(model.coordinates().size());
  ShotSlopes slopes;
  slopes.residuals.resize(shots.size());
  slopes.of_parameters.resize(shots.size());
  slopes.of_states.resize(shots.size());
  tbb::parallel_for(std::size_t{0}, shots.size(), [&](std::size_t i) {
    const ShotNoise& filter = noise[shots[i].record];
    const ShotMotion& motion = (*played)[i];
    slopes.residuals[i] = whitened(filter, motion.positions - recorded(model, shots[i]));
    const Eigen::MatrixXd all = whitened(filter, motion.slopes.transpose());
    slopes.of_parameters[i] = Eigen::MatrixXd::Zero(all.rows(), model.parameters());
    slopes.of_parameters[i].leftCols(coordinates) = all.leftCols(coordinates);
    slopes.of_parameters[i].col(coordinates + static_cast<Eigen::Index>(shots[i].record)) = all.col(coordinates);
    slopes.of_states[i] = all.rightCols(model.states());
  });
  return slopes;
}

std::optional<ShotFit> fit_shots(const ShotModel& model, const std::vector<Shot>& shots,
                                 const std::vector<ShotNoise>& noise, ShotFit start, const Eigen::VectorXd& towards,
                                 const ShotFitOptions& options) {
  start.held.resize(static_cast<std::size_t>(start.x.size()), false);
  int iterations = 0;
  bool is_done = false;
  while (!is_done && iterations < options.most_iterations) {  // each round holds one more
    if (!search(model, shots, noise, start, towards, options, iterations)) return std::nullopt;
    is_done = !options.holds_bounds || !is_at_bound(model, start.x, start.held);
    if (options.holds_bounds) hold_at_bounds(model, start);
  }
  start.settled = start.settled && is_done;
  return start;
}

}  // namespace zwidth::internal
