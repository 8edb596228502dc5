#include "stability/tip/grasp_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "stability/tip/least_gain.hpp"
#include "stability/users/disc_stiffness.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
using ComplexNumber = std::complex<double>;
using PartsRow = Eigen::Matrix<double, 5, 1>;
using PartsOfProbes = Eigen::Matrix<double, Eigen::Dynamic, 5>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double widest_own = 0.7;    // half of a panel, of the angle's logarithm: e^{jwT} turns, too
constexpr double narrowest = 1e-3;    // half of a panel that is halved for its error
constexpr double resolved_to = 1e-6;  // relative
constexpr double rounded_to = 1e-13;  // relative, of what cancels
constexpr std::size_t most_panels = 300;
constexpr int points_per_panel = 40;
constexpr int points_that_err = 5;        // of a panel whose discs are looked at themselves
constexpr std::size_t points_a_node = 2;  // of a point wall, whose discs are looked at themselves
constexpr double at_low_end = 1.001;      // times the lowest angle
constexpr double usual_lowest = 1e-3;     // rad a sample, of the scan
constexpr double least_lowest = 1e-6;     // K loses some 1e-17 over the square of the angle
constexpr double lowest_of_point = 1e-5;  // the same of a point wall, in double
constexpr double below_corners = 0.01;
constexpr double far_enough_below = 0.2;  // of the slowest corner: what a limit changes by yet, squares tell
constexpr double enough_for_point = 0.03;
constexpr double worth_refining = 1.3;            // times the least of the points
constexpr double damper_nearly_beaten = 0.5;      // of the condition without a spring
constexpr double worth_refining_exactly = 1.001;  // times the least of the polynomials
constexpr int most_rounds = 4;
constexpr int exact_bits = 26;
constexpr int quick_bits = 16;

// Where a function of |wT| has the pole that another alias has at `angle`.
ComplexNumber folded(ComplexNumber angle) {
  const double real = std::remainder(angle.real(), 2.0 * pi);
  return real < 0.0 ? ComplexNumber(-real, -angle.imag()) : ComplexNumber(real, angle.imag());
}

struct KnownPoles {
  std::vector<ComplexNumber> own;     // of the angle's logarithm
  std::vector<ComplexNumber> others;  // of the angle
};

KnownPoles known_poles(const GraspDiscs& discs, const std::vector<ComplexNumber>& corners) {
  KnownPoles poles;
  const auto add_own = [&](ComplexNumber angle) {
    if (std::abs(angle) > 0.0) poles.own.push_back(std::log(angle));
  };
  for (const ComplexNumber& s : discs.lossless_points()) {
    const ComplexNumber angle(s.imag(), -s.real());
    const ComplexNumber near = folded(angle);
    add_own(near);
    add_own(2.0 * pi - near);
    poles.others.push_back(2.0 * pi - near);
    if (angle.real() > pi) poles.others.push_back(near);
  }
  for (const ComplexNumber& s : discs.free_poles()) {
    if (!(s.imag() > pi)) continue;
    const ComplexNumber near = folded({s.imag(), -s.real()});
    poles.others.push_back(near);
    poles.others.push_back(2.0 * pi - near);
  }
  for (const ComplexNumber& z : corners) {
    if (z != 0.0 && z.imag() >= 0.0) add_own({std::arg(z), -std::log(std::abs(z))});
  }
  return poles;
}

// Directions in which a pose's panels are compared with its discs.
std::vector<Eigen::Matrix<double, 6, 1>> probes(Eigen::Index m) {
  std::vector<Eigen::Matrix<double, 6, 1>> products;
  for (Eigen::Index i = 0; i < m; ++i) products.push_back(products_of(Eigen::Vector3d::Unit(i)));
  for (const double y : {1.0, -1.0}) {
    Eigen::Vector3d between = Eigen::Vector3d::Zero();
    between.head(m) = Eigen::Vector3d(1.0, y, 0.7 * y).head(m);
    products.push_back(products_of(between.normalized()));
  }
  return products;
}

double constant_of(const GainCondition& condition) { return condition.constant; }

double point_of(const Panel& panel, int i, int count) { return panel.first() + 2.0 * panel.half * i / count; }

double angle_of(const Panel& panel, int i, int count) { return std::min(std::exp(point_of(panel, i, count)), pi); }

const Eigen::Matrix<double, points_per_panel, panel_nodes>& to_points() {
  static const Eigen::Matrix<double, points_per_panel, panel_nodes> weights = [] {
    Eigen::Matrix<double, points_per_panel, panel_nodes> rows;
    for (int i = 0; i < points_per_panel; ++i) {
      rows.row(i) = weights_at({0.0, 1.0}, -1.0 + 2.0 * i / points_per_panel).transpose();
    }
    return rows;
  }();
  return weights;
}

// What a normal makes of the forms.
PartsRow parts_of(GraspDiscs::Real real, GraspDiscs::Real imaginary, GraspDiscs::Real left, GraspDiscs::Real right,
                  ComplexNumber shared, double others) {
  const GraspDiscs::Real square = std::max(left * right, GraspDiscs::Real(0));
  const GraspDiscs::Real size = std::hypot(real, imaginary);
  const GraspDiscs::Real radius = std::sqrt(square);
  const ComplexNumber centre = shared * ComplexNumber(static_cast<double>(real), static_cast<double>(imaginary));
  const double scale = std::norm(shared);
  return {centre.real(), centre.imag(), scale * static_cast<double>((size - radius) * (size + radius)),
          scale * static_cast<double>(square), std::abs(shared) * others};
}

// Relative, where the polynomials say something else than the functions; more than 1: too far.
double error_of(const PartsRow& is, const PartsRow& said, const PartsRow& largest) {
  const double size = std::max({largest[0], largest[1], largest[4]});
  const double rounding = rounded_to * size;
  const PartsRow scale{resolved_to * largest[0] + rounding, resolved_to * size + rounding,
                       resolved_to * std::max(largest[2], largest[0] * largest[0]) + rounding * size,
                       resolved_to * largest[3] + rounding * size, resolved_to * largest[4] + rounding};
  return ((is - said).cwiseAbs().array() / scale.array()).maxCoeff();
}

template <typename PartsAt>
bool is_resolved(const Panel& panel, const std::vector<PartsOfProbes>& at_nodes, const PartsAt& parts_at) {
  PartsOfProbes largest = at_nodes.front().cwiseAbs();
  for (const PartsOfProbes& each : at_nodes) largest = largest.cwiseMax(each.cwiseAbs());
  for (const double end : {panel.first(), panel.last()}) {
    const NodeWeights weights = weights_at(panel, end);
    PartsOfProbes said = PartsOfProbes::Zero(largest.rows(), 5);
    for (int i = 0; i < panel_nodes; ++i) said += weights[i] * at_nodes[static_cast<std::size_t>(i)];
    const PartsOfProbes is = parts_at(end);
    for (Eigen::Index i = 0; i < is.rows(); ++i) {
      if (!(error_of(is.row(i).transpose(), said.row(i).transpose(), largest.row(i).transpose()) <= 1.0)) return false;
    }
  }
  return true;
}

// From left to right `add(panel, may_halve)`, which is false where the panel must be halved.
template <typename Add>
void add_panels(std::vector<Panel> open, const Add& add) {
  std::ranges::reverse(open);
  std::size_t count = open.size();
  while (!open.empty()) {
    const Panel panel = open.back();
    open.pop_back();
    if (add(panel, panel.half > narrowest && count < most_panels)) continue;
    const double quarter = 0.5 * panel.half;
    open.push_back({panel.centre + quarter, quarter});
    open.push_back({panel.centre - quarter, quarter});
    ++count;
  }
}

}  // namespace

GraspSearch::GraspSearch(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions,
                         const SampledTip& plant, const std::vector<ComplexNumber>& corners)
    : discs_(motion, loop, directions, plant),
      period_(loop.loop.sampling_period),
      delay_angle_(loop.loop.delay / loop.loop.sampling_period) {
  if (discs_.is_undamped()) return;
  slowest_ = discs_.slowest_corner();
  lowest_ = std::clamp(below_corners * slowest_, least_lowest, usual_lowest);
  is_known_ = lowest_ <= far_enough_below * slowest_;
  const KnownPoles poles = known_poles(discs_, corners);
  add_others(poles.others);
  add_own(poles.own);
  for (const OwnPanel& own : panels_) {
    const int count = own.errs() ? points_that_err : points_per_panel;
    for (int i = 0; i < count; ++i) points_.push_back(point_of(own.panel, i, count));
  }
  points_.push_back(panels_.back().panel.last());
  for (double& point : points_) point = std::min(point, std::log(pi));
  for (const double point : points_) delays_.push_back(std::polar(1.0, -delay_angle_ * std::exp(point)));
}

void GraspSearch::add_others(const std::vector<ComplexNumber>& poles) {
  const auto directions = probes(discs_.directions());
  const auto parts = [&](const GraspDiscs::Others& others) {
    PartsOfProbes rows(static_cast<Eigen::Index>(directions.size()), 5);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) << by_products(others.shift.real()).dot(directions[i]),
          by_products(others.shift.imag()).dot(directions[i]), 0.0, 0.0, radius_of_others(others, directions[i]);
    }
    return rows;
  };
  add_panels(panels_clear_of(0.0, pi, poles, pi), [&](const Panel& panel, bool may_halve) {
    OthersPanel others{panel, {}};
    std::vector<PartsOfProbes> at_nodes;
    for (int i = 0; i < panel_nodes; ++i) {
      others.at_nodes.push_back(discs_.others_at(panel_node(panel, i)));
      at_nodes.push_back(parts(others.at_nodes.back()));
      others.at_nodes.back().blocks.clear();
    }
    if (may_halve && !is_resolved(panel, at_nodes, [&](double angle) { return parts(discs_.others_at(angle)); })) {
      return false;
    }
    others_.push_back(std::move(others));
    return true;
  });
}

std::size_t GraspSearch::others_panel_of(double angle) const {
  const auto after =
      std::ranges::upper_bound(others_, angle, {}, [](const OthersPanel& each) { return each.panel.first(); });
  return after == others_.begin() ? 0 : static_cast<std::size_t>(after - others_.begin()) - 1;
}

GraspSearch::OwnForms GraspSearch::own_forms(double angle) const {
  const GraspDiscs::Sample sample = discs_.own_at(angle);
  const OthersPanel& others = others_[others_panel_of(angle)];
  const NodeWeights weights = weights_at(others.panel, angle);
  Eigen::Matrix3cd shift = Eigen::Matrix3cd::Zero();
  for (int i = 0; i < panel_nodes; ++i) shift += weights[i] * others.at_nodes[static_cast<std::size_t>(i)].shift;
  using Form = Eigen::Matrix<GraspDiscs::Real, 3, 3>;
  const Form real = sample.centre.real() - shift.real().cast<GraspDiscs::Real>();
  const Form imaginary = sample.centre.imag() - shift.imag().cast<GraspDiscs::Real>();
  return {by_products(real), by_products(imaginary), by_products(sample.left), by_products(sample.right),
          std::polar(1.0, delay_angle_ * angle) * sample.shared};
}

// Whether an error of the other aliases' polynomials drowns what limits a wall: the square of their radius is then that much more.
bool GraspSearch::others_drown(const OwnPanel& own, const std::vector<PartsOfProbes>& at_nodes) const {
  constexpr double most = 100.0;
  const auto directions = probes(discs_.directions());
  for (std::size_t probe = 0; probe < directions.size(); ++probe) {
    double radius = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < at_nodes.size(); ++i) {
      const auto node = static_cast<Eigen::Index>(i);
      const OthersPanel& others = others_[own.others[i]];
      double sum = 0.0;
      for (int k = 0; k < panel_nodes; ++k) {
        sum += own.others_weights(node, k) *
               radius_of_others(others.at_nodes[static_cast<std::size_t>(k)], directions[probe]);
      }
      sum *= std::abs(own.shared[i]);
      const auto& parts = at_nodes[i].row(static_cast<Eigen::Index>(probe));
      radius = std::max(radius, sum);
      power = std::max(power, std::abs(parts[2] - sum * (2.0 * std::sqrt(parts[3]) + sum)));
    }
    if (radius * radius > most * power) return true;
  }
  return false;
}

void GraspSearch::add_own(const std::vector<ComplexNumber>& poles) {
  const auto directions = probes(discs_.directions());
  std::vector<Eigen::Matrix<GraspDiscs::Real, 6, 1>> precise;
  precise.reserve(directions.size());
  for (const auto& each : directions) precise.emplace_back(each.cast<GraspDiscs::Real>());
  const auto parts = [&](const OwnForms& forms) {
    PartsOfProbes rows(static_cast<Eigen::Index>(directions.size()), 5);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) =
          parts_of(forms.real.dot(precise[i]), forms.imaginary.dot(precise[i]), forms.left.dot(precise[i]),
                   forms.right.dot(precise[i]), forms.shared, 0.0)
              .transpose();
    }
    return rows;
  };
  const std::vector<Panel> clear = panels_clear_of(std::log(lowest_), std::log(pi), poles, widest_own);
  add_panels(clear, [&](const Panel& panel, bool may_halve) {
    OwnPanel own;
    own.panel = panel;
    std::vector<PartsOfProbes> at_nodes;
    for (int i = 0; i < panel_nodes; ++i) {
      const double angle = std::exp(panel_node(panel, i));
      own.others.push_back(others_panel_of(angle));
      own.others_weights.row(i) = weights_at(others_[own.others.back()].panel, angle).transpose();
      const OwnForms forms = own_forms(angle);
      own.real.row(i) = forms.real;
      own.imaginary.row(i) = forms.imaginary;
      own.left.row(i) = forms.left;
      own.right.row(i) = forms.right;
      own.shared[static_cast<std::size_t>(i)] = forms.shared;
      at_nodes.push_back(parts(forms));
    }
    const auto at_end = [&](double x) { return parts(own_forms(std::min(std::exp(x), pi))); };
    const bool is_exact = is_resolved(panel, at_nodes, at_end);
    if (!is_exact && may_halve) return false;
    if (!is_exact || others_drown(own, at_nodes)) {
      for (int i = 0; i < points_that_err; ++i) own.at_points.push_back(discs_.at(angle_of(panel, i, points_that_err)));
    }
    panels_.push_back(std::move(own));
    return true;
  });
}

GraspSearch::Wall GraspSearch::wall(WallAt at) const {
  Wall wall{std::move(at), {}};
  wall.at_points.reserve(points_.size());
  for (const double point : points_) wall.at_points.push_back(wall.at(std::min(std::exp(point), pi)));
  return wall;
}

GraspSearch::Along::Along(const GraspSearch& search, const Eigen::Vector3d& normal)
    : search_(&search), normal_(normal) {
  const Eigen::Matrix<double, 6, 1> products = products_of(normal);
  const Eigen::Matrix<GraspDiscs::Real, 6, 1> precise = products.cast<GraspDiscs::Real>();
  std::vector<NodeWeights> radii;  // of the other aliases
  for (const OthersPanel& each : search.others_) {
    NodeWeights& at_nodes = radii.emplace_back();
    for (int i = 0; i < panel_nodes; ++i) {
      at_nodes[i] = radius_of_others(each.at_nodes[static_cast<std::size_t>(i)], products);
    }
  }
  panels_.reserve(search.panels_.size());
  at_points_.reserve(search.points_.size());
  for (const OwnPanel& own : search.panels_) {
    Parts& parts = panels_.emplace_back();
    const auto real = (own.real * precise).eval();
    const auto imaginary = (own.imaginary * precise).eval();
    const auto left = (own.left * precise).eval();
    const auto right = (own.right * precise).eval();
    for (int i = 0; i < panel_nodes; ++i) {
      const double others = own.others_weights.row(i).dot(radii[own.others[static_cast<std::size_t>(i)]]);
      parts.row(i) = parts_of(real[i], imaginary[i], left[i], right[i], own.shared[static_cast<std::size_t>(i)], others)
                         .transpose();
    }
    for (const GraspDiscs::Sample& each : own.at_points) at_points_.push_back(disc_along(each, normal));
    if (own.errs()) continue;
    const Eigen::Matrix<double, points_per_panel, 5> at_points = to_points() * parts;
    for (int i = 0; i < points_per_panel; ++i) {
      at_points_.push_back(disc(at_points.row(i).transpose(), search.delays_[at_points_.size()]));
    }
  }
  if (!panels_.empty()) at_points_.push_back(disc_near(search.points_.back()));
}

TerminationDiscs::Disc GraspSearch::Along::disc(const PartsRow& parts, ComplexNumber delay) {
  const double own = std::sqrt(std::max(parts[3], 0.0));
  const double others = std::max(parts[4], 0.0);
  return {delay * ComplexNumber(parts[0], parts[1]), own + others, parts[2] - others * (2.0 * own + others), 1.0};
}

TerminationDiscs::Disc GraspSearch::Along::disc_near(double x) const {
  const std::vector<OwnPanel>& panels = search_->panels_;
  const auto after = std::ranges::upper_bound(panels, x, {}, [](const OwnPanel& each) { return each.panel.first(); });
  const std::size_t at = after == panels.begin() ? 0 : static_cast<std::size_t>(after - panels.begin()) - 1;
  if (panels[at].errs()) return disc_along(search_->discs_.at(std::min(std::exp(x), pi)), normal_);
  const PartsRow parts = panels_[at].transpose() * weights_at(panels[at].panel, x);
  return disc(parts, std::polar(1.0, -search_->delay_angle_ * std::exp(x)));
}

std::vector<GraspSearch::Along::Low> GraspSearch::Along::lows(const Wall& wall, double bound) const {
  const std::vector<double>& points = search_->points_;
  std::vector<GainCondition> conditions;
  std::vector<double> gains;
  conditions.reserve(points.size());
  gains.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    conditions.push_back(gain_condition(at_points_[i], wall.at_points[i]));
    gains.push_back(real_gain(conditions.back()));
  }
  std::vector<Low> lows;
  const double least = std::max(std::ranges::min(gains), bound);
  if (least == 0.0) {
    const auto beaten = std::ranges::min_element(conditions, {}, &GainCondition::constant) - conditions.begin();
    const auto i = static_cast<std::size_t>(beaten);
    lows.push_back({0.0, points[i], points[i == 0 ? 0 : i - 1], points[std::min(i + 1, points.size() - 1)]});
    return lows;
  }
  const auto condition_near = [&](double x) {
    return gain_condition(disc_near(x), wall.at(std::min(std::exp(x), pi)));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, points.size() - 1);
    const auto add = [&](const Looked& looked) {
      if (std::isfinite(looked.gain)) lows.push_back({looked.gain, looked.x, points[before], points[after]});
    };
    const auto beside = [&](double x) {
      return least_beside(points[before], x, points[after], quick_bits, condition_near);
    };
    const auto is_least_at = [&](const auto& function) {
      return function(conditions[i]) <= function(conditions[before]) &&
             function(conditions[i]) <= function(conditions[after]);
    };
    if (std::isfinite(gains[i])) {
      const bool is_end = !std::isfinite(gains[before] + gains[after]);
      const bool is_low = gains[i] <= gains[before] && gains[i] <= gains[after] && gains[i] <= worth_refining * least;
      if (is_end || is_low) add(beside(points[i]));
    } else if (conditions[i].half < 0.0 && is_least_at(openness)) {
      const Looked found = least_towards(points[before], points[after], quick_bits, condition_near, openness);
      if (std::isfinite(found.gain)) add(beside(found.x));
    }
    if (conditions[i].constant < damper_nearly_beaten && is_least_at(constant_of)) {
      add(least_towards(points[before], points[after], quick_bits, condition_near, constant_of));
    }
  }
  return lows;
}

GraspSearch::Least GraspSearch::Along::quickly_least(const Wall& wall) const {
  if (panels_.empty()) return {0.0, 0.0, false};
  Low least;
  for (const Low& each : lows(wall, 0.0)) {
    if (each.gain < least.gain) least = each;
  }
  const auto gain_at = [&](double x) { return real_gain(gain_condition(disc_near(x), wall.at(std::exp(x)))); };
  return search_->known(followed_to_rest(search_->least_at(least.gain, least.x), std::log(search_->lowest_), gain_at));
}

GraspSearch::Least GraspSearch::Along::least(const Wall& wall) const {
  if (panels_.empty()) return {0.0, 0.0, false};
  const auto condition = [&](double x) {
    const double angle = std::min(std::exp(x), pi);
    return gain_condition(disc_along(search_->discs_.at(angle), normal_), wall.at(angle));
  };
  Least least;
  const auto take = [&](const Looked& looked) {
    if (looked.gain < least.gain) least = search_->least_at(looked.gain, looked.x);
    return std::isfinite(looked.gain);
  };
  double bound = 0.0;
  for (int round = 0; round < most_rounds; ++round) {
    const std::vector<Low> found = lows(wall, bound);
    double quick = infinity;
    for (const Low& each : found) quick = std::min(quick, each.gain);
    quick = std::max(quick, bound);
    for (const Low& each : found) {
      if (each.gain > worth_refining_exactly * quick) continue;
      if (each.gain == 0.0) {
        take(least_towards(each.before, each.after, exact_bits, condition, constant_of));
        if (least.gain == 0.0) return search_->known(least);
      }
      if (take(least_beside(each.before, each.x, each.after, exact_bits, condition))) continue;
      // Only the polynomials leave a gain at x: the discs beside it, or within what the polynomials err.
      const Looked beside = least_towards(each.before, each.after, exact_bits, condition, openness);
      take(std::isfinite(beside.gain) ? beside : Looked{each.gain, each.x});
    }
    if (!(least.gain > worth_refining * quick)) break;
    bound = least.gain;  // the polynomials said less than the discs leave: what lies in between is looked at too
  }
  return search_->known(
      followed_to_rest(least, std::log(search_->lowest_), [&](double x) { return real_gain(condition(x)); }));
}

GraspSearch::Least GraspSearch::known(const Least& least) const {
  return is_known_ ? least : Least{std::numeric_limits<double>::quiet_NaN(), 0.0, false};
}

GraspSearch::Least GraspSearch::least_at(double gain, double x) const {
  const double angle = std::min(std::exp(x), pi);
  return {gain, angle, angle <= at_low_end * lowest_};
}

GraspSearch::LeastOfPoint GraspSearch::least_of_point(Eigen::Index m, VirtualDamper damper) const {
  if (panels_.empty()) return {{0.0, 0.0, false}, {0.0, 0.0, false}};
  std::vector<double> at;
  std::vector<PointStiffness> stiffnesses;
  const auto stiffness = [&](double x) {
    return least_stiffness_of_point(discs_.at(std::min(std::exp(x), pi)), m, damper, period_);
  };
  for (std::size_t i = 0; i < points_.size(); i += points_a_node) {
    if (points_[i] >= std::log(lowest_of_point)) at.push_back(points_[i]);
  }
  at.back() = points_.back();
  stiffnesses.reserve(at.size());
  for (const double x : at) stiffnesses.push_back(stiffness(x));
  const auto least = [&](double PointStiffness::*which) {
    const auto lowest = std::ranges::min_element(stiffnesses, {}, which);
    const double scanned = (*lowest).*which;
    Least found = least_at(scanned, at[static_cast<std::size_t>(lowest - stiffnesses.begin())]);
    found.is_at_low_end = lowest == stiffnesses.begin();
    if (!(scanned > 0.0) || !std::isfinite(scanned)) return found;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::size_t before = i == 0 ? 0 : i - 1;
      const std::size_t after = std::min(i + 1, at.size() - 1);
      const double here = stiffnesses[i].*which;
      const bool is_low = here <= stiffnesses[before].*which && here <= stiffnesses[after].*which;
      if (!is_low || here > worth_refining * scanned) continue;
      const auto [x, refined] =
          minimum(at[before], at[after], exact_bits, [&](double near) { return stiffness(near).*which; });
      if (refined < found.gain) found = least_at(refined, x);
    }
    return followed_to_rest(found, at.front(), [&](double x) { return stiffness(x).*which; });
  };
  LeastOfPoint both{least(&PointStiffness::at_least), least(&PointStiffness::at_most)};
  if (!(std::exp(at.front()) <= enough_for_point * slowest_)) both.at_least.gain = 0.0;  // not known
  return both;
}

double frequency_of(const GraspSearch::Least& least, double period) {
  const bool is_there = least.gain > 0.0 && std::isfinite(least.gain) && !least.is_at_low_end;
  return is_there ? least.angle / period : 0.0;
}

}  // namespace zwidth::internal
