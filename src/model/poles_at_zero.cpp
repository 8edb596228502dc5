#include "model/poles_at_zero.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "model/normal_coordinates.hpp"

namespace zwidth::internal {
namespace {

// Bodies in sets that hold together; ground is body n. Each set is named by its lowest member.
class Sets {
 public:
  explicit Sets(std::size_t bodies) : of_(bodies + 1) { std::iota(of_.begin(), of_.end(), std::size_t{0}); }

  void join(std::size_t a, std::size_t b) {
    const std::size_t low = std::min(of_[a], of_[b]);
    const std::size_t high = std::max(of_[a], of_[b]);
    std::replace(of_.begin(), of_.end(), high, low);
  }
  [[nodiscard]] bool together(std::size_t a, std::size_t b) const { return of_[a] == of_[b]; }
  [[nodiscard]] bool grounded(std::size_t body) const { return of_[body] == of_.back(); }
  [[nodiscard]] std::size_t off_ground() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 1 < of_.size(); ++i)
      if (of_[i] == i && !grounded(i)) ++count;
    return count;
  }

 private:
  std::vector<std::size_t> of_;
};

Sets joined_by_springs(const Device& device) {
  const std::size_t n = device.bodies().size();
  Sets sets(n);
  for (std::size_t i = 0; i < n; ++i)
    if (device.bodies()[i].stiffness > 0.0) sets.join(i, n);
  if (device.parameters().user.stiffness > 0.0) sets.join(device.loop().held, n);
  for (const Link& link : device.links())
    if (link.stiffness > 0.0) sets.join(link.first, link.second);
  return sets;
}

void join_by_dampers_to_ground(const Device& device, Sets& sets) {
  const std::size_t n = device.bodies().size();
  for (std::size_t i = 0; i < n; ++i)
    if (device.bodies()[i].damping > 0.0) sets.join(i, n);
  if (device.parameters().user.damping > 0.0) sets.join(device.loop().held, n);
}

}  // namespace

std::size_t poles_at_zero(const Device& device) {
  if (!device.has_bodies()) {
    const NormalCoordinates normal = normal_coordinates(device);
    return static_cast<std::size_t>(normal.free + normal.loose);
  }
  Sets sets = joined_by_springs(device);
  const std::size_t without_spring = sets.off_ground();
  join_by_dampers_to_ground(device, sets);
  for (const Link& link : device.links())
    if (link.damping > 0.0) sets.join(link.first, link.second);
  return without_spring + sets.off_ground();
}

// Slowly, sets off ground are held by dampers alone and what a spring ties to ground
// stands still: x = D^-1 f / s, where D^-1 has an entry only between sets that dampers join without passing ground.
// One pole then, two where no damper ties those sets to ground; every other one is cancelled by a zero.
std::size_t poles_at_zero_seen(const Device& device, const WeightedPath& path) {
  if (!device.has_bodies()) return poles_at_zero_seen(normal_coordinates(device), path.force_at, path.position_of);
  const std::size_t force_at = path.force_at.front().of;
  const std::size_t position_of = path.position_of.front().of;
  const Sets springs = joined_by_springs(device);
  if (springs.grounded(force_at) || springs.grounded(position_of)) return 0;
  Sets sets = springs;
  for (const Link& link : device.links()) {
    if (link.damping > 0.0 && !springs.grounded(link.first) && !springs.grounded(link.second)) {
      sets.join(link.first, link.second);
    }
  }
  if (!sets.together(force_at, position_of)) return 0;
  for (const Link& link : device.links())
    if (link.damping > 0.0) sets.join(link.first, link.second);
  join_by_dampers_to_ground(device, sets);
  return sets.grounded(force_at) ? 1 : 2;
}

void cancel_at_zero(ModalForm& form, std::size_t seen) {
  for (ModalTerm& term : form.terms) {
    const auto poles = static_cast<std::size_t>(term.integrators);
    if (poles <= seen) continue;
    const std::size_t cancelled = poles - seen;
    if (cancelled == term.degree) {  // nothing is left of the term
      std::fill_n(term.numerator, term.degree, 0.0);
      std::fill_n(term.numerator_rest, term.degree, 0.0);
      continue;
    }
    term.integrators = static_cast<int>(seen);
    for (double* c : {term.numerator, term.denominator, term.numerator_rest, term.denominator_rest}) {
      std::copy(c + cancelled, c + term.degree, c);
      std::fill(c + term.degree - cancelled, c + term.degree, 0.0);
    }
    term.degree -= cancelled;
  }
}

}  // namespace zwidth::internal
