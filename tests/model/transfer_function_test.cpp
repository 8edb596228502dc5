#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "fifty_digits.hpp"
#include "lhifam.hpp"
#include "log_spaced.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth {
namespace {

struct Case {
  std::string name;
  std::vector<double> numerator;
  std::vector<double> denominator;
  int integrators;
  int unstable_poles;
  int undamped_pairs;
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

const Case cases[] = {
    {"triple_pole", {1.0}, {1.0, 3.0, 3.0, 1.0}, 0, 0, 0},
    {"fourfold_pole", {2.0, 1.0}, {1.0, 4.0, 6.0, 4.0, 1.0}, 0, 0, 0},
    {"double_pole", {2.0, 1.0}, {1.0, 10.0, 25.0}, 0, 0, 0},
    {"integrator", {1.0}, {1.0, 0.0}, 1, 0, 0},
    {"double_integrator", {1.0}, {2.0, 0.0, 0.0}, 2, 0, 0},
    {"triple_integrator", {1.0, 1.0}, {1.0, 0.0, 0.0, 0.0}, 3, 0, 0},
    {"triple_integrator_and_pole", {1.0, 1.0}, {1.0, 2.0, 0.0, 0.0, 0.0}, 3, 0, 0},
    {"double_integrator_and_double_pole", {5.0}, {1.0, 2.0, 1.0, 0.0, 0.0}, 2, 0, 0},
    {"cancelled_integrator", {1.0, 0.0}, {1.0, 2.0, 0.0}, 0, 0, 0},
    {"real_pole_on_the_right", {1.0}, {1.0, -1.0, -2.0}, 0, 1, 0},
    {"pair_on_the_right", {1.0, 3.0}, {1.0, -2.0, 2.0}, 0, 2, 0},
    {"symmetric_real_poles", {3.0}, {2.0, 0.0, -2.0}, 0, 1, 0},
    {"undamped", {1.0}, {1.0, 0.0, 4.0}, 0, 0, 1},
    {"double_undamped", {1.0, 2.0}, {1.0, 0.0, 2.0, 0.0, 1.0}, 0, 0, 2},
    {"undamped_beside_others", {1.0, 7.0}, {1.0, 1.0, 9.0, 9.0, 0.0}, 1, 0, 1},
    {"light_damping", {1.0}, {1.0, 1e-3, 1.0, 0.25e-3, 0.0}, 1, 0, 0},
    {"high_order", {1.0}, {1.0, 21.0, 175.0, 735.0, 1624.0, 1764.0, 720.0}, 0, 0, 0},  // -1 ... -6
    {"leading_zeros_in_the_numerator", {0.0, 0.0, 2.0}, {1.0, 3.0, 2.0}, 0, 0, 0},
    {"tiny_leading_coefficient", {1e-60}, {1e-60, 3e-60, 2e-60}, 0, 0, 0},
    {"widely_spread", {1.0}, {1.0, 1e6 + 1e-3, 1e3}, 0, 0, 0},
};

class TransferFunctionForm : public testing::TestWithParam<Case> {};

TEST_P(TransferFunctionForm, CountsItsPolesAndKeepsItsDigits) {
  const Case& c = GetParam();
  const ModalForm form = modal_form(Device(test::transfer_function_parameters(c.numerator, c.denominator, 1e-3)));
  int integrators = 0;
  int unstable = 0;
  int undamped = 0;
  for (const ModalTerm& term : form.terms) {
    integrators += term.integrators;
    unstable += term.unstable_poles;
    undamped += term.undamped_pairs;
  }
  EXPECT_EQ(integrators, c.integrators);
  EXPECT_EQ(unstable, c.unstable_poles);
  EXPECT_EQ(undamped, c.undamped_pairs);
  double worst = 0.0;
  double worst_at = 0.0;
  for (const double frequency : test::log_spaced(1.3e-3, 1.7e3, 60)) {
    const test::Complex50 s(test::Real50(0), test::Real50(frequency));
    test::Complex50 numerator(0);
    test::Complex50 denominator(0);
    for (const double x : c.numerator) numerator = numerator * s + test::Complex50(x);
    for (const double x : c.denominator) denominator = denominator * s + test::Complex50(x);
    const test::Complex50 exact = numerator / denominator;
    double size = 0.0;  // terms cancel far above the poles: relative to their magnitudes
    for (const ModalTerm& term : form.terms) size += std::abs(response(term, frequency));
    const double magnitude = static_cast<double>(abs(exact));
    const double error = test::relative_error(response(form, frequency), exact) * magnitude / std::max(size, magnitude);
    if (!(error <= worst)) worst = error, worst_at = frequency;
  }
  EXPECT_LE(worst, 1e-9) << "at " << worst_at << " rad/s";  // the accuracy promised for K_CR
}

INSTANTIATE_TEST_SUITE_P(Cases, TransferFunctionForm, testing::ValuesIn(cases),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace zwidth
