#include "identification/motion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/contradicted_numbers.hpp"
#include "identification/further_body.hpp"
#include "identification/model/number_keys.hpp"
#include "identification/motion_search.hpp"
#include "identification/motion_segments.hpp"
#include "identification/verdict/calibration.hpp"
#include "identification/verdict/confidence.hpp"
#include "identification/verdict/finding_of_fit.hpp"
#include "identification/verdict/limit_instants.hpp"
#include "identification/verdict/log_critical_stiffness.hpp"
#include "identification/verdict/profile.hpp"
#include "identification/verdict/segment_residuals.hpp"
#include "identification/verdict/widening.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

/// The limit over the fits that are as likely, before what is left is asked; logarithms.
struct LimitRange {
  DriftInstants instants;
  ProfileRange profile;
};

/// The limit of a found motion, nobody holding, no damper.
class LimitOfMotion {
 public:
  explicit LimitOfMotion(FoundMotion& found) : found_(found) {}

  /// log K_CR with the drifts at these instants of a record; nothing where there is none.
  [[nodiscard]] std::optional<double> at(const Eigen::VectorXd& z, const DriftInstants& instants) const {
    return log_critical_stiffness(found_.model->family().device_at(z, instants));
  }

  /// The least and the largest limit that are as likely, everything refitted on the way, rivals too.
  [[nodiscard]] std::optional<LimitRange> range() {
    constexpr MinimiseOptions fine{.most_steps = 15, .least_gain = 0.02};
    std::optional<DriftInstants> instants;
    const auto limit_at = [&](const Minimum& best) -> std::optional<LogOf> {
      instants = instants_at(best);
      if (!instants) return std::nullopt;
      return LogOf([this, at_instants = *instants](const Eigen::VectorXd& z) { return at(z, at_instants); });
    };
    const Eigen::Index varied = found_.model->family().of_limit();
    auto profile = profile_range(*found_.likelihood, found_.best, limit_at, varied, rise_of_95, fine);
    if (!profile) return std::nullopt;
    return LimitRange{*instants, *std::move(profile)};
  }

  /// How log K_CR hangs on the numbers.
  [[nodiscard]] Eigen::VectorXd slope(const DriftInstants& instants) const {
    return slope_of([&](const Eigen::VectorXd& z) { return at(z, instants); }, found_.best.z,
                    found_.model->family().of_limit(), found_.likelihood->lowest());
  }

 private:
  [[nodiscard]] std::optional<DriftInstants> instants_at(const Minimum& best) const {
    const DeviceFamily& family = found_.model->family();
    return limit_instants([&](const Eigen::VectorXd& z, const DriftInstants& instants) { return at(z, instants); },
                          best, family.of_device(), family.of_limit());
  }

  FoundMotion& found_;
};

std::vector<FittedMotion> motions_of(const FoundMotion& found, std::span<const Recording> recordings,
                                     const FoundDevice& device) {
  const auto numbers = static_cast<Eigen::Index>(found.model->numbers().size());
  const auto left =
      found.evidence->residuals(found.best.z.head(numbers), found.best.z.tail(found.best.z.size() - numbers));
  std::vector<FittedMotion> motions;
  for (std::size_t record = 0; record < recordings.size(); ++record) {
    const Recording& recording = recordings[record];
    FittedMotion motion;
    motion.source = recording.source;
    motion.sampling_period = recording.sampling_period;
    motion.noise = found.evidence->noise()[record].deviation;
    motion.recorded = recording.channels[1].samples;
    motion.residuals.assign(motion.recorded.size(), 0.0);
    std::size_t fitted = 0;
    for (std::size_t i = 0; left && i < left->size(); ++i) {
      const Segment& segment = found.evidence->segments()[i];
      if (segment.record != record) continue;
      fitted += segment.count;
      for (std::size_t k = 0; k < segment.count; ++k)
        motion.residuals[segment.first + k] = -(*left)[i](static_cast<Eigen::Index>(k));
    }
    const Eigen::Map<const Eigen::VectorXd> recorded(motion.recorded.data(),
                                                     static_cast<Eigen::Index>(motion.recorded.size()));
    const Eigen::Map<const Eigen::VectorXd> rest(motion.residuals.data(), recorded.size());
    const double deviation = std::sqrt((recorded.array() - recorded.mean()).square().mean());
    if (deviation > 0.0 && fitted > 0)
      motion.unexplained = rest.norm() / std::sqrt(static_cast<double>(fitted)) / deviation;
    for (Eigen::Index i = 0; i < numbers; ++i) {
      const Number& number = device.best.numbers[static_cast<std::size_t>(i)];
      if (number.key != constant_force_key(record)) continue;
      motion.constant_force = number.value(device.best.x(i));
      motion.constant_force_deviation =
          number.slope(device.best.x(i)) * std::sqrt(std::max(0.0, device.best.covariance(i, i)));
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

/// What the data alone say of a delay that is given: the fit's less what was believed.
std::optional<GivenDelay> given_delay_of(const FoundMotion& found, const BestNumbers& best, const LimitOfMotion& limit,
                                         const DriftInstants& instants) {
  const auto place = std::ranges::find(best.numbers, key_of_delay, &Number::key);
  if (place == best.numbers.end() || !std::isfinite(place->prior_deviation)) return std::nullopt;
  const auto i = static_cast<Eigen::Index>(place - best.numbers.begin());
  const double believed = 1.0 / (place->prior_deviation * place->prior_deviation);
  const double told = 1.0 / best.covariance(i, i) - believed;
  constexpr double least_told = 1e-3;
  if (!(told > least_told * believed)) return std::nullopt;
  const double shown = (best.x(i) * (told + believed) - place->expected * believed) / told;
  Eigen::VectorXd z = found.best.z;
  z.head(best.x.size()) += best.covariance.col(i) / best.covariance(i, i) * (shown - best.x(i));
  z = z.cwiseMax(found.likelihood->lowest());
  const auto then = limit.at(z, instants);
  return GivenDelay{.given = place->unit * place->expected,
                    .shown = place->unit * shown,
                    .deviation = place->unit / std::sqrt(told),
                    .sampling_period = place->unit,
                    .stiffness = then ? std::exp(*then) : best.stiffness};
}

/// A device that plays the records, before its limit is asked.
struct PlayedRecords {
  MotionStart start;
  FoundMotion motion;
};

std::optional<PlayedRecords> played_records(std::span<const Recording> recordings, const FrequencyResponse& response,
                                            const Device& structure, const MotionFitOptions& options) {
  MotionStart start = motion_start(recordings, response, structure, options.free);
  auto motion = found_motion(start, options.free.locked, {options.segment, {options.limits, options.tell}});
  if (!motion) return std::nullopt;
  return PlayedRecords{std::move(start), *std::move(motion)};
}

/// The range of its limit, what is left, and what contradicts it. Nothing where it has no limit.
std::optional<MotionFit> fit_of(PlayedRecords played, std::span<const Recording> recordings,
                                const MotionFitOptions& options) {
  auto& [start, motion] = played;
  LimitOfMotion limit(motion);
  const auto range = limit.range();
  if (!range) return std::nullopt;

  const std::vector<Number>& numbers = motion.model->numbers();
  const auto count = static_cast<Eigen::Index>(numbers.size());
  const Eigen::VectorXd slope = limit.slope(range->instants);
  Eigen::VectorXd precision(count);
  for (Eigen::Index i = 0; i < count; ++i)
    precision(i) = std::pow(numbers[static_cast<std::size_t>(i)].prior_deviation, -2.0);
  MotionFit fit;
  const auto segments = segment_residuals(*motion.evidence, motion.best.z);
  const double wider = segments ? widening(*segments, {slope.head(count), precision}) : 1.0;
  if (segments) fit.omnibus = omnibus(*segments);
  FoundDevice& found = fit.found;
  found.device = motion.model->family().device_at(motion.best.z, range->instants);
  found.rivals = start.rivals;
  const ProfileRange& profile = range->profile;
  found.last_change = std::max({profile.low.last_change, profile.high.last_change, last_change(motion.best, slope)});
  found.best = {
      .numbers = numbers,
      .x = motion.best.z.head(count),
      .covariance = covariance_of(motion.best.picture.hessian).topLeftCorner(count, count),
      .stiffness_slope = slope.head(count),
      .stiffness = std::exp(profile.middle),
      .interval = widened({profile.middle, profile.low.value, profile.high.value,
                           std::sqrt(std::max(0.0, slope.dot(covariance_times(motion.best.picture.hessian, slope))))},
                          wider),
      .motion = found.device.motion};
  fit.motions = motions_of(motion, recordings, found);
  fit.contradicted =
      contradicted_numbers(motion, start, options.free.locked, found.best.interval, recordings.front().source);
  fit.delay = given_delay_of(motion, found.best, limit, range->instants);
  fit.fitted_share = fitted_share(motion.evidence->segments(), start.records);
  fit.force_has_one_size = has_one_size(start.records);
  return fit;
}

/// Whether the records ask for another value of a number that was given.
bool contradicts_given(const MotionFit& fit) {
  return !fit.contradicted.empty() || (fit.delay && contradicts(*fit.delay));
}

/// Whether linear motion is what is left most clearly, and no given number makes it.
bool lacks_motion(const MotionFit& fit) {
  return stands_out(fit.omnibus) && fit.omnibus.clearest == Omnibus::Kind::follows_force && !contradicts_given(fit);
}

/// Whether no number is farther from what was believed of it than chance is.
bool are_believed(const std::vector<Number>& numbers, const Eigen::VectorXd& z) {
  constexpr double most_deviations = 4.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double off = z(static_cast<Eigen::Index>(i)) - numbers[i].expected;
    if (std::abs(off) > most_deviations * numbers[i].prior_deviation) return false;
  }
  return true;
}

/// Whether it is a device whose limit its records tell, and leaves nothing that stands out.
bool is_whole(const MotionFit& fit) {
  return !find_problem(fit.found.device) && told_limit(fit.found.best.interval) && !stands_out(fit.omnibus) &&
         !contradicts_given(fit);
}

/// The fit with one more body, where that is a mode of believed numbers, and explains what is left.
std::optional<MotionFit> fit_with_further_body(std::span<const Recording> recordings, const FrequencyResponse& response,
                                               const Device& structure, MotionFitOptions options) {
  const auto further = with_further_body(structure, options.free, response);
  if (!further) return std::nullopt;
  options.free = further->free;
  const auto is_wanted = [&](const std::vector<Number>& numbers, const Eigen::VectorXd& z, const DeviceParameters& at) {
    return are_believed(numbers, z) && is_mode(at, response);
  };
  try {
    auto played = played_records(recordings, response, further->structure, options);
    if (!played) return std::nullopt;
    const auto& [start, motion] = *played;
    // Before its limit is asked, which takes as long again.
    if (!is_wanted(motion.model->numbers(), motion.best.z, motion.model->family().device_at(motion.best.z)))
      return std::nullopt;
    auto fit = fit_of(*std::move(played), recordings, options);
    if (!fit || !is_whole(*fit)) return std::nullopt;
    const FoundDevice& found = fit->found;
    if (!is_wanted(found.best.numbers, found.best.x, found.device)) return std::nullopt;
    fit->further_body = further_body_fitted(found.device);
    return fit;
  } catch (const Error&) {  // no such device can be fitted
    return std::nullopt;
  }
}

}  // namespace

std::optional<MotionFit> fit_motion(std::span<const Recording> recordings, const FrequencyResponse& response,
                                    const Device& structure, const MotionFitOptions& options) {
  auto played = played_records(recordings, response, structure, options);
  if (!played) return std::nullopt;
  auto fit = fit_of(*std::move(played), recordings, options);
  if (!fit || !lacks_motion(*fit)) return fit;
  auto other = fit_with_further_body(recordings, response, structure, options);
  return other ? std::move(other) : std::move(fit);
}

}  // namespace zwidth::internal
