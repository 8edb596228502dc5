// Units on the command line.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

class UnitsOnTheCommandLine : public Workspace {
 protected:
  /// Both commands succeed and print the same.
  void expect_same(const std::string& one, const std::string& other) const {
    const Outcome first = run(one);
    const Outcome second = run(other);
    EXPECT_EQ(first.status, 0) << one << "\n" << first.errors;
    EXPECT_EQ(second.status, 0) << other << "\n" << second.errors;
    EXPECT_EQ(first.output, second.output) << one << "\n" << other;
  }
};

TEST_F(UnitsOnTheCommandLine, AreTheSameNumbers) {
  expect_same("zwidth analyze devices/lhifam.toml --json --set 'loop.delay=250 us' --set 'wall.stiffness=5 N/mm'",
              "zwidth analyze devices/lhifam.toml --json --set loop.delay=250e-6 --set wall.stiffness=5000");
  expect_same("zwidth simulate devices/lhifam.toml --json --set wall.stiffness=5kN/m --duration '300 ms' --jitter 10us",
              "zwidth simulate devices/lhifam.toml --json --set wall.stiffness=5e3 --duration 0.3 --jitter 1e-5");
  expect_same("zwidth bode devices/lhifam.toml --json --from '60 rpm' --to 100",
              "zwidth bode devices/lhifam.toml --json --from 6.283185307179586 --to 100");
  expect_same("zwidth excite --amplitude 1 --rate '0.5 kHz' --duration 500ms --json",
              "zwidth excite --amplitude 1 --rate 500 --duration 0.5 --json");
  expect_same("zwidth diagnose devices/lhifam.toml --json --oscillates-hz '0.041 kHz' --stiffness '7 kN/m'",
              "zwidth diagnose devices/lhifam.toml --json --oscillates-hz 41 --stiffness 7000");
  expect_same("zwidth design devices/lhifam.toml --json --target '12 kN/m'",
              "zwidth design devices/lhifam.toml --json --target 12000");
  expect_same("zwidth design devices/quanser_torsion.toml --json --sweep 'link.stiffness=0.01 N m/deg:2 N m/rad:3'",
              "zwidth design devices/quanser_torsion.toml --json --sweep link.stiffness=0.5729577951308232:2:3");
  expect_same(
      "zwidth relay devices/quanser_torsion.toml --json --amplitude '500 mN m' --start '1 deg' --duration 2s",
      "zwidth relay devices/quanser_torsion.toml --json --amplitude 0.5 --start 0.017453292519943295 --duration 2");
}

TEST_F(UnitsOnTheCommandLine, OfValuesWithSeveralPartsAreTheSameNumbers) {
  expect_same("zwidth analyze devices/lhifam.toml --json --users 'mass=0:500 g,damping=1 N s/m:2,stiffness=0.1 N/mm'",
              "zwidth analyze devices/lhifam.toml --json --users mass=0:0.5,damping=1:2,stiffness=100");
  expect_same("zwidth design devices/lhifam.toml --json --compare sensed=motor,handle --operator '500 g,6,0.135 N/mm'",
              "zwidth design devices/lhifam.toml --json --compare sensed=motor,handle --operator 0.5,6,135");
  expect_same(
      "zwidth simulate devices/lhifam.toml --json --set wall.stiffness=5e3 --duration 0.3 --overrun '20 %,250 us' "
      "--start 'handle=2 mm' --start-velocity '30 mm/s'",
      "zwidth simulate devices/lhifam.toml --json --set wall.stiffness=5e3 --duration 0.3 --overrun 0.2,250e-6 "
      "--start handle=0.002 --start-velocity 0.03");
}

TEST_F(UnitsOnTheCommandLine, OfTheOtherMotionAreRefused) {
  expect_refusal("zwidth analyze devices/lhifam.toml --users 'mass=0:5 kg cm^2'",
                 "--users: mass: '0:5 kg cm^2' must be LEAST:GREATEST or one number: \"kg cm^2\" is no unit of a mass");
  expect_refusal("zwidth simulate devices/lhifam.toml --set wall.stiffness=5000 --start '3 deg'",
                 "--start: '3 deg': \"deg\" is no unit of a length");
  expect_refusal("zwidth design devices/lhifam.toml --target '12 N m/rad'",
                 "--target: \"N m/rad\" is no unit of a stiffness; must be a number of N/m");
  expect_refusal("zwidth relay devices/quanser_torsion.toml --amplitude 5N",
                 "--amplitude: \"N\" is no unit of a torque; must be a number of N m");
  expect_refusal("zwidth simulate devices/lhifam.toml --set wall.stiffness=5000 --wall-position '3 deg'",
                 "--wall-position: \"deg\" is no unit of a length");
  expect_refusal("zwidth design devices/lhifam.toml --sweep 'loop.delay=0 m:4 ms:3'",
                 "--sweep: \"loop.delay=0 m:4 ms:3\": FIRST: \"m\" is no unit of a time");
}

TEST_F(UnitsOnTheCommandLine, OfTheWrongKindAreRefused) {
  expect_refusal(
      "zwidth simulate devices/lhifam.toml --duration '300 mm'",
      "simulate: --duration: \"mm\" is no unit of a time; must be a number of s, or a text with its unit such "
      "as \"1.5 ms\"");
  expect_refusal("zwidth analyze devices/lhifam.toml --set 'wall.stiffness=5 N m/deg'",
                 "--set: wall.stiffness: \"N m/deg\" is no unit of a stiffness");
  expect_refusal("zwidth excite --amplitude 1 --rate '1 ms'", "excite: --rate: \"ms\" is no unit of a frequency");
  expect_refusal("zwidth excite --amplitude 1 --rate abc", "excite: --rate: \"abc\" is no number; must be");
}

TEST_F(UnitsOnTheCommandLine, WholeNumbersAreThoseThatAreWritten) {
  const std::string device = " devices/lhifam.toml --json ";
  expect_refusal("zwidth bode" + device + "--points -5", "--points: is -5; a whole number, 0 or more");
  expect_refusal("zwidth bode" + device + "--points 1", "--points: is 1; must be 2 to 100000");
  for (const char* text : {"abc", "0x20", "1e3", "4.5"}) {
    expect_refusal("zwidth bode" + device + "--points " + text,
                   std::string("--points: is ") + text + "; a whole number, 0 or more");
  }
  expect_refusal("zwidth bode" + device + "--points 99999999999999999999",
                 "--points: is 99999999999999999999; a whole number from 0 to 18446744073709551615");
  EXPECT_EQ(run("zwidth bode" + device + "--points 010").output, run("zwidth bode" + device + "--points 10").output);
  expect_refusal("zwidth relay" + device + "--amplitude 5 --seed -1", "--seed: is -1; a whole number, 0 or more");
  expect_refusal("zwidth relay" + device + "--amplitude 5 --trials 0", "--trials: is 0; a whole number from 1 to 1000");
  expect_refusal("zwidth relay" + device + "--amplitude 5 --segment -5",
                 "--segment: is -5; a whole number from 64 to 16777216");
  expect_refusal("zwidth serve --port -1", "--port: is -1; a whole number from 0 to 65535");
  expect_refusal("zwidth frf recordings/locked_chirp.csv --force force --position position --period 0",
                 "--period: is 0; a whole number, 1 or more");
  expect_refusal("zwidth identify recordings/locked_chirp.csv --force force --position position --decimation -2",
                 "--decimation: is -2; a whole number, 0 or more");
}

}  // namespace
}  // namespace zwidth::cli
