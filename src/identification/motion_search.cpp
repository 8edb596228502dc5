#include "identification/motion_search.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "identification/model/number_keys.hpp"
#include "identification/verdict/profile.hpp"
#include "linear_systems.hpp"
#include "model/loop_keys.hpp"

namespace zwidth::internal {
namespace {

constexpr Eigen::Index noise_order = 12;
constexpr double short_segment = 0.5;              // s
constexpr std::size_t left_out = 20;               // samples at a record's beginning, whose forces came before it
constexpr std::size_t most_samples_whole = 30000;  // of long records evenly spread segments are fitted
constexpr std::size_t most_samples_near = 8000;    // tell the numbers roughly
constexpr int coarse_substeps = 1;                 // of a sampling period, where terms act
constexpr int fine_substeps = 2;
constexpr int most_substeps = 8;  // where a body rubs: until finer ones move no number of the device

double rms_of(std::span<const double> samples) {
  double squares = 0.0;
  for (const double each : samples) squares += each * each;
  return std::sqrt(squares / static_cast<double>(samples.size()));
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

/// So many of them, evenly, that they hold no more than that; and those that others begin with.
std::vector<Segment> thinned(const std::vector<Segment>& all, std::size_t most_samples,
                             const std::vector<Segment>& others) {
  std::size_t samples = 0;
  for (const Segment& each : all) samples += each.count;
  const std::size_t every = (samples + most_samples - 1) / most_samples;
  std::vector<Segment> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool begins = std::ranges::any_of(
        others, [&](const Segment& other) { return other.record == all[i].record && other.first == all[i].first; });
    if (begins || i % every == 0) kept.push_back(all[i]);
  }
  return kept;
}

/// White, of a few steps of the encoder or a hundredth of what the position changes in a sample.
std::vector<Noise> first_noise(const MotionStart& start) {
  constexpr double of_step = 0.3;
  constexpr double of_change = 0.01;
  std::vector<Noise> noise;
  for (std::size_t record = 0; record < start.records.size(); ++record) {
    const std::span<const double> position = start.records[record].position;
    std::vector<double> changes(position.begin() + 1, position.end());
    for (std::size_t k = 0; k < changes.size(); ++k) changes[k] -= position[k];
    noise.push_back({.deviation = std::max(of_step * start.encoder_steps[record], of_change * rms_of(changes))});
  }
  return noise;
}

/// Of all samples: the logarithm of what one has that those before do not. Maximum likelihood makes it small.
double innovations_of(const TimeEvidence& evidence) {
  double sum = 0.0;
  for (const Segment& each : evidence.segments())
    sum += static_cast<double>(each.count) * std::log(evidence.noise()[each.record].deviation);
  return sum;
}

/// The records in segments as a likelihood, and a search in it.
class Search {
 public:
  Search(const MotionModel& model, std::vector<Segment> segments, const MotionStart& start,
         const MotionSearchOptions& options)
      : evidence_(std::make_shared<TimeEvidence>(model, std::move(segments), start.encoder_steps, noise_order)) {
    std::vector<std::shared_ptr<const LikelihoodTerm>> terms{evidence_};
    if (!options.limits.empty()) terms.push_back(std::make_shared<LimitEvidence>(model.family(), options.limits));
    all_ = std::make_unique<Likelihood>(model.numbers(), std::move(terms), options.tell);
  }

  [[nodiscard]] const Likelihood& likelihood() const { return *all_; }
  [[nodiscard]] const TimeEvidence& evidence() const { return *evidence_; }
  [[nodiscard]] std::unique_ptr<Likelihood> take_likelihood() { return std::move(all_); }
  [[nodiscard]] std::shared_ptr<TimeEvidence> take_evidence() { return std::move(evidence_); }
  void set_noise(std::vector<Noise> noise) { evidence_->set_noise(std::move(noise)); }

  /// A minimum, then others under the noise of its residuals, `rounds` at most, until that stands still, or the minimum is
  /// one that is known.
  [[nodiscard]] std::optional<Minimum> from(
      Eigen::VectorXd z, int rounds, MinimiseOptions options,
      const std::function<bool(const Minimum&)>& is_known = [](const Minimum&) { return false; }) {
    constexpr double still = 2e-3;  // of the noise, and of its effect on the limit less
    constexpr int later_steps = 6;  // the noise is not the last: no minimum under it is worth more
    options.residuals = rows();
    std::optional<Minimum> found;
    for (int round = 0; round < rounds; ++round) {
      const bool is_between = round > 0 && round + 1 < rounds;
      MinimiseOptions now = options;
      if (is_between) now.most_steps = std::min(options.most_steps, later_steps);
      found = minimise(*all_, std::move(z), now);
      if (!found) return std::nullopt;
      z = found->z;
      if (round == 0 && found->last_step.size() == 0) ++rounds;  // under a noise that lets none be made
      if (round + 1 == rounds || is_known(*found)) break;
      const double before = innovations();
      if (!take_noise(z)) return std::nullopt;
      const bool is_still = std::abs(innovations() - before) < still * rows();
      if (round > 1 && is_still && found->settled) break;
    }
    return found;
  }
  /// Segments' states that fit these numbers: the records' own make a start that no number mends.
  [[nodiscard]] Eigen::VectorXd with_states(const Eigen::VectorXd& x) const {
    Eigen::VectorXd z = all_->start(x);
    const auto fitted = minimise(*all_, z, {.most_steps = 3, .least_gain = 2.0, .held = x.size()});
    return fitted ? fitted->z : z;
  }
  /// That of the residuals at z.
  [[nodiscard]] bool take_noise(const Eigen::VectorXd& z) {
    const Eigen::Index numbers = evidence_->numbers();
    auto noise = evidence_->noise_at(z.head(numbers), z.tail(z.size() - numbers));
    if (!noise) return false;
    evidence_->set_noise(*std::move(noise));
    return true;
  }
  [[nodiscard]] double innovations() const { return innovations_of(*evidence_); }

 private:
  [[nodiscard]] double rows() const {
    double sum = 0.0;
    for (const Segment& each : evidence_->segments()) sum += static_cast<double>(each.count);
    return sum;
  }

  std::shared_ptr<TimeEvidence> evidence_;
  std::unique_ptr<Likelihood> all_;
};

/// The elements of z that are a segment's state.
auto state_of(Eigen::VectorXd& z, const MotionModel& model, std::size_t segment) {
  const auto numbers = static_cast<Eigen::Index>(model.numbers().size());
  return z.segment(numbers + static_cast<Eigen::Index>(segment) * model.states(), model.states());
}

/// The numbers of `end`, and its states where a segment of `to` begins as one of `from` does.
Eigen::VectorXd carried_over(const Search& from, Eigen::VectorXd end, const Search& to, const MotionModel& model) {
  Eigen::VectorXd z = to.likelihood().start(end.head(static_cast<Eigen::Index>(model.numbers().size())));
  for (std::size_t i = 0; i < to.evidence().segments().size(); ++i) {
    for (std::size_t j = 0; j < from.evidence().segments().size(); ++j) {
      const Segment& here = to.evidence().segments()[i];
      const Segment& there = from.evidence().segments()[j];
      if (here.record == there.record && here.first == there.first) state_of(z, model, i) = state_of(end, model, j);
    }
  }
  return z;
}

/// x of the linear device with so much friction, of the force, the less damping for it, and half its lateness as lag: either alone
/// is a side minimum where the other is.
Eigen::VectorXd with_friction_and_lag(Eigen::VectorXd x, const MotionModel& model, const std::string& body,
                                      double share) {
  constexpr double damping_beside = 0.3;  // of the linear fit's, which has the friction in it
  constexpr double of_lateness = 0.5;
  double lateness = 0.0;
  for (std::size_t i = 0; i < model.numbers().size(); ++i) {
    const Number& number = model.numbers()[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (number.key == friction_key(body)) x(at) = share;
    if (number.key.starts_with("body.") && number.key.ends_with(".damping")) x(at) *= damping_beside;
    if (number.key == key_of_delay) lateness = number.value(x(at));  // lag and all
  }
  for (std::size_t i = 0; i < model.numbers().size(); ++i) {
    const Number& number = model.numbers()[i];
    if (number.key == key_of_lag) x(static_cast<Eigen::Index>(i)) = number.coordinate(of_lateness * lateness);
  }
  return x;
}

/// x with friction in the links that do not ring and half their damping: in these either may stand for the other, and a search from
/// one does not reach the other. Nothing where there is no such link.
std::optional<Eigen::VectorXd> with_link_frictions(Eigen::VectorXd x, const MotionModel& model) {
  constexpr double share = 0.2;  // of the force
  constexpr double damping_beside = 0.5;
  const DeviceParameters device = model.family().device_at(x);
  const auto rings = [&](const Link& link) {
    const double first = device.bodies[link.first].mass;
    const double second = device.bodies[link.second].mass;
    constexpr double least_quality = 2.0;
    return link.stiffness * first * second / (first + second) > std::pow(least_quality * link.damping, 2);
  };
  const auto element = [&](const std::string& key) {
    const auto number = std::ranges::find(model.numbers(), key, &Number::key);
    return number == model.numbers().end() ? nullptr : &x(number - model.numbers().begin());
  };
  bool has_any = false;
  for (std::size_t i = 0; i < device.links.size(); ++i) {
    double* const friction = element(link_friction_key(i));
    double* const damping = element("link." + std::to_string(i) + ".damping");
    if (friction == nullptr || damping == nullptr || rings(device.links[i])) continue;
    *friction = share;
    *damping *= damping_beside;
    has_any = true;
  }
  return has_any ? std::optional(std::move(x)) : std::nullopt;
}

/// z with forces of either sign as the linear device has them: short segments tell them badly, and over long ones a spring that
/// softens drives a body out of all bounds.
Eigen::VectorXd without_forces(Eigen::VectorXd z, const MotionModel& model, const Eigen::VectorXd& linear) {
  for (Eigen::Index i = model.family().of_device(); i < linear.size(); ++i) {
    if (model.numbers()[static_cast<std::size_t>(i)].scale == Number::Scale::any) z(i) = linear(i);
  }
  return z;
}

/// Whether a body rubs as the record tells: friction within its noise makes no stops and starts that a fit could miss.
bool rubs(const MotionModel& model, const Minimum& found) {
  constexpr double least = 1e-3;  // of the force: less moves no limit
  constexpr double clear = 4.0;   // of chi squared, of all frictions at once: one may stand for another
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < model.numbers().size(); ++i) {
    if (body_of_friction(model.numbers()[i].key)) places.push_back(static_cast<Eigen::Index>(i));
  }
  const Eigen::VectorXd frictions = found.z(places);
  if (!(frictions.array() > least).any()) return false;
  const Eigen::MatrixXd covariance = covariance_of(found.picture.hessian)(places, places);
  return frictions.dot(solve_symmetric(covariance, frictions)) > clear;
}

/// Whether numbers of the device differ by more than a part of a deviation.
bool has_moved(const MotionModel& model, const Minimum& from, const Minimum& to, double notable = 0.25) {
  const Eigen::Index count = model.family().of_device();
  const Eigen::VectorXd deviations = covariance_of(from.picture.hessian).diagonal().cwiseMax(0.0).cwiseSqrt();
  return ((to.z - from.z).head(count).array().abs() > notable * deviations.head(count).array()).any();
}

/// Without what rubs between two bodies: a link's damping stands for it until the rest is found.
MotionTerms without_link_frictions(MotionTerms terms) {
  std::erase_if(terms.frictions, [](const FrictionTerm& friction) { return friction.against.has_value(); });
  return terms;
}

/// Where the records whole may begin.
struct Beginning {
  double innovations = 0.0;  ///< of what is near
  std::vector<Noise> noise;
  Minimum near;
};

/// The records whole, with so many substeps of a sampling period.
struct Whole {
  std::unique_ptr<MotionModel> model;
  std::unique_ptr<Search> search;
};

/// From the linear fit of the response, with several frictions.
std::optional<FoundMotion> searched(const MotionStart& start, const std::vector<std::string>& locked,
                                    const std::vector<Segment>& long_ones, const MotionSearchOptions& options) {
  constexpr double frictions[] = {0.0, 0.2, 0.05};  // of the force
  constexpr int most_rounds = 6;
  constexpr MinimiseOptions coarse{.most_steps = 20, .least_gain = 2.0};
  constexpr MinimiseOptions between{.most_steps = 25, .least_gain = 0.5};  // the noise is not the last
  constexpr MinimiseOptions fine{.most_steps = 25, .least_gain = 0.1};
  const ModelParts& parts = start.parts;
  const DeviceFamily family(start.device, parts.numbers, locked);
  const MotionTerms first_terms = without_link_frictions(parts.terms);
  const auto whole_at = [&](int substeps, const MotionTerms& terms) {
    Whole made;
    made.model = std::make_unique<MotionModel>(family, terms, start.records, substeps);
    made.search = std::make_unique<Search>(*made.model, long_ones, start, options);
    return made;
  };
  const MotionModel coarse_model(family, first_terms, start.records, coarse_substeps);
  const std::vector<Segment> short_ones =
      thinned(segments_of(start.records, short_segment), most_samples_near, long_ones);
  Search near(coarse_model, short_ones, start, options);
  Whole whole = whole_at(coarse_substeps, first_terms);

  const Eigen::VectorXd linear = family.coordinates_of(start.device);
  const std::string& rubbing = start.device.bodies[start.device.loop.actuated].name;
  std::vector<Beginning> begins;
  bool is_rough = false;  // without friction at its start either
  for (const double share : frictions) {
    // Between the first two: not where the first is likelier, and smooth.
    if (begins.size() == 2 && !is_rough && begins[0].innovations < begins[1].innovations) break;
    near.set_noise(first_noise(start));
    const Eigen::VectorXd x = share > 0.0 ? with_friction_and_lag(linear, coarse_model, rubbing, share) : linear;
    const Eigen::VectorXd z = near.with_states(x);
    if (share > 0.0 && !near.take_noise(z)) continue;
    auto end = near.from(z, 2, coarse);
    if (!end || !near.take_noise(end->z)) continue;
    if (share == 0.0) is_rough = rubs(coarse_model, *end);
    const double innovations = near.innovations();
    const bool is_known = std::ranges::any_of(begins, [&](const Beginning& each) {
      return std::abs(each.innovations - innovations) < coarse.least_gain &&
             !has_moved(coarse_model, each.near, *end, 1.0);
    });
    if (is_known) break;  // what begins between the two ends there, too
    begins.push_back({innovations, near.evidence().noise(), *std::move(end)});
  }
  std::ranges::sort(begins, {}, &Beginning::innovations);
  // Where a body rubs, stops and starts make side minima: then all are followed, and the most likely end counts.
  std::optional<Minimum> best;
  std::vector<Noise> noise;
  double least = 0.0;
  for (const Beginning& each : begins) {
    if (best && !rubs(*whole.model, *best)) break;
    bool joined = false;
    const auto followed = [&](const Eigen::VectorXd& z) {
      whole.search->set_noise(each.noise);
      if (!whole.search->take_noise(z)) return std::optional<Minimum>();
      return whole.search->from(z, most_rounds, between, [&](const Minimum& here) {
        joined = best && !has_moved(*whole.model, *best, here);
        return joined;
      });
    };
    const Eigen::VectorXd z = carried_over(near, each.near.z, *whole.search, coarse_model);
    auto end = followed(z);
    if (!end) end = followed(without_forces(z, *whole.model, linear));
    if (!end || joined || !whole.search->take_noise(end->z) || (best && whole.search->innovations() >= least)) continue;
    least = whole.search->innovations();
    noise = whole.search->evidence().noise();
    best = std::move(end);
  }
  if (!best) return std::nullopt;
  whole.search->set_noise(noise);
  if (const auto rubbing_links = with_link_frictions(best->z.head(linear.size()), *whole.model)) {
    Whole next = whole_at(fine_substeps, parts.terms);
    next.search->set_noise(noise);
    const auto same = next.search->from(best->z, 2, between);
    const bool is_known = same && next.search->take_noise(same->z);
    const double known = next.search->innovations();
    next.search->set_noise(noise);
    auto other = next.search->from(next.search->with_states(*rubbing_links), 2, between);
    if (other && next.search->take_noise(other->z) && (!is_known || next.search->innovations() < known)) {
      best = std::move(other);
      whole = std::move(next);
    }
  }
  for (int finer = fine_substeps; finer <= most_substeps && (finer == fine_substeps || rubs(*whole.model, *best));
       finer *= 2) {
    Whole next = whole_at(finer, parts.terms);
    next.search->set_noise(whole.search->evidence().noise());
    auto again = next.search->from(best->z, 1, fine);
    if (!again) break;
    const bool stands_still = !has_moved(*next.model, *best, *again);
    if (!stands_still && next.search->take_noise(again->z)) again = next.search->from(again->z, 1, fine);
    if (!again) break;
    best = std::move(again);
    whole = std::move(next);
    if (stands_still && finer > fine_substeps) break;
  }
  return FoundMotion{std::move(whole.model), whole.search->take_evidence(), whole.search->take_likelihood(),
                     *std::move(best)};
}

/// From the structure itself, all that is free in it free, at the finest substeps.
std::optional<FoundMotion> from_structure(const MotionStart& start, const std::vector<std::string>& locked,
                                          const std::vector<Segment>& segments, const MotionSearchOptions& options) {
  constexpr int most_rounds = 4;
  constexpr MinimiseOptions fine{.most_steps = 25, .least_gain = 0.1};
  const DeviceFamily family(start.device, start.parts.numbers, locked);
  auto model = std::make_unique<MotionModel>(family, start.parts.terms, start.records, most_substeps);
  Search search(*model, segments, start, options);
  search.set_noise(first_noise(start));
  Eigen::VectorXd x = family.coordinates_of(*start.known);
  x.tail(x.size() - family.of_device()).setZero();  // but for its friction no rival is the structure's
  for (const Body& body : start.known->bodies) {
    const auto place = std::ranges::find(family.numbers(), friction_key(body.name), &Number::key);
    if (place != family.numbers().end()) x(place - family.numbers().begin()) = place->coordinate(body.coulomb);
  }
  auto best = search.from(search.with_states(x), most_rounds, fine);
  if (!best || !search.take_noise(best->z)) return std::nullopt;
  return FoundMotion{std::move(model), search.take_evidence(), search.take_likelihood(), *std::move(best)};
}

}  // namespace

std::optional<FoundMotion> found_motion(const MotionStart& start, const std::vector<std::string>& locked,
                                        const MotionSearchOptions& options) {
  const std::vector<Segment> segments = thinned(segments_of(start.records, options.segment), most_samples_whole, {});
  auto found = searched(start, locked, segments, options);
  if (!start.known || start.known->links.empty() || (found && !rubs(*found->model, found->best))) return found;
  auto known = from_structure(start, locked, segments, options);
  const bool is_likelier = known && (!found || innovations_of(*known->evidence) < innovations_of(*found->evidence));
  return is_likelier ? std::move(known) : std::move(found);
}

}  // namespace zwidth::internal
