#include "stability/users/wall_condition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stability/users/disc_stiffness.hpp"

namespace zwidth::internal {
namespace {

constexpr int most_halvings = 14;
constexpr double rounding_of_terms = 16.0 * std::numeric_limits<double>::epsilon();  // of p, q and A each

struct Bernstein {
  InterpolationValues constant;  // f(0)
  InterpolationValues middle;    // p + q K1
  InterpolationValues last;      // f(K1)
  InterpolationValues quadratic;
  InterpolationValues discriminant;  // p A - q²
};

struct Errors {
  double constant;
  double middle;
  double last;
  double quadratic;
  double discriminant;
};

struct Range {
  double least;
  double greatest;
};

Range range_of(const InterpolationValues& coefficients) {
  const auto [least, greatest] = std::minmax_element(coefficients.begin(), coefficients.end());
  return {*least, *greatest};
}

double uncertainty(const InterpolationValues& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return interpolation_error(values) + bernstein_rounding * largest;
}

/// f > 0 at 0 <= K <= K1 for all values in these ranges.
bool is_positive(const Bernstein& b, const Errors& errors) {
  const Range constant = range_of(b.constant);
  const Range middle = range_of(b.middle);
  const Range last = range_of(b.last);
  const double constant_least = constant.least - errors.constant;
  const double last_least = last.least - errors.last;
  if (!(constant_least > 0.0 || (errors.constant == 0.0 && constant_least == 0.0)) || !(last_least > 0.0)) return false;
  if (range_of(b.quadratic).greatest + errors.quadratic < 0.0 || middle.least - errors.middle > 0.0) return true;
  if (range_of(b.discriminant).least - errors.discriminant > 0.0) return true;
  const double steepest = std::min(middle.least - errors.middle, 0.0);
  return steepest * steepest < constant_least * last_least;
}

bool is_broken(double constant, double middle, double last, const Errors& errors) {
  if (constant < -errors.constant || last < -errors.last) return true;
  const double steepest = middle + errors.middle;
  return steepest < 0.0 && steepest * steepest > (constant + errors.constant) * (last + errors.last);
}

WallCondition::Answer judge(const Bernstein& b, const Errors& errors, double begin, double end, int halvings) {
  using enum WallCondition::Verdict;
  if (is_positive(b, errors)) return {holds, 0.0};
  if (is_broken(b.constant.front(), b.middle.front(), b.last.front(), errors)) return {broken, begin};
  if (is_broken(b.constant.back(), b.middle.back(), b.last.back(), errors)) return {broken, end};
  if (halvings == 0) return {undecided, 0.5 * (begin + end)};
  const Halves constant = halves_of(b.constant);
  const Halves middle = halves_of(b.middle);
  const Halves last = halves_of(b.last);
  const Halves quadratic = halves_of(b.quadratic);
  const Halves discriminant = halves_of(b.discriminant);
  const double half = 0.5 * (begin + end);
  const auto left = judge({constant.left, middle.left, last.left, quadratic.left, discriminant.left}, errors, begin,
                          half, halvings - 1);
  if (left.verdict != holds) return left;
  return judge({constant.right, middle.right, last.right, quadratic.right, discriminant.right}, errors, half, end,
               halvings - 1);
}

}  // namespace

WallCondition::Terms WallCondition::terms(const TerminationDiscs::Disc& disc, const WallResponse& wall) {
  const auto& [unit, closed] = wall;
  return {disc.one + 2.0 * (closed * disc.centre).real() + disc.power * std::norm(closed),
          (unit * disc.centre).real() + disc.power * (unit * std::conj(closed)).real(), disc.power * std::norm(unit)};
}

/// Whether |a| <= 1e-11 b at all nodes: rounding.
bool is_rounding_beside(const InterpolationValues& a, const InterpolationValues& b) {
  constexpr double rounding = 1e-11;
  for (std::size_t i = 0; i < interpolation_points; ++i) {
    if (!(std::abs(a[i]) <= rounding * std::abs(b[i]))) return false;
  }
  return true;
}

/// The three terms on a piece that begins at 0, each over the power of x = w² as which it goes there.
struct WallCondition::NearZero {
  struct Term {
    static constexpr double highest = 5.0;
    int order = 0;  // of x
    InterpolationValues coefficients{};
    double error = 0.0;

    /// x in units of the piece's end.
    Term(const InterpolationValues& values, const InterpolationValues& x) {
      const double slope = std::log(std::abs(values[1] / values[0])) / std::log(x[1] / x[0]);
      order = std::isfinite(slope) ? static_cast<int>(std::clamp(std::round(slope), -highest, highest))
                                   : static_cast<int>(highest);  // 0 throughout
      InterpolationValues over{};
      for (std::size_t i = 0; i < interpolation_points; ++i) over[i] = values[i] * std::pow(x[i], -order);
      coefficients = bernstein_coefficients(over);
      error = uncertainty(over);
    }
    [[nodiscard]] double least() const { return range_of(coefficients).least - error; }
    [[nodiscard]] double greatest() const { return range_of(coefficients).greatest + error; }
  };
  Term constant;
  Term half;
  Term quadratic;
  [[nodiscard]] int lowest_order() const { return std::min({constant.order, half.order, quadratic.order}); }
};

/// With p = x^a p', q = x^b q', A = x^c A': no root K > 0 where p' > 0, A' > 0 and q' > 0 or x^{2b - a - c} q'² < p'
/// A'.
void WallCondition::look_at_zero(const NearZero& terms) {
  constexpr double certain = 1e-6;  // relative, of a value at 0
  const auto& [p, q, a] = terms;
  const int surplus = 2 * q.order - p.order - a.order;
  const double steepest = std::min(q.least(), 0.0);
  if (p.least() > 0.0 && a.least() > 0.0 &&
      (steepest == 0.0 || (surplus >= 0 && steepest * steepest < p.least() * a.least()))) {
    holds_for_all_k_ = true;
  }
  const int lowest = terms.lowest_order();
  const auto at_zero = [&](const NearZero::Term& term) {
    return term.order == lowest ? term.coefficients.front() : 0.0;
  };
  for (const NearZero::Term* term : {&p, &q, &a}) {
    if (term->order == lowest && !(term->error <= certain * std::abs(term->coefficients.front()))) return;
  }
  if (p.order == lowest) {
    at_zero_ = least_root(at_zero(p), at_zero(q), at_zero(a));
  } else if (holds_for_all_k_) {
    at_zero_ = std::numeric_limits<double>::infinity();
  } else if (p.coefficients.front() < 0.0 || at_zero(q) < 0.0 || (at_zero(q) == 0.0 && at_zero(a) < 0.0)) {
    at_zero_ = 0.0;
  }
}

WallCondition::WallCondition(const DiscPieces::Piece& piece,
                             const std::array<WallResponse, interpolation_points>& walls)
    : nodes_(piece.nodes), walls_(walls) {
  is_undamped_ = std::all_of(walls.begin(), walls.end(), [](const WallResponse& each) { return each.closed == 0.0; });
  for (std::size_t i = 0; i < interpolation_points; ++i) terms_[i] = terms(nodes_[i].disc, walls_[i]);
  if (!piece.begins_at_rest()) return;
  InterpolationValues x{};
  InterpolationValues constant{};
  InterpolationValues half{};
  InterpolationValues quadratic{};
  for (std::size_t i = 0; i < interpolation_points; ++i) {
    x[i] = 0.5 * (1.0 + interpolation_nodes()[i]);
    constant[i] = nodes_[i].factor * terms_[i].constant;
    half[i] = nodes_[i].factor * terms_[i].half;
    quadratic[i] = nodes_[i].factor * terms_[i].quadratic;
  }
  // Where q² >> p A the A K² is rounding (of a rigid device it vanishes), where q² << p A the q K: no order of its own.
  InterpolationValues product{};
  InterpolationValues square{};
  for (std::size_t i = 0; i < interpolation_points; ++i) {
    product[i] = constant[i] * quadratic[i];
    square[i] = half[i] * half[i];
  }
  if (is_rounding_beside(product, square)) quadratic.fill(0.0);
  if (is_rounding_beside(square, product)) half.fill(0.0);
  const NearZero near_zero{{constant, x}, {half, x}, {quadratic, x}};
  look_at_zero(near_zero);
  // Where springs tie the device to ground all of them vanish at 0, where only links dissipate they grow.
  for (std::size_t i = 0; i < interpolation_points; ++i) nodes_[i].factor *= std::pow(x[i], -near_zero.lowest_order());
}

/// f(K1) at a node, by the difference of which less is lost: near a root of 1 + C c, and where c grows without bound.
double WallCondition::last_at(std::size_t node, double stiffness) const {
  const TerminationDiscs::Disc& disc = nodes_[node].disc;
  const std::complex<double> wall = stiffness * walls_[node].unit + walls_[node].closed;
  const double apart = std::abs(disc.one + wall * disc.centre);
  const double reach = std::abs(wall) * disc.radius;
  const auto& [constant, half, quadratic] = terms_[node];
  const double lost = apart * (disc.one + std::abs(wall * disc.centre)) + reach * reach;
  const double lost_in_sum = std::abs(constant) + stiffness * (2.0 * std::abs(half) + stiffness * std::abs(quadratic));
  if (lost < lost_in_sum * disc.one) return (apart - reach) * (apart + reach) / disc.one;
  return constant + stiffness * (2.0 * half + stiffness * quadratic);
}

WallCondition::Answer WallCondition::up_to(double stiffness) const {
  if (holds_for_all_k_) return {Verdict::holds, 0.0};
  Bernstein values{};
  Errors errors{0.0, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < interpolation_points; ++i) {
    const DiscPieces::Node& node = nodes_[i];
    const Terms& at = terms_[i];
    values.constant[i] = node.factor * at.constant;
    values.middle[i] = node.factor * (at.constant + at.half * stiffness);
    values.last[i] = node.factor * last_at(i, stiffness);
    values.quadratic[i] = node.factor * at.quadratic;
    // What an error of centre and radius makes of them.
    const double error = node.factor * node.error;
    const double one = node.disc.one;
    const double size = std::abs(node.disc.centre) + node.disc.radius;
    const double unit = std::abs(walls_[i].unit);
    const double damper = std::abs(walls_[i].closed);
    const std::complex<double> wall = stiffness * walls_[i].unit + walls_[i].closed;
    const double apart = std::abs(one + wall * node.disc.centre) + std::abs(wall) * node.disc.radius;
    const double of_constant = 2.0 * error * damper * (one + damper * size);
    errors.constant = std::max(errors.constant, of_constant);
    errors.middle = std::max(errors.middle, of_constant + stiffness * error * unit * (one + 2.0 * damper * size));
    errors.last = std::max(errors.last, 2.0 * error * std::abs(wall) * apart);
    errors.quadratic = std::max(errors.quadratic, 2.0 * error * size * unit * unit);
    values.discriminant[i] = node.factor * node.factor * (at.constant * at.quadratic - at.half * at.half);
    const double rounding = rounding_of_terms * node.factor / one;
    const double of_p = of_constant + rounding * (one + damper * size) * (one + damper * size);
    const double of_q = unit * (error * (one + 2.0 * damper * size) + rounding * size * (one + damper * size));
    const double of_a = unit * unit * (2.0 * error * size + rounding * size * size);
    errors.discriminant = std::max(
        errors.discriminant,
        node.factor * (std::abs(at.constant) * of_a + std::abs(at.quadratic) * of_p + 2.0 * std::abs(at.half) * of_q) +
            of_p * of_a + of_q * of_q);
  }
  errors.constant += uncertainty(values.constant);
  errors.middle += uncertainty(values.middle);
  errors.last += uncertainty(values.last);
  errors.quadratic += uncertainty(values.quadratic);
  errors.discriminant += uncertainty(values.discriminant);
  values.constant = bernstein_coefficients(values.constant);
  values.middle = bernstein_coefficients(values.middle);
  values.last = bernstein_coefficients(values.last);
  values.quadratic = bernstein_coefficients(values.quadratic);
  values.discriminant = bernstein_coefficients(values.discriminant);
  if (is_undamped_) {  // positive as it stands, its interpolant or not
    for (double& each : values.constant) each = std::max(each, 0.0);
    errors.constant = 0.0;
  }
  return judge(values, errors, -1.0, 1.0, most_halvings);
}

}  // namespace zwidth::internal
