#include "identification/record_search.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace zwidth::internal {
namespace {

constexpr Eigen::Index noise_order = 12;

double rms_change(std::span<const double> samples) {
  double squares = 0.0;
  for (std::size_t k = 1; k < samples.size(); ++k) squares += std::pow(samples[k] - samples[k - 1], 2);
  return std::sqrt(squares / static_cast<double>(samples.size() - 1));
}

}  // namespace

RecordSearch::RecordSearch(const MotionModel& model, std::vector<Segment> segments, const MotionStart& start,
                           const BesideRecords& beside)
    : model_(model),
      encoder_steps_(start.encoder_steps),
      evidence_(std::make_shared<TimeEvidence>(model, std::move(segments), start.encoder_steps, noise_order)) {
  std::vector<std::shared_ptr<const LikelihoodTerm>> terms{evidence_};
  if (!beside.limits.empty()) terms.push_back(std::make_shared<LimitEvidence>(model.family(), beside.limits));
  all_ = std::make_unique<Likelihood>(model.numbers(), std::move(terms), beside.tell);
}

void RecordSearch::take_first_noise() {
  constexpr double of_step = 0.3;
  constexpr double of_change = 0.01;
  std::vector<Noise> noise;
  for (std::size_t record = 0; record < encoder_steps_.size(); ++record) {
    const double change = rms_change(model_.records()[record].position);
    noise.push_back({.deviation = std::max(of_step * encoder_steps_[record], of_change * change)});
  }
  evidence_->set_noise(std::move(noise));
}

bool RecordSearch::take_noise(const Eigen::VectorXd& z) {
  const Eigen::Index numbers = evidence_->numbers();
  auto noise = evidence_->noise_at(z.head(numbers), z.tail(z.size() - numbers));
  if (!noise) return false;
  evidence_->set_noise(*std::move(noise));
  return true;
}

double RecordSearch::innovations() const { return innovations_of(*evidence_); }

Eigen::VectorXd RecordSearch::with_states(const Eigen::VectorXd& x) const {
  Eigen::VectorXd z = all_->start(x);
  const auto fitted = minimise(*all_, z, {.most_steps = 3, .least_gain = 2.0, .held = x.size()});
  return fitted ? fitted->z : z;
}

Eigen::VectorXd RecordSearch::carried_over(const RecordSearch& from, const Eigen::VectorXd& end) const {
  const Eigen::Index numbers = evidence_->numbers();
  const Eigen::Index states = model_.states();
  const auto place = [&](std::size_t segment) { return numbers + static_cast<Eigen::Index>(segment) * states; };
  Eigen::VectorXd z = all_->start(end.head(numbers));
  const std::vector<Segment>& theirs = from.evidence_->segments();
  for (std::size_t i = 0; i < evidence_->segments().size(); ++i) {
    const Segment& here = evidence_->segments()[i];
    for (std::size_t j = 0; j < theirs.size(); ++j) {
      if (here.record == theirs[j].record && here.first == theirs[j].first)
        z.segment(place(i), states) = end.segment(place(j), states);
    }
  }
  return z;
}

std::optional<Minimum> RecordSearch::from(Eigen::VectorXd z, int rounds, MinimiseOptions options,
                                          const std::function<bool(const Minimum&)>& is_known) {
  constexpr double still = 2e-3;  // of the noise, and of its effect on the limit less
  constexpr int later_steps = 6;  // the noise is not the last: no minimum under it is worth more
  const int most_steps = options.most_steps;
  options.residuals = rows();
  std::optional<Minimum> found;
  for (int round = 0; round < rounds; ++round) {
    const bool is_between = round > 0 && round + 1 < rounds;
    options.most_steps = is_between ? std::min(most_steps, later_steps) : most_steps;
    found = minimise(*all_, std::move(z), options);
    if (!found) return std::nullopt;
    z = found->z;
    if (round == 0 && rounds > 1 && found->last_step.size() == 0) ++rounds;  // under a noise that lets none be made
    if (round + 1 == rounds || is_known(*found)) break;
    const double before = innovations();
    if (!take_noise(z)) return std::nullopt;
    const bool is_still = std::abs(innovations() - before) < still * rows();
    if (round > 1 && is_still && !found->ran_out) break;
  }
  return found;
}

double RecordSearch::rows() const {
  double sum = 0.0;
  for (const Segment& each : evidence_->segments()) sum += static_cast<double>(each.count);
  return sum;
}

double innovations_of(const TimeEvidence& evidence) {
  double sum = 0.0;
  for (const Segment& each : evidence.segments())
    sum += static_cast<double>(each.count) * std::log(evidence.noise()[each.record].deviation);
  return sum;
}

}  // namespace zwidth::internal
