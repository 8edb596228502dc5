#include "identification/likelihood_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "identification/encoder_step.hpp"
#include "identification/evidence/sum_of_evidence.hpp"
#include "identification/evidence/time_evidence.hpp"
#include "identification/fit/minimise.hpp"
#include "identification/model/rivals/catalogue.hpp"
#include "identification/verdict/limit_moment.hpp"
#include "identification/verdict/profile.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

constexpr Eigen::Index noise_order = 24;
constexpr double short_segment = 0.5;  // s
constexpr double long_segment = 10.0;  // s
constexpr std::size_t left_out = 20;   // samples at a record's beginning, whose forces came before it

double rms(std::span<const double> samples) {
  double squares = 0.0;
  for (const double each : samples) squares += each * each;
  return std::sqrt(squares / static_cast<double>(samples.size()));
}

/// The device's own numbers: masses and link stiffnesses hardly known beforehand, dampings not at all.
Number number_of(const std::string& key, const DeviceParameters& start, const RivalSetting& setting) {
  constexpr double of_critical = 0.01;  // a link's damping, of the square root of stiffness times mass
  const double value = *parameter(start, key);
  const bool is_of_link = key.starts_with("link.");
  if (key.ends_with(".mass") || (is_of_link && key.ends_with(".stiffness"))) {
    return {key, Number::Scale::logarithmic, value, 0.0, deviation_of_logarithm};
  }
  if (key == "loop.delay") return {.key = key, .unit = setting.sampling_period};
  if (key.ends_with(".damping") && !is_of_link) return {.key = key, .unit = typical_damping(setting)};
  if (key.ends_with(".damping")) {
    const Link& link = start.links[static_cast<std::size_t>(std::stoul(key.substr(std::string("link.").size())))];
    const double typical = of_critical * std::sqrt(link.stiffness * start.bodies[link.second].mass);
    return {.key = key, .unit = std::max(value, typical)};
  }
  constexpr double small = 1e-3;
  return {.key = key, .unit = std::max(value, small * setting.rms_force / setting.rms_position)};
}

/// Where the search begins: the linear fit of the response.
struct LinearStart {
  DeviceParameters device;
  std::vector<std::string> free;
  bool frees_delay = false;
  double highest_frequency = 0.0;  ///< Hz, of the response
};

LinearStart linear_start(std::span<const Recording> recordings, const Device& structure,
                         const LikelihoodFitOptions& options) {
  constexpr const char* delay = "loop.delay";
  LinearStart start{structure.parameters(), free_parameters(structure, options.free, options.locked)};
  start.frees_delay = frees_all(options.free) && !options.known;
  if (start.frees_delay) {
    constexpr double typical = 0.5;  // sampling periods
    if (start.device.loop.delay == 0.0) start.device.loop.delay = typical * recordings.front().sampling_period;
    if (std::ranges::count(start.free, delay) == 0) start.free.emplace_back(delay);
  }
  ParameterFitOptions fit;
  fit.free = start.free;
  fit.locked = options.locked;
  fit.critical_point = ParameterFitOptions::CriticalPoint::free;
  const FrequencyResponse response = frequency_response(recordings).response;
  start.highest_frequency = response.points.back().frequency / (2.0 * std::numbers::pi);
  start.device = fit_parameters(Device(start.device), response, fit).device.parameters();
  start.device.uncertainty.reset();
  return start;
}

std::vector<Segment> segments_of(const std::vector<ForceMotionRecord>& records, double length) {
  constexpr std::size_t least = 256;
  std::vector<Segment> segments;
  for (std::size_t record = 0; record < records.size(); ++record) {
    const std::size_t samples = records[record].position.size() - left_out;
    const auto wanted = std::max(least, static_cast<std::size_t>(length / records[record].sampling_period));
    const std::size_t count = std::max<std::size_t>(1, (samples + wanted / 2) / wanted);
    for (std::size_t i = 0; i < count; ++i)
      segments.push_back({record, left_out + i * (samples / count), samples / count});
  }
  return segments;
}

/// The records in segments of one length as a likelihood, and a search in it.
class Search {
 public:
  Search(const MotionModel& model, double segment, const std::vector<double>& steps)
      : evidence_(std::make_shared<TimeEvidence>(model, segments_of(model.records(), segment), steps, noise_order)),
        all_(model.numbers(), {evidence_}) {}

  [[nodiscard]] const SumOfEvidence& likelihood() const { return all_; }
  [[nodiscard]] const TimeEvidence& evidence() const { return *evidence_; }
  void set_noise(std::vector<Noise> noise) { evidence_->set_noise(std::move(noise)); }

  /// A minimum, then others under the noise of its residuals, `rounds` in all.
  [[nodiscard]] std::optional<Minimum> from(Eigen::VectorXd z, int rounds, MinimiseOptions options) {
    std::optional<Minimum> found;
    for (int round = 0; round < rounds; ++round) {
      found = minimise(all_, std::move(z), options);
      if (!found) return std::nullopt;
      z = found->z;
      if (round + 1 < rounds && !take_noise(z)) return std::nullopt;
    }
    return found;
  }
  /// That of the residuals at z.
  [[nodiscard]] bool take_noise(const Eigen::VectorXd& z) {
    const Eigen::Index numbers = evidence_->numbers();
    auto noise = evidence_->noise_at(z.head(numbers), z.tail(z.size() - numbers));
    if (!noise) return false;
    evidence_->set_noise(*std::move(noise));
    return true;
  }
  /// Of all samples: the logarithm of what one has that those before do not. Maximum likelihood makes it small.
  [[nodiscard]] double innovations() const {
    double sum = 0.0;
    for (const Segment& each : evidence_->segments())
      sum += static_cast<double>(each.count) * std::log(evidence_->noise()[each.record].deviation);
    return sum;
  }

 private:
  std::shared_ptr<TimeEvidence> evidence_;
  SumOfEvidence all_;
};

/// White, of a few steps of the encoder or a hundredth of what the position changes in a sample.
std::vector<Noise> first_noise(const std::vector<ForceMotionRecord>& records, const std::vector<double>& steps) {
  constexpr double of_step = 0.3;
  constexpr double of_change = 0.01;
  std::vector<Noise> noise;
  for (std::size_t record = 0; record < records.size(); ++record) {
    std::vector<double> changes(records[record].position.begin() + 1, records[record].position.end());
    for (std::size_t k = 0; k < changes.size(); ++k) changes[k] -= records[record].position[k];
    noise.push_back({.deviation = std::max(of_step * steps[record], of_change * rms(changes))});
  }
  return noise;
}

/// From several frictions with short segments; the most likely end, with the states where long segments begin.
std::optional<Eigen::VectorXd> found_near(Search& near, Search& whole, const MotionModel& model,
                                          const Eigen::VectorXd& linear, const std::string& friction,
                                          const std::vector<Noise>& noise) {
  constexpr double frictions[] = {0.0, 0.05};  // of the force
  constexpr double damping_beside = 0.3;       // of the linear fit's, which has the friction in it
  constexpr MinimiseOptions coarse{.most_steps = 20, .least_gain = 2.0};
  std::optional<Eigen::VectorXd> best;
  double least = 0.0;
  for (const double share : frictions) {
    Eigen::VectorXd x = linear;
    for (std::size_t i = 0; share > 0.0 && i < model.numbers().size(); ++i) {
      const std::string& key = model.numbers()[i].key;
      if (key == friction) x(static_cast<Eigen::Index>(i)) = share;
      if (key.starts_with("body.") && key.ends_with(".damping")) x(static_cast<Eigen::Index>(i)) *= damping_beside;
    }
    near.set_noise(noise);
    const auto end = near.from(near.likelihood().start(x), 2, coarse);
    if (!end || !near.take_noise(end->z) || (best && near.innovations() >= least)) continue;
    least = near.innovations();
    whole.set_noise(near.evidence().noise());
    const Eigen::Index numbers = x.size();
    const Eigen::Index states = model.states();
    best = whole.likelihood().start(end->z.head(numbers));
    for (std::size_t i = 0; i < whole.evidence().segments().size(); ++i) {
      for (std::size_t j = 0; j < near.evidence().segments().size(); ++j) {
        const Segment& to = whole.evidence().segments()[i];
        const Segment& of = near.evidence().segments()[j];
        if (to.record != of.record || to.first != of.first) continue;
        best->segment(numbers + static_cast<Eigen::Index>(i) * states, states) =
            end->z.segment(numbers + static_cast<Eigen::Index>(j) * states, states);
      }
    }
  }
  return best;
}

}  // namespace

std::optional<LikelihoodFit> fit_by_likelihood(std::span<const Recording> recordings, const Device& structure,
                                               const LikelihoodFitOptions& options) {
  constexpr int parts = 4;  // of a sampling period
  constexpr int rounds = 5;
  constexpr double rise = 1.92;  // 95 %: half the quantile of chi-squared with one degree of freedom
  const LinearStart start = linear_start(recordings, structure, options);
  std::vector<ForceMotionRecord> records;
  std::vector<double> steps;
  for (const Recording& each : recordings) {
    records.push_back({each.channels[0].samples, each.channels[1].samples, each.sampling_period});
    steps.push_back(encoder_step(each.channels[1].samples));
  }
  RivalSetting setting = rival_setting(start.device, options.locked, records, start.highest_frequency);
  setting.frees_lag = start.frees_delay || std::ranges::count(start.free, "actuator.time_constant") > 0;
  ModelParts all;
  for (const std::string& key : start.free) {
    if (key != "actuator.time_constant") all.numbers.push_back(number_of(key, start.device, setting));
  }
  add_rivals(setting, all);

  const MotionModel model(DeviceFamily(start.device, all.numbers, options.locked, all.further_body), all.terms, records,
                          parts);
  const Eigen::VectorXd linear = model.family().coordinates_of(start.device);
  Search near(model, short_segment, steps);
  Search whole(model, long_segment, steps);
  const std::string friction = "friction." + start.device.bodies[start.device.loop.actuated].name;
  const auto begin = found_near(near, whole, model, linear, friction, first_noise(records, steps));
  std::optional<Minimum> best;
  if (begin) best = whole.from(*begin, rounds, {.most_steps = 15, .least_gain = 0.05});
  const auto limit_at = [&](const Eigen::VectorXd& z, double share) -> std::optional<double> {
    DeviceParameters device = model.family().device_at(z, share);
    device.wall.damping = 0.0;
    if (find_problem(device)) return std::nullopt;
    const CriticalStiffness found = critical_stiffness(Device(std::move(device)));
    const bool is_finite = found.status == StiffnessStatus::finite && found.stiffness > 0.0;
    return is_finite ? std::optional(std::log(found.stiffness)) : std::nullopt;
  };
  const auto moment_of = [&](const Minimum& minimum) {
    return limit_moment(limit_at, minimum, model.family().of_device(), model.family().of_limit());
  };
  std::optional<double> moment;
  if (best) moment = moment_of(*best);
  if (!moment) return std::nullopt;
  const auto limit = [&](const Eigen::VectorXd& z) { return limit_at(z, *moment); };

  // An end that is more likely than the best was none: the search goes on from there.
  constexpr int most_begins = 5;
  ProfileEnd low;
  ProfileEnd high;
  for (int begins = 0; begins < most_begins; ++begins) {
    low = profile_end(whole.likelihood(), *best, limit, model.family().of_limit(), -1.0, rise);
    if (!low.found_better) high = profile_end(whole.likelihood(), *best, limit, model.family().of_limit(), 1.0, rise);
    const ProfileEnd& better = low.found_better ? low : high;
    if (!better.found_better) break;
    auto again = minimise(whole.likelihood(), better.z, {.most_steps = 15, .least_gain = 0.02});
    if (again) best = *std::move(again);
    moment = moment_of(*best);
    if (!moment) return std::nullopt;
  }
  return LikelihoodFit{model.family().device_at(best->z, *moment), std::exp(*limit(best->z)), std::exp(low.value),
                       std::exp(high.value), low.settled && high.settled};
}

}  // namespace zwidth::internal
