#include "identification/motion_search.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/model/number_keys.hpp"
#include "identification/motion_segments.hpp"
#include "identification/search_starts.hpp"
#include "identification/verdict/profile.hpp"
#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

constexpr double short_segment = 0.5;              // s
constexpr std::size_t most_samples_whole = 30000;  // of long records evenly spread segments are fitted
constexpr std::size_t most_samples_near = 8000;    // tell the numbers roughly
constexpr int coarse_substeps = 1;                 // of a sampling period, where terms act
constexpr int fine_substeps = 2;
constexpr int most_substeps = 8;  // where a body rubs: until finer ones move no number of the device
constexpr MinimiseOptions coarse{.most_steps = 20, .least_gain = 2.0};
constexpr MinimiseOptions between{.most_steps = 25, .least_gain = 0.5};  // the noise is not the last
constexpr MinimiseOptions fine{.most_steps = 25, .least_gain = 0.1};

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

/// Where the records whole may begin: an end of the search in short segments.
struct Beginning {
  double innovations = 0.0;
  Minimum end;
};

/// The records whole, with so many substeps of a sampling period, and the most likely numbers so far.
struct Whole {
  std::unique_ptr<MotionModel> model;
  std::unique_ptr<RecordSearch> search;
  std::optional<Minimum> best = {};
};

/// Its likelihood under the noise that it has now: a best that was found under another one is pictured again. Nothing without a
/// best, or a picture of it.
std::optional<FoundMotion> found_motion_of(Whole whole) {
  if (!whole.best) return std::nullopt;
  FoundMotion found{std::move(whole.model), whole.search->take_evidence(), whole.search->take_likelihood(),
                    *std::move(whole.best)};
  if (found.likelihood->cost(found.best.z) == found.best.picture.cost) return found;
  auto picture = found.likelihood->picture(found.best.z);
  if (!picture) return std::nullopt;
  found.best.picture = *std::move(picture);
  return found;
}

/// The search from the linear fit of the response, stage by stage.
class StagedSearch {
 public:
  StagedSearch(const MotionStart& start, const std::vector<std::string>& locked, const std::vector<Segment>& segments,
               const BesideRecords& beside)
      : start_(start),
        segments_(segments),
        beside_(beside),
        family_(start.device, start.parts.numbers, locked),
        linear_(family_.coordinates_of(start.device)),
        first_terms_(without_link_frictions(start.parts.terms)),
        near_model_(family_, first_terms_, start.records, coarse_substeps),
        near_(near_model_,
              thinned(segments_of(start.records, short_segment), thinning(start.records, most_samples_near), segments),
              start, beside) {}

  [[nodiscard]] std::optional<FoundMotion> found() {
    Whole whole = most_likely_of(beginnings());
    if (whole.best) try_link_frictions(whole);
    if (whole.best) make_finer(whole);
    return found_motion_of(std::move(whole));
  }

 private:
  [[nodiscard]] Whole whole_at(int substeps, const MotionTerms& terms) const {
    Whole made;
    made.model = std::make_unique<MotionModel>(family_, terms, start_.records, substeps);
    made.search = std::make_unique<RecordSearch>(*made.model, segments_, start_, beside_);
    return made;
  }

  /// Ends in short segments, the likeliest first. The linear device begins under the noise of the encoder: nothing large passes for
  /// that, and the search goes far. Friction and lag begin under the noise of what they leave: it goes no farther than it must.
  [[nodiscard]] std::vector<Beginning> beginnings() {
    constexpr double frictions[] = {0.0, 0.2, 0.05};  // of the force
    const std::string& rubbing = start_.device.bodies[start_.device.loop.actuated].name;
    std::vector<Beginning> ends;
    bool is_rough = false;  // without friction at its start either
    for (const double share : frictions) {
      // Between the first two: not where the first is likelier, and smooth.
      if (ends.size() == 2 && !is_rough && ends[0].innovations < ends[1].innovations) break;
      near_.take_first_noise();
      const bool is_linear = share == 0.0;
      const Eigen::VectorXd x = is_linear ? linear_ : with_friction_and_lag(linear_, near_model_, rubbing, share);
      const Eigen::VectorXd z = near_.with_states(x);
      if (!is_linear && !near_.take_noise(z)) continue;
      auto end = near_.from(z, 2, coarse);
      if (!end || !near_.take_noise(end->z)) continue;
      if (is_linear) is_rough = rubs(near_model_, *end);
      const double innovations = near_.innovations();
      const bool is_one_of_them = std::ranges::any_of(ends, [&](const Beginning& each) {
        return std::abs(each.innovations - innovations) < coarse.least_gain &&
               !has_moved(near_model_, each.end, *end, 1.0);
      });
      if (is_one_of_them) break;  // what begins between the two ends there, too
      ends.push_back({innovations, *std::move(end)});
    }
    std::ranges::sort(ends, {}, &Beginning::innovations);
    return ends;
  }

  /// The end of the likeliest; where a body rubs, stops and starts make side minima: then of all, and the likeliest counts.
  [[nodiscard]] Whole most_likely_of(const std::vector<Beginning>& begins) const {
    constexpr int most_rounds = 6;
    Whole whole = whole_at(coarse_substeps, first_terms_);
    std::vector<Noise> noise;
    double least = 0.0;
    for (const Beginning& each : begins) {
      if (whole.best && !rubs(*whole.model, *whole.best)) break;
      bool joined = false;
      const auto followed = [&](const Eigen::VectorXd& z) -> std::optional<Minimum> {
        if (!whole.search->take_noise(z)) return std::nullopt;
        return whole.search->from(z, most_rounds, between, [&](const Minimum& here) {
          joined = whole.best && !has_moved(*whole.model, *whole.best, here);
          return joined;
        });
      };
      const Eigen::VectorXd z = whole.search->carried_over(near_, each.end.z);
      auto end = followed(z);
      if (!end) end = followed(without_forces(z, *whole.model, linear_));
      if (!end || joined || !whole.search->take_noise(end->z)) continue;
      if (whole.best && whole.search->innovations() >= least) continue;
      least = whole.search->innovations();
      noise = whole.search->evidence().noise();
      whole.best = std::move(end);
    }
    if (whole.best) whole.search->set_noise(noise);
    return whole;
  }

  /// The end from friction in links that do not ring, where it is likelier than that from `whole`.
  void try_link_frictions(Whole& whole) const {
    const auto rubbing = with_link_frictions(whole.best->z.head(linear_.size()), *whole.model);
    if (!rubbing) return;
    Whole next = whole_at(fine_substeps, start_.parts.terms);
    next.search->take_noise_of(*whole.search);
    const auto same = next.search->from(whole.best->z, 2, between);
    const bool can_stay = same && next.search->take_noise(same->z);
    const double staying = next.search->innovations();
    next.search->take_noise_of(*whole.search);
    next.best = next.search->from(next.search->with_states(*rubbing), 2, between);
    if (!next.best || !next.search->take_noise(next.best->z)) return;
    if (!can_stay || next.search->innovations() < staying) whole = std::move(next);
  }

  /// Terms over halves of a sampling period, and where a body rubs over finer substeps until they move no number of the device.
  void make_finer(Whole& whole) const {
    for (int finer = fine_substeps; finer <= most_substeps; finer *= 2) {
      if (finer > fine_substeps && !rubs(*whole.model, *whole.best)) break;
      Whole next = whole_at(finer, start_.parts.terms);
      next.search->take_noise_of(*whole.search);
      next.best = next.search->from(whole.best->z, 1, fine);
      if (!next.best) {
        if (finer == fine_substeps)
          whole.best.reset();  // whole sampling periods, and no friction of links, do for a start
        break;
      }
      const bool stands_still = !has_moved(*next.model, *whole.best, *next.best);
      if (!stands_still && next.search->take_noise(next.best->z)) next.best = next.search->from(next.best->z, 1, fine);
      if (!next.best) break;
      whole = std::move(next);
      if (stands_still && finer > fine_substeps) break;
    }
  }

  const MotionStart& start_;
  const std::vector<Segment>& segments_;
  const BesideRecords& beside_;
  DeviceFamily family_;
  Eigen::VectorXd linear_;
  MotionTerms first_terms_;
  MotionModel near_model_;
  RecordSearch near_;
};

/// From the structure itself, all that is free in it free, at the finest substeps.
std::optional<FoundMotion> from_structure(const MotionStart& start, const std::vector<std::string>& locked,
                                          const std::vector<Segment>& segments, const BesideRecords& beside) {
  constexpr int most_rounds = 4;
  const DeviceFamily family(start.device, start.parts.numbers, locked);
  Whole whole;
  whole.model = std::make_unique<MotionModel>(family, start.parts.terms, start.records, most_substeps);
  whole.search = std::make_unique<RecordSearch>(*whole.model, segments, start, beside);
  whole.search->take_first_noise();
  whole.best = whole.search->from(whole.search->with_states(of_known(*start.known, family)), most_rounds, fine);
  if (!whole.best || !whole.search->take_noise(whole.best->z)) return std::nullopt;
  return found_motion_of(std::move(whole));
}

}  // namespace

std::optional<FoundMotion> found_motion(const MotionStart& start, const std::vector<std::string>& locked,
                                        const MotionSearchOptions& options) {
  const std::size_t every = thinning(start.records, most_samples_whole);
  const std::vector<Segment> segments = thinned(segments_of(start.records, options.segment, every), every, {});
  auto found = StagedSearch(start, locked, segments, options.beside).found();
  if (!start.known || start.known->links.empty() || (found && !rubs(*found->model, found->best))) return found;
  auto known = from_structure(start, locked, segments, options.beside);
  const bool is_likelier = known && (!found || innovations_of(*known->evidence) < innovations_of(*found->evidence));
  return is_likelier ? std::move(known) : std::move(found);
}

}  // namespace zwidth::internal
