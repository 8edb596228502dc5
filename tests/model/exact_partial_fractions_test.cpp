#include "model/exact_partial_fractions.hpp"

#include <flint/fmpz_poly.h>
#include <gtest/gtest.h>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

// Poles from 1e-32 to 1e33 rad/s, of a trial that a fit threw away: with 32 bits two approximations of them meet, and
// arb_fmpz_poly_complex_roots doubled its bits until memory ended.
TEST(ExactPartialFractions, PolesOfAllMagnitudesAreFound) {
  internal::ExactFraction fraction;
  fmpz_poly_one(fraction.numerator);
  const char* coefficients =
      "5  "
      "7133665851480075842403179981077080492498112424440708120031956828160 "
      "16826385662119574467289700171191116624093470163491769266396861068916845049750070"
      "1805009885861511168 "
      "35343747547042191433877703665263692825422396136696459472121654892182724620748754"
      "51907208205596663136141807754 "
      "154025751913565269757922602493846776055519868671614952383613683634088796487680 "
      "175259030475651762235640501702980791520249925";
  ASSERT_EQ(fmpz_poly_set_str(fraction.denominator, coefficients), 0);
  internal::KnownPoles known;
  const ModalForm form = internal::exact_partial_fractions(fraction, internal::DrivePath{}, {}, known);
  std::size_t poles = 0;
  for (const ModalTerm& term : form.terms) poles += term.degree;
  EXPECT_EQ(poles, 4U);
}

}  // namespace
}  // namespace zwidth
