#include "report/text/quantity.hpp"

#include <gtest/gtest.h>

#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

TEST(Quantity, HasFourDigitsAndAnEngineeringPrefix) {
  EXPECT_EQ(quantity(8848.70869499712, "N/m"), "8.849 kN/m");
  EXPECT_EQ(quantity(135171032.89, "N/m"), "135.2 MN/m");
  EXPECT_EQ(quantity(1e-3, "s"), "1 ms");
  EXPECT_EQ(quantity(1.7976931348623157e308, "m"), "1.798e+308 m");
  EXPECT_EQ(quantity(5e-324, "m"), "4.941e-324 m");
  EXPECT_EQ(quantity(3.14e-6, "m"), "3.14 µm");
  EXPECT_EQ(quantity(0.5, "N m/rad"), "500 mN m/rad");
  EXPECT_EQ(quantity(0.0, "N/m"), "0 N/m");
  EXPECT_EQ(quantity(-8848.7, "N/m"), "-8.849 kN/m");
}

TEST(Quantity, RoundingThatReachesTheNextPrefixTakesIt) {
  EXPECT_EQ(quantity(999.4, "N/m"), "999.4 N/m");
  EXPECT_EQ(quantity(999.96, "N/m"), "1 kN/m");
  EXPECT_EQ(quantity(1000.0, "N/m"), "1 kN/m");
  EXPECT_EQ(quantity(0.99999, "Hz"), "1 Hz");
}

TEST(Quantity, BeyondThePrefixesItIsScientific) {
  EXPECT_EQ(quantity(1.5e21, "N/m"), "1.5e+12 GN/m");
  EXPECT_EQ(quantity(5e-13, "s"), "5e-13 s");
  EXPECT_EQ(quantity(-1.5e-21, "N m/rad"), "-1.5e-21 N m/rad");
}

TEST(Number, KeepsWholeDigitsAndAvoidsExponentsInTheUsualRange) {
  EXPECT_EQ(number(31415.9), "31416");
  EXPECT_EQ(number(190489.0), "1.905e+05");
  EXPECT_EQ(number(38.5965), "38.6");
  EXPECT_EQ(number(0.0507), "0.0507");
  EXPECT_EQ(number(1.2e-7), "1.2e-07");
}

TEST(TextTable, AlignsColumnsByCharactersNotBytes) {
  const TextTable table{{Align::left, Align::right}, {{"a", "value"}, {"µµµ", "1"}}};
  EXPECT_EQ(layout(table), "  a    value\n  µµµ      1\n");
}

TEST(TextTable, WrapKeepsWordsWholeAndWithinTheWidth) {
  EXPECT_EQ(wrap("aa bb cc", 7, 2), "  aa bb\n  cc\n");
  EXPECT_EQ(wrap("longerthanthewidth b", 5, 0), "longerthanthewidth\nb\n");
}

TEST(TextTable, ShortenedCutsBetweenCharacters) {
  EXPECT_EQ(shortened("µµµµ", 4), "µµµµ");
  EXPECT_EQ(shortened("µµµµµ", 4), "µµ…µ");
  EXPECT_EQ(shortened("device, original", 8), "devi…nal");
  EXPECT_EQ(shortened("device", 1), "…");
}

}  // namespace
}  // namespace zwidth::report
