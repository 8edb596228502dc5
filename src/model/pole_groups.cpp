#include "model/pole_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using ComplexX = Complex<Extended>;

bool close(const ComplexX& a, const ComplexX& b) { return magnitude(a - b) <= cluster_tolerance * magnitude(a); }

// Below these the double-double iteration's rounding stands where an exact zero should.
constexpr double real_below = 1e-15;
constexpr double undamped_below = 1e-19;

// Exact conjugate symmetry: real poles and the half with positive imaginary part.
void make_symmetric(const std::vector<ComplexX>& poles, std::vector<ComplexX>& real, std::vector<ComplexX>& upper) {
  std::size_t lower = 0;
  for (const ComplexX& pole : poles) {
    const double size = magnitude(pole);
    if (std::abs(leading(pole.im)) <= real_below * size) {
      real.emplace_back(pole.re);
    } else if (leading(pole.im) > 0.0) {
      upper.push_back(pole);
      if (std::abs(leading(pole.re)) <= undamped_below * size) upper.back().re = Extended(0.0);
    } else {
      ++lower;
    }
  }
  if (lower != upper.size()) {
    throw Error(ErrorCode::did_not_converge, "the poles of the device could not be found: its values are too extreme");
  }
}

Mode mode_of(const PoleGroup& group) {
  const ComplexX& first = group.poles.front();
  if (group.poles.size() == 2 && !group.cluster) {  // a pair of real poles, or nearly real ones
    const double product = leading((first * group.poles[1]).re);
    const double sum = leading((first + group.poles[1]).re);
    const double frequency = std::sqrt(std::abs(product));
    return {frequency, frequency > 0.0 ? -sum / (2.0 * frequency) : 0.0};
  }
  const double frequency = magnitude(first);
  return {frequency, frequency > 0.0 ? -leading(first.re) / frequency : 0.0};
}

// The single real pole nearest to -b/m; the smallest one where b/m is not known. None: real.size().
std::size_t rigid_partner(const std::vector<ComplexX>& real, const PoleLabels& labels) {
  std::size_t best = real.size();
  double best_distance = 0.0;
  for (std::size_t i = 0; i < real.size(); ++i) {
    const double size = magnitude(real[i]);
    const double distance = labels.rigid_pole > 0.0 ? std::abs(std::log(size / labels.rigid_pole)) : size;
    if (best == real.size() || distance < best_distance) {
      best = i;
      best_distance = distance;
    }
  }
  return best;
}

// Connected components of "closer than cluster_tolerance".
std::vector<std::vector<std::size_t>> components(const std::vector<ComplexX>& poles) {
  std::vector<std::size_t> label(poles.size());
  std::iota(label.begin(), label.end(), std::size_t{0});
  for (std::size_t i = 0; i < poles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (label[i] != label[j] && close(poles[i], poles[j])) {
        const std::size_t from = label[i];
        const std::size_t to = label[j];
        std::replace(label.begin(), label.end(), from, to);
      }
    }
  }
  std::vector<std::vector<std::size_t>> result;
  for (std::size_t root = 0; root < poles.size(); ++root) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < poles.size(); ++i)
      if (label[i] == root) members.push_back(i);
    if (!members.empty()) result.push_back(std::move(members));
  }
  return result;
}

}  // namespace

std::vector<PoleGroup> group_poles(std::vector<ComplexX>& poles, std::size_t zero_roots, const PoleLabels& labels,
                                   ModalForm& form) {
  std::vector<ComplexX> real;
  std::vector<ComplexX> upper;
  make_symmetric(poles, real, upper);

  // All poles that may coincide: real ones, upper ones, and the conjugates of those near the real axis.
  std::vector<ComplexX> candidates = real;
  for (const ComplexX& pole : upper) {
    candidates.push_back(pole);
    if (close(pole, conj(pole))) candidates.push_back(conj(pole));
  }
  std::vector<PoleGroup> groups;
  std::vector<ComplexX> single_real;
  for (const std::vector<std::size_t>& members : components(candidates)) {
    PoleGroup group;
    for (std::size_t i : members) group.poles.push_back(candidates[i]);
    const ComplexX& first = group.poles.front();
    group.closed = close(first, conj(first));
    if (group.closed && group.poles.size() == 1) {
      single_real.push_back(first);
      continue;
    }
    group.cluster = group.poles.size() > (group.closed ? 2U : 1U);
    groups.push_back(std::move(group));
  }

  PoleGroup rigid;
  rigid.poles.assign(zero_roots, ComplexX());
  rigid.cluster = zero_roots > 2;
  if (zero_roots == 1) {
    const std::size_t partner = rigid_partner(single_real, labels);
    if (partner < single_real.size()) {
      rigid.poles.push_back(single_real[partner]);
      single_real.erase(single_real.begin() + static_cast<std::ptrdiff_t>(partner));
    }
  }
  std::sort(single_real.begin(), single_real.end(),
            [](const ComplexX& a, const ComplexX& b) { return magnitude(a) < magnitude(b); });
  for (std::size_t i = 0; i < single_real.size(); i += 2) {
    PoleGroup group;
    group.poles.push_back(single_real[i]);
    if (i + 1 < single_real.size()) group.poles.push_back(single_real[i + 1]);
    groups.push_back(std::move(group));
  }

  std::sort(groups.begin(), groups.end(),
            [](const PoleGroup& a, const PoleGroup& b) { return mode_of(a).frequency < mode_of(b).frequency; });
  bool lowest = true;
  for (PoleGroup& group : groups) {
    const bool vibrates = !group.closed || (labels.has_bodies && group.poles.size() > 1);
    if (!vibrates) continue;  // mode 0: with the rigid body
    if (lowest && labels.lowest_mode_is_rigid) {
      form.suspended_rigid_body = mode_of(group);
    } else {
      group.mode = static_cast<int>(form.modes.size()) + 1;
      const std::size_t copies = group.cluster ? group.poles.size() / (group.closed ? 2 : 1) : 1;
      form.modes.insert(form.modes.end(), copies, mode_of(group));
    }
    lowest = false;
  }
  if (!rigid.poles.empty()) groups.insert(groups.begin(), std::move(rigid));

  poles = real;
  for (const ComplexX& pole : upper) {
    poles.push_back(pole);
    poles.push_back(conj(pole));
  }
  poles.insert(poles.end(), zero_roots, ComplexX());
  return groups;
}

void add_lag_pole(std::vector<PoleGroup>& groups, const ComplexX& pole) {
  PoleGroup own;
  own.mode = -1;
  for (PoleGroup& group : groups) {
    if (!group.closed) continue;
    for (std::size_t i = 0; i < group.poles.size(); ++i) {
      if (!close(pole, group.poles[i])) continue;
      own.mode = group.mode;
      if (group.cluster || close(group.poles.front(), group.poles.back())) {  // all of them lie here
        group.poles.push_back(pole);
        group.cluster = group.poles.size() > 2;
        return;
      }
      own.poles.push_back(group.poles[i]);
      group.poles.erase(group.poles.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    if (!own.poles.empty()) break;
  }
  own.poles.push_back(pole);
  groups.push_back(std::move(own));
}

}  // namespace zwidth
