// The words of reasons: why there is no wall, what an oscillation is, what a relay's reading means.

#include <gtest/gtest.h>

#include "counted.hpp"
#include "zwidth/stability/holder_limit.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

using internal::counted;

TEST(WordsOfDesign, GiveALimitInItsUnit) {
  EXPECT_EQ(text({.code = FindingCode::limit_stays_below_target,
                  .evidence = {{"limit", 10140.0, "N/m"}, {"factor", 1000.0}}}),
            "within a factor of 1000 of its value the limit gets no higher than 10.14 kN/m");
  EXPECT_EQ(text({.code = FindingCode::limit_stays_above_target, .evidence = {{"limit", 12000.0, "N s/m"}}}),
            "at any value from 0 up to what is likely the limit gets no lower than 12000 N s/m");
  EXPECT_EQ(text({.code = FindingCode::uncertainty_leaves_no_margins, .evidence = {{"threshold", 0.025}}}),
            "the uncertainty of the device leaves no wall: in more than 2.5 % of the devices drawn from it none keeps "
            "what is asked; identify the device from more or longer recordings");
  EXPECT_EQ(text(std::nullopt), "");
}

TEST(WordsOfDiagnosis, HaveTheirVariants) {
  Finding user{.code = FindingCode::some_user_destabilises,
               .evidence = {{"gain", 2500.0, "N/m"}},
               .subjects = {{"what", "wall"}}};
  EXPECT_EQ(text(user), "some passive user can make walls from 2.5 kN/m on oscillate there");
  user.evidence.push_back({"with_nobody", 1.0});
  EXPECT_EQ(text(user),
            "some passive user can make walls from 2.5 kN/m on oscillate there; this one oscillates with nobody "
            "holding");
  EXPECT_EQ(text({.code = FindingCode::some_user_destabilises,
                  .evidence = {{"gain", 12.0, "N s/m"}, {"frequency_hz", 98.0, "Hz"}},
                  .subjects = {{"what", "damper"}}}),
            "some passive user can make dampers from 12 N s/m on oscillate at 98 Hz");
  EXPECT_EQ(text({.code = FindingCode::loop_unstable,
                  .evidence = {{"frequency_hz", 60.0, "Hz"}, {"settles_elsewhere", 1.0}, {"user_stabilises", 1.0}}}),
            "the loop is unstable with this wall: it grows at 60 Hz, and where a force limit, a wall that only pushes "
            "or a hand lets it settle may be elsewhere once the file's user lets go, who keeps it stable");
  EXPECT_EQ(text({.code = FindingCode::crossover_at_frequency,
                  .evidence = {{"frequency_hz", 98.0, "Hz"},
                               {"gain", 9000.0, "N/m"},
                               {"softest", 4000.0, "N/m"},
                               {"softest_hz", 30.0, "Hz"},
                               {"without_operator", 1.0}}}),
            "a phase crossover at 98 Hz: unstable from 9 kN/m on, but walls from 4 kN/m on already oscillate at 30 Hz; "
            "it does so without the user too");
}

TEST(WordsOfRelays, HaveTheirVariants) {
  Finding less{.code = FindingCode::reads_less_at_crossover,
               .evidence = {{"frequency_hz", 6.4}, {"stiffness_db", 81.234}, {"difference_db", 0.456}}};
  EXPECT_EQ(text(less),
            "It oscillates near the phase crossover of linear theory at 6.4 Hz, 81.23 dB (the rigid body): the relay "
            "reads 0.46 dB less.");
  less.evidence.push_back(counted("mode", 2));
  EXPECT_EQ(text(less),
            "It oscillates near the phase crossover of linear theory at 6.4 Hz, 81.23 dB (vibration mode 2): the relay "
            "reads 0.46 dB less.");
  EXPECT_EQ(text({.code = FindingCode::friction_leaves_cycle,
                  .evidence = {{"frequency_hz", 6.4}, {"stiffness_db", 81.0}, {"harmonics", 1.0}, {"level", 0.08}}}),
            "Coulomb friction of up to 8.0 % of the relay's force acts as a damping that grows as the motion slows. By "
            "first harmonics it leaves the oscillation at 6.4 Hz, 81.00 dB. The rest of the way is that of the higher "
            "harmonics.");
  EXPECT_EQ(text({.code = FindingCode::sampled_relay_has_this_one,
                  .evidence = {counted("cycles", 1)},
                  .subjects = {{"bands", "6.4"}}}),
            "Without friction and encoder the sampled relay has 1 exact oscillation (6.4 Hz), this one among them; the "
            "start decides between them.");
  EXPECT_EQ(text({.code = FindingCode::no_frequency_stands_out, .evidence = {{"share", 0.1}, {"threshold", 0.25}}}),
            "no frequency stands out: the strongest holds 10 % of the motion's power; at least 25 %");
}

TEST(WordsOfHolders, StandAheadOfWhatIsSaidOfThem) {
  EXPECT_EQ(text({.code = FindingCode::boundary_sampled,
                  .evidence = {counted("walls_confirmed", 3)},
                  .subjects = {{"of_holder", "nobody holding"}}})
                .substr(0, 40),
            "with nobody holding: the boundary was fo");
  EXPECT_EQ(unstable_with({.nobody = false, .user = false}), "with nobody holding and with the file's user");
  EXPECT_EQ(unstable_with({.nobody = true, .user = false}), "with the file's user");
  EXPECT_EQ(unstable_with({.nobody = true}), "");
}

}  // namespace
}  // namespace zwidth
