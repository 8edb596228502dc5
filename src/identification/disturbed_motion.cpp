#include "identification/disturbed_motion.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <random>
#include <span>

#include "identification/motion_residuals.hpp"
#include "linear_systems.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {
namespace {

/// Of the residuals of a record, per sample: deviation^2 / |filter(e^{jwT})|^2.
double spectral_density(const ShotNoise& noise, double angle) { return 1.0 / std::norm(response_of(noise, angle)); }

/// The deviation of a white force, held over each sample, that makes what a record leaves; 0 where none shows.
double disturbance_of(const DisturbedFit& of, std::size_t record) {
  const double period = of.model.records()[record].sampling_period;
  DeviceParameters parameters = of.model.parameters_at(of.fit.x);
  for (Body& body : parameters.bodies) body.coulomb = 0.0;
  const SampledPlant plant = sampled_plant(device_in_experiment(Device(std::move(parameters)), of.locked, period));
  constexpr int lines = 200;
  const double nyquist = std::numbers::pi / period;
  double floor = spectral_density(of.noise[record], std::numbers::pi);
  for (int i = 1; i < lines; ++i) {
    floor = std::min(floor, spectral_density(of.noise[record], std::numbers::pi * i / lines));
  }
  std::vector<double> forces;
  const double highest = std::min(of.highest, nyquist);
  for (int i = 0; i <= lines && of.lowest < highest; ++i) {
    const double frequency = of.lowest * std::pow(highest / of.lowest, static_cast<double>(i) / lines);
    const double left = spectral_density(of.noise[record], frequency * period);
    constexpr double clear = 2.0;
    if (left > clear * floor) forces.push_back((left - floor) / std::norm(response(plant, frequency)));
  }
  constexpr std::size_t enough = lines / 20;
  if (forces.size() < enough) return 0.0;
  const auto middle = forces.begin() + static_cast<std::ptrdiff_t>(forces.size() / 2);
  std::ranges::nth_element(forces, middle);
  return std::sqrt(*middle);
}

std::optional<ShotPositions> positions_under(const DisturbedFit& of, const std::vector<std::vector<double>>& forces) {
  const auto played = of.model.with_forces({forces.begin(), forces.end()})
                          .play(of.fit.x, of.shots, of.fit.states, ShotModel::Slopes::none);
  if (!played) return std::nullopt;
  ShotPositions positions;
  for (const ShotMotion& each : *played) positions.push_back(each.positions);
  return positions;
}

}  // namespace

Eigen::MatrixXd scatter_under_disturbance(const DisturbedFit& of) {
  const Eigen::Index size = of.fit.x.size();
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(size, size);
  const std::size_t records = of.model.records().size();
  std::vector<double> deviations;
  for (std::size_t r = 0; r < records; ++r) deviations.push_back(disturbance_of(of, r));
  if (std::ranges::all_of(deviations, [](double each) { return each == 0.0; })) return scatter;

  std::vector<Eigen::Index> varied;
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!of.fit.held[at] && of.estimated[at]) varied.push_back(i);
  }
  if (varied.empty()) return scatter;
  constexpr double rank_tolerance = 1e-9;
  std::vector<Eigen::MatrixXd> regressors;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < of.shots.size(); ++i) {
    const Eigen::MatrixXd& states = of.slopes.of_states[i];
    const Eigen::VectorXd scale = states.colwise().norm().cwiseMax(1e-300).cwiseInverse();
    regressors.push_back(outside_span(of.slopes.of_parameters[i], states * scale.asDiagonal(), rank_tolerance));
    squares += regressors.back().transpose() * regressors.back();
  }
  const Eigen::VectorXd unit = squares.diagonal()(varied).cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd normal = unit.asDiagonal() * squares(varied, varied) * unit.asDiagonal();
  const Eigen::MatrixXd inverse = unit.asDiagonal() * inverse_of_positive(normal) * unit.asDiagonal();

  std::vector<std::vector<double>> forces;
  for (const MotionRecord& each : of.model.records()) forces.emplace_back(each.force.begin(), each.force.end());
  const std::optional<ShotPositions> alone = positions_under(of, forces);
  if (!alone) return scatter;
  std::mt19937_64 random(1);
  constexpr int pairs = 6;
  int played = 0;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(inverse.rows(), inverse.cols());
  for (int pair = 0; pair < pairs; ++pair) {
    std::vector<std::vector<double>> disturbances = forces;
    for (std::size_t r = 0; r < records; ++r) {
      std::normal_distribution<double> normal_force(0.0, 1.0);
      for (double& each : disturbances[r]) each = deviations[r] * normal_force(random);
    }
    for (const double sign : {1.0, -1.0}) {
      std::vector<std::vector<double>> disturbed = forces;
      for (std::size_t r = 0; r < records; ++r) {
        for (std::size_t k = 0; k < disturbed[r].size(); ++k) disturbed[r][k] += sign * disturbances[r][k];
      }
      const std::optional<ShotPositions> positions = positions_under(of, disturbed);
      if (!positions) continue;
      Eigen::VectorXd score = Eigen::VectorXd::Zero(size);
      for (std::size_t i = 0; i < of.shots.size(); ++i) {
        const ShotNoise& noise = of.noise[of.shots[i].record];
        score += regressors[i].transpose() * whitened(noise, (*positions)[i] - (*alone)[i]);
      }
      const Eigen::VectorXd of_varied = score(varied);
      const Eigen::VectorXd moved = inverse * of_varied;
      sum += moved * moved.transpose();
      ++played;
    }
  }
  if (played == 0) return scatter;
  scatter(varied, varied) = sum / played + inverse;
  return scatter;
}

}  // namespace zwidth::internal
