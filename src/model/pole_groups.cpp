#include "model/pole_groups.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using ComplexX = Complex<Extended>;

// A cluster takes in poles until the next one is this many times its radius away.
constexpr double isolated_beyond = 8.0;
// Real poles gather sooner: three or four of them lose digits with the square or cube of their distance.
constexpr double real_cluster_tolerance = 1e-2;

struct Disc {
  ComplexX center;
  double radius = 0.0;
};

Disc disc_of(const std::vector<ComplexX>& poles) {
  Disc disc;
  for (const ComplexX& pole : poles) disc.center += pole;
  disc.center = disc.center * (Extended(1.0) / Extended(static_cast<double>(poles.size())));
  for (const ComplexX& pole : poles) disc.radius = std::max(disc.radius, magnitude(pole - disc.center));
  return disc;
}

// Sets of poles that lie together, each in one set: poles closer than cluster_tolerance, and whatever is so near to
// such a set that a circle could not separate it.
std::vector<std::vector<ComplexX>> gather(const std::vector<ComplexX>& poles) {
  std::vector<std::vector<ComplexX>> sets;
  sets.reserve(poles.size());
  for (const ComplexX& pole : poles) sets.push_back({pole});
  bool merged = true;
  while (merged) {
    merged = false;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const Disc disc = disc_of(sets[i]);
      const bool real = std::abs(leading(disc.center.im)) <= real_cluster_tolerance * magnitude(disc.center);
      const double tolerance = real ? real_cluster_tolerance : cluster_tolerance;
      const double reach = std::max(tolerance * magnitude(disc.center), isolated_beyond * disc.radius);
      for (std::size_t j = 0; j < sets.size(); ++j) {
        if (j == i) continue;
        const bool near = std::any_of(sets[j].begin(), sets[j].end(),
                                      [&](const ComplexX& pole) { return magnitude(pole - disc.center) <= reach; });
        if (!near) continue;
        sets[i].insert(sets[i].end(), sets[j].begin(), sets[j].end());
        sets.erase(sets.begin() + static_cast<std::ptrdiff_t>(j));
        merged = true;
        break;
      }
      if (merged) break;
    }
  }
  return sets;
}

Mode mode_of(const PoleGroup& group) {
  const ComplexX& first = group.poles.front();
  if (group.poles.size() == 2 && group.closed) {
    const double product = leading((first * group.poles[1]).re);
    const double sum = leading((first + group.poles[1]).re);
    const double frequency = std::sqrt(std::abs(product));
    return {frequency, frequency > 0.0 ? -sum / (2.0 * frequency) : 0.0};
  }
  const double frequency = magnitude(first);
  const double ratio = frequency > 0.0 ? -leading(first.re) / frequency : 0.0;
  return {frequency, std::abs(ratio) > undamped_below ? ratio : 0.0};
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

}  // namespace

std::vector<PoleGroup> group_poles(std::vector<ComplexX>& poles, std::size_t zero_roots, const PoleLabels& labels,
                                   ModalForm& form) {
  // Sets near the real axis are their own conjugates; of the others the upper one stands for both.
  std::vector<PoleGroup> groups;
  std::vector<ComplexX> single_real;
  std::vector<ComplexX> symmetric;
  std::size_t upper = 0;
  std::size_t lower = 0;
  for (std::vector<ComplexX>& set : gather(poles)) {
    const Disc disc = disc_of(set);
    const double height = leading(disc.center.im);
    if (std::abs(height) <= std::max(disc.radius, 1e-15 * magnitude(disc.center))) {
      if (set.size() == 1) {
        single_real.emplace_back(set.front().re);
        symmetric.push_back(single_real.back());
        continue;
      }
      symmetric.insert(symmetric.end(), set.begin(), set.end());
      const bool cluster = set.size() > 2 || disc.radius <= cluster_tolerance * magnitude(disc.center);
      groups.push_back({std::move(set), true, cluster, 0});
    } else if (height < 0.0) {
      lower += set.size();
    } else {
      upper += set.size();
      if (set.size() == 1 && std::abs(leading(set.front().re)) <= undamped_below * magnitude(set.front())) {
        set.front().re = Extended(0.0);
      }
      for (const ComplexX& pole : set) {
        symmetric.push_back(pole);
        symmetric.push_back(conj(pole));
      }
      const bool cluster = set.size() > 1;
      groups.push_back({std::move(set), false, cluster, 0});
    }
  }
  if (lower != upper) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_found});
  }

  PoleGroup rigid;
  rigid.poles.assign(zero_roots, ComplexX());
  const bool several = labels.rigid_poles > 1 || (labels.rigid_poles == 1 && zero_roots != 1);
  if (zero_roots == 1 && !several) {
    const std::size_t partner = rigid_partner(single_real, labels);
    if (partner < single_real.size()) {
      rigid.poles.push_back(single_real[partner]);
      single_real.erase(single_real.begin() + static_cast<std::ptrdiff_t>(partner));
    }
  }
  std::sort(single_real.begin(), single_real.end(),
            [](const ComplexX& a, const ComplexX& b) { return magnitude(a) < magnitude(b); });
  if (several) {  // in one term with the poles at zero: apart they would cancel
    const auto end =
        single_real.begin() + static_cast<std::ptrdiff_t>(std::min(labels.rigid_poles, single_real.size()));
    rigid.poles.insert(rigid.poles.end(), single_real.begin(), end);
    single_real.erase(single_real.begin(), end);
  }
  rigid.cluster = rigid.poles.size() > 2;
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

  poles = std::move(symmetric);
  poles.insert(poles.end(), zero_roots, ComplexX());
  return groups;
}

bool asks_for_exact(const std::vector<ComplexX>& poles, const PoleLabels& labels) {
  if (!labels.has_bodies) return false;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const double size = magnitude(poles[i]);
    if (!(std::abs(leading(poles[i].im)) > cluster_tolerance * size)) continue;
    if (labels.has_dampers && std::abs(leading(poles[i].re)) <= undamped_below * size) return true;
    for (std::size_t j = 0; j < i; ++j) {
      if (magnitude(poles[i] - poles[j]) <= cluster_tolerance * size) return true;
    }
  }
  return false;
}

void add_drive_pole(std::vector<PoleGroup>& groups, const DrivePole& pole) {
  // With a double one a third that is near loses digits with the square of their distance.
  const double tolerance = pole.copies > 1 ? real_cluster_tolerance : cluster_tolerance;
  const auto is_near = [&](const ComplexX& a, const ComplexX& b) {
    return magnitude(a - b) <= tolerance * magnitude(a);
  };
  PoleGroup own;
  own.mode = pole.mode;
  for (PoleGroup& group : groups) {
    if (!group.closed) continue;
    for (std::size_t i = 0; i < group.poles.size(); ++i) {
      if (!is_near(pole.at, group.poles[i])) continue;
      own.mode = group.mode;
      if (group.cluster || is_near(group.poles.front(), group.poles.back())) {  // all of them lie here
        group.poles.insert(group.poles.end(), pole.copies, pole.at);
        group.cluster = true;
        return;
      }
      own.poles.push_back(group.poles[i]);
      group.poles.erase(group.poles.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    if (!own.poles.empty()) break;
  }
  own.cluster = !own.poles.empty();
  own.poles.insert(own.poles.end(), pole.copies, pole.at);
  groups.push_back(std::move(own));
}

std::vector<DrivePole> poles_of(const DrivePath& drive) {
  std::vector<DrivePole> poles;
  if (drive.lag > 0.0) poles.push_back({ComplexX(Extended(-1.0) / Extended(drive.lag)), 1, -1});
  if (drive.tracking > 0.0) poles.push_back({ComplexX(Extended(-drive.tracking)), 2, -2});
  return poles;
}

}  // namespace zwidth::internal
