#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "cli/rig_workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(Rig, TellsWhatItCannotDo) {
  expect_refused("wall " + lhifam, 2, "wall.stiffness: is missing");
  expect_refused("limit " + lhifam + "--stiffness 3", 2, "--stiffness: is not for rig limit");
  expect_refused("check " + lhifam + "--amplitude 3", 2, "--amplitude: is not for rig check");
  expect_refused("check " + lhifam + "--duration 1e9", 2, "--duration: is 1000000000 s");
  expect_refused("check " + lhifam + "--duration nan", 2, "--duration");
  expect_refused("limit " + lhifam + "--amplitude 0", 2, "--amplitude: is 0");
  expect_refused("limit " + lhifam + "--from 3 --ceiling 2", 2, "--ceiling: is 2");
  expect_refused("limit " + lhifam + "--force-limit -1", 2, "--force-limit: is -1");
  expect_refused("limit " + lhifam + "--ramp -1", 2, "--ramp: is -1");
  expect_refused("limit " + lhifam + "--set actuator.force_limit=5 --force-limit 6", 2, "at most actuator.force_limit");
  expect_refused("limit " + lhifam + "--set actuator.force_limit=5 --amplitude 6", 2, "at most the force limit");
  expect_refused("limit " + lhifam + "--flight-record a.html --report a.html", 2, "is the same file");
  expect_refused("limit " + lhifam + "--flight-record devices/lhifam.toml", 2, "would overwrite the device file");
  expect_refused("check " + lhifam + "--output-device a.toml", 2, "--output-device: a simulated device");
  expect_refused("check " + lhifam + "--delays a.txt", 2, "--delays: a simulated device");
  expect_refused("measure " + lhifam + "--delays a.txt", 2, "--delays: is not for rig measure");
  expect_refused("check " + lhifam + "--driver serial", 2, "--driver: serial: is none; simulated, odrive:PORT");
  expect_refused("check " + lhifam + "--driver udp:127.0.0.1:9", 2, "--force-limit: missing");
  expect_refused("check " + lhifam + "--driver udp:127.0.0.1:9 --force-limit 1", 2, "--position-limit: missing");
  expect_refused("check " + lhifam + "--driver udp:127.0.0.1:9 --force-limit 1 --position-limit 1", 1,
                 "does not answer");
  const std::string limits = "--force-limit 1 --position-limit 1 ";
  for (const std::string port : {"0", "-1", "99999", "4711x"}) {
    expect_refused("check " + lhifam + "--driver udp:127.0.0.1:" + port + " " + limits, 2, "is none; 1 to 65535");
  }
  for (const std::string address : {"", "9", "127.0.0.1", "127.0.0.1:", ":9", "::1:9", "[::1]", "[::1:9"}) {
    expect_refused("check " + lhifam + "--driver udp:" + address + " " + limits, 2, "--driver: udp:" + address + ": ");
    expect_refused("check " + lhifam + "--driver udp:" + address + " " + limits, 2, "udp:HOST:PORT");
  }
  for (const std::string kind : {"odrive", "simplefoc", "moteus", "vesc", "serial"}) {
    expect_refused("check " + lhifam + "--driver " + kind + ": " + limits, 2,
                   "--driver: " + kind + ":: names no port; a serial port, such as /dev/ttyUSB0");
    expect_refused("check " + lhifam + "--driver " + kind + " " + limits, 2, "--driver: " + kind + ": is none; ");
  }
  for (const std::string kind : {"odrive-can", "moteus-can", "vesc-can"}) {
    for (const std::string adapter : {"", "@115200", "can0@115200", "/dev/ttyUSB0@fast"}) {
      expect_refused("check " + lhifam + "--driver " + kind + ":" + adapter + " " + limits, 2,
                     "names no port or interface; a serial port with an SLCAN adapter or an fdcanusb");
    }
    expect_refused("check " + lhifam + "--driver " + kind + " " + limits, 2, "--driver: " + kind + ": is none; ");
  }
  expect_refused("check " + lhifam + "--driver serial:/dev/null " + limits, 1, "is no serial port");
  expect_refused("check " + lhifam + "--driver serial:/dev/null --set loop.sampling_period=1e-4 " + limits, 1,
                 "the line is too slow: 38 bytes per cycle");
  expect_refused("check " + lhifam + "--driver odrive:/dev/null " + limits, 2, "driver: is missing");
  expect_refused("check " + lhifam + "--driver odrive:/dev/null --set driver.gear=2 " + limits, 2,
                 "driver.travel: is missing");
  const std::string belt = "--set driver.travel='25 mm' --set loop.sampling_period=0.02 ";
  expect_refused("check " + lhifam + "--driver odrive:/dev/null " + belt + limits, 1, "is no serial port");
  expect_refused("check " + lhifam + "--driver odrive:/dev/null " + belt + "--set loop.sampling_period=0.001 " + limits,
                 1, "the line is too slow");
  const std::string on_bus = belt + "--set driver.id=1 --set driver.torque_constant=0.05 " + limits;
  for (const std::string kind : {"odrive-can", "moteus-can", "vesc-can"}) {
    expect_refused("check " + lhifam + "--driver " + kind + ":/dev/null " + on_bus, 1, "is no serial port");
    expect_refused("check " + lhifam + "--driver " + kind + ":no_such_interface " + on_bus, 1, "cannot be opened");
    expect_refused("check " + lhifam + "--driver " + kind + ":/dev/null " + limits, 2, "driver: is missing");
  }
  expect_refused("check " + lhifam + "--driver vesc-can:/dev/null --set driver.torque_constant=0.05 " + belt + limits,
                 2, "driver.id: is missing");
  expect_refused("check " + lhifam + "--driver odrive-can:/dev/null --set driver.id=63 " + belt + limits, 1,
                 "driver.id is 63; 0 to 62");
  expect_refused("check " + lhifam + "--driver moteus-can:/dev/null --set driver.id=200 " + belt + limits, 1,
                 "driver.id is 200; a moteus has 1 to 127");
  expect_refused("check " + lhifam + "--driver vesc-can:/dev/null --set driver.id=254 " + belt + limits, 2,
                 "driver.id: is 254; must be a whole number from 0 to 253");
  expect_refused("check " + lhifam + "--driver udp:h:9 --start 1", 2, "--start: is for a simulated device");
}

TEST_F(Rig, RunsADamperOnTheDriveWhereTheFileStatesItsLoop) {
  const std::string apart = lhifam + "--set wall.damping=50 --set loop.damper.sampling_period=1e-4 ";
  const std::string limits = "--force-limit 1 --position-limit 1 --damper-on-drive ";
  expect_refused("wall " + apart + "--stiffness 4000", 2, "--damper-on-drive: devices/lhifam.toml: is not given");
  expect_refused("limit " + apart, 2, "--damper-on-drive: devices/lhifam.toml: is not given");
  expect_refused("relay " + apart, 2, "--damper-on-drive: devices/lhifam.toml: is not given");
  expect_refused("wall " + lhifam + "--stiffness 4000 --damper-on-drive", 2, "and the device has no [loop.damper]");
  expect_refused("wall " + apart + "--stiffness 4000 --damper-on-drive --contact unilateral", 2, "--contact: ");
  expect_refused("check " + apart + "--damper-on-drive", 2, "--damper-on-drive: is not for rig check");
  expect_refused("identify " + apart, 2, "which may have been closed around the record");
  const std::string slow = lhifam + "--set wall.damping=50 --set loop.damper.sampling_period=2e-3 --damper-on-drive ";
  expect_refused("wall " + slow + "--stiffness 4000", 2, "a damper on the drive runs faster than the spring");
  for (const std::string driver :
       {"vesc:/dev/null", "serial:/dev/null", "udp:127.0.0.1:9", "odrive-can:can0", "vesc-can:can0"}) {
    expect_refused(
        "wall " + apart + limits + "--stiffness 4000 --driver " + driver, 2,
        "closes no damper beside the force that it is sent; simulated, odrive, moteus, moteus-can and simplefoc do");
  }
}

// Found only after the rig had run, the record was lost or elsewhere.
TEST_F(Rig, WhatCannotBeWrittenIsToldBeforeAnythingRuns) {
  write("file", "");
  for (const std::string option : {"--flight-record ", "--recording ", "--output-device ", "--report "}) {
    for (const auto& [place, what] :
         {std::pair("no/such/folder/x.html", "cannot write: No such file or directory; make the folder first"),
          std::pair("file/x.html", "cannot write: Not a directory; make the folder first"),
          std::pair("/proc/x.html", "cannot write: ")}) {
      const Outcome outcome = run("zwidth rig identify " + lhifam + option + place);
      EXPECT_EQ(outcome.status, 1) << option << place;
      EXPECT_THAT(outcome.output, IsEmpty()) << option << place;
      EXPECT_THAT(outcome.errors,
                  ::testing::StartsWith("zwidth: " + option.substr(0, option.size() - 1) + ": " + place + ": " + what));
    }
  }
  // Before the drive is asked for anything: this one is not there.
  expect_refused("check " + lhifam + "--driver udp:127.0.0.1:9 --force-limit 1 --position-limit 1 --flight-record no/f",
                 1, "make the folder first");
  expect_refused("check " + lhifam + "--flight-record devices", 1, "is a directory; give a file");
  expect_refused("check " + lhifam + "--flight-record f.csv --duration -1", 2, "--duration");
  EXPECT_EQ(run("ls -A | grep -c -e part -e f.csv").output, "0\n") << "nothing is left behind";
}

}  // namespace
}  // namespace zwidth::cli
