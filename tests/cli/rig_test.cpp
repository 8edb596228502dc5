#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/rig_workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(Rig, LimitStandsBesideThePrediction) {
  const auto limit = json("limit " + lhifam + "--set sensor.resolution=0");
  EXPECT_EQ(limit["schema"], "zwidth.rig_limit/1");
  const double measured = limit["measured"]["critical_stiffness"];
  EXPECT_NEAR(measured / 8848.70869499712, 1.0, 1e-3);
  EXPECT_NEAR(limit["measured"]["frequency_rad_s"].get<double>() / 38.5965268731856, 1.0, 1e-3);
  EXPECT_DOUBLE_EQ(limit["predicted"]["critical_stiffness"], 8848.70869499712);
  EXPECT_NEAR(limit["any_user"]["critical_stiffness"], 5776.09, 0.1);
  EXPECT_LT(limit["measured"]["stiffest_stable"].get<double>(), limit["measured"]["softest_unstable"].get<double>());
  EXPECT_TRUE(limit["trials"].back()["grows"].is_boolean());
  EXPECT_EQ(limit["trust"]["verdict"], "sound");
  EXPECT_TRUE(limit["session"]["stop"].is_null());
  EXPECT_EQ(limit["session"]["driver"], "simulated");
}

TEST_F(Rig, FrictionMakesTheMeasuredLimitDoubtful) {
  EXPECT_EQ(json("limit " + lhifam + "--set body.motor.coulomb=0.01")["trust"]["verdict"], "doubtful");
}

// A limit of 293 % of the truth was sure.
TEST_F(Rig, FrictionMakesTheMeasuredResponseDoubtful) {
  const auto measured = json("measure " + lhifam + "--set body.motor.coulomb=0.1");
  EXPECT_NE(measured["trust"]["verdict"], "sound");
  EXPECT_THAT(measured["trust"]["reasons"].dump(), HasSubstr("dry friction, which a response shows as damping"));
  EXPECT_THAT(json("measure " + lhifam)["trust"]["reasons"].dump(),
              ::testing::Not(HasSubstr("dry friction, which a response shows as damping")));
}

// What a slow swing leaks into the window of a mode at 1.2 kHz took every wall away.
TEST_F(Rig, AStiffModeDoesNotTakeStableWallsAway) {
  write("stiff.toml",
        "name = 'stiff'\nmotion = 'linear'\n[[body]]\nname = 'a'\nmass = 0.32538\ndamping = 0.3013\n[[body]]\nname = "
        "'b'\nmass = 0.58718\ndamping = 0.24674\n[[link]]\nbetween = ['a', 'b']\nstiffness = 38989272\ndamping = "
        "141.43\n[loop]\nsampling_period = 0.00029697416407800236\ndelay = 0.00044546124611700354\n");
  EXPECT_EQ(json("wall stiff.toml --stiffness 100")["oscillates"], false);
  const auto limit = json("limit stiff.toml");
  EXPECT_EQ(limit["trust"]["verdict"], "sound");
  EXPECT_NEAR(
      limit["measured"]["critical_stiffness"].get<double>() / limit["predicted"]["critical_stiffness"].get<double>(),
      1.0, 1e-3);
}

// Two modes that beat are misread: by 1.9 %, with an interval that left the limit out. A coarse encoder turns the
// position's first harmonic: the interval lay beside the limit.
TEST_F(Rig, TheIntervalHoldsTheLimitOfWhatIsHardToRead) {
  write(
      "light.toml",
      "name = 'light'\nmotion = 'linear'\n[[body]]\nname = 'a'\nmass = 6.689799636747895\ndamping = "
      "2.1422277171255732\n[[body]]\nname = 'b'\nmass = 12.23176253530978\ndamping = 0.1643286799588767\n[[link]]\n"
      "between = ['a', 'b']\nstiffness = 12814.141110966739\ndamping = 0.01253007731273907\n[loop]\nsampling_period = "
      "0.0014146124008041557\n");
  write("coarse.toml",
        "name = 'coarse'\nmotion = 'linear'\n[[body]]\nname = 'a'\nmass = 0.23261984902081026\ndamping = "
        "0.12490299355548388\n[loop]\nsampling_period = 0.004227551492404152\n[sensor]\nresolution = "
        "1.8687220307535726e-05\n");
  for (const std::string file : {"light.toml", "coarse.toml"}) {
    const auto limit = json("limit " + file);
    const double truth = limit["predicted"]["critical_stiffness"];
    EXPECT_LE(limit["measured"]["critical_stiffness_interval"][0].get<double>(), truth) << file;
    EXPECT_GE(limit["measured"]["critical_stiffness_interval"][1].get<double>(), truth) << file;
  }
  EXPECT_EQ(json("limit light.toml")["trust"]["verdict"], "doubtful");
}

TEST_F(Rig, ADoubtfulDeviceOnlyWhereThatIsAccepted) {
  for (const std::string action : {"check", "measure", "identify", "relay", "wall", "limit"}) {
    const std::string wall = action == "wall" ? "--stiffness 3000 " : "";
    expect_refused(action + " " + lhifam + doubtful + wall, 1, "--accept-doubt");
  }
  EXPECT_EQ(json("limit " + lhifam + doubtful + "--accept-doubt")["trust"]["verdict"], "doubtful");
}

TEST_F(Rig, ARefusedDeviceNever) {
  const std::string refused = "--set uncertainty.verdict=refused --set uncertainty.warning=none ";
  for (const std::string accept : {"", "--accept-doubt"}) {
    const Outcome outcome = run("zwidth rig wall " + lhifam + refused + "--stiffness 3000 " + accept);
    EXPECT_EQ(outcome.status, 1) << outcome.errors;
    EXPECT_THAT(outcome.output, IsEmpty());
  }
}

// In the simulated device nothing is measured that its file does not say.
TEST_F(Rig, EveryActionRepeatsTheDoubtOfTheFile) {
  const std::string accepted = "--set uncertainty.verdict=doubtful --set uncertainty.warning=guessed --accept-doubt ";
  for (const std::string action : {"check", "measure", "identify --duration 4 --output-device found.toml",
                                   "relay --amplitude 5 --trials 1", "wall --stiffness 3000", "limit"}) {
    const auto document = json(action + " " + lhifam + accepted);
    EXPECT_EQ(document["trust"]["verdict"], "doubtful") << action;
    EXPECT_EQ(document["trust"]["reasons"][0], "guessed") << action;
    const Outcome text = run("zwidth rig " + action + " " + lhifam + accepted);
    EXPECT_THAT(text.output, HasSubstr("guessed")) << action;
  }
  const auto found = nlohmann::json::parse(run("zwidth analyze found.toml --json").output, nullptr, false);
  EXPECT_EQ(found["trust"]["verdict"], "doubtful");
  EXPECT_THAT(found["trust"]["reasons"].dump(), HasSubstr("guessed"));
}

TEST_F(Rig, AnUnstableWallIsRefusedAndIfAcceptedTakenAwayAtOnce) {
  expect_refused("wall " + lhifam + "--stiffness 20000", 1, "UNSTABLE");
  const Outcome outcome = run("zwidth rig wall --json " + lhifam +
                              "--stiffness 20000 --accept-unstable --duration 60 --flight-record f.csv");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("an oscillation grew"));
  const auto wall = nlohmann::json::parse(outcome.output, nullptr, false);
  EXPECT_EQ(wall["oscillates"], true);
  EXPECT_EQ(wall["predicted_stable"], false);
  EXPECT_GT(wall["oscillation"]["growth_rate_per_s"], 0.0);
  const auto stable = json("wall " + lhifam + "--stiffness 4000");
  EXPECT_EQ(stable["oscillates"], false);
  EXPECT_EQ(stable["predicted_stable"], true);
  EXPECT_LT(stable["oscillation"]["growth_rate_per_s"], 0.0);
}

// An oscillation may grow too slowly to be taken away, or an end without alarm look like success.
TEST_F(Rig, AnUnstableWallThatWasNotTakenAwayNeverLooksSure) {
  for (const std::string stiffness : {"8900", "9500"}) {
    const std::string wall = "wall " + lhifam + "--accept-unstable --stiffness " + stiffness;
    const Outcome outcome = run("zwidth rig --json " + wall);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("the wall is UNSTABLE: its oscillation grows"));
    const auto document = nlohmann::json::parse(outcome.output, nullptr, false);
    EXPECT_EQ(document["oscillates"], false);
    EXPECT_EQ(document["trust"]["verdict"], "doubtful");
    EXPECT_THAT(document["trust"]["reasons"].dump(), HasSubstr("grew too slowly to be taken away"));
    EXPECT_THAT(run("zwidth rig " + wall).output, HasSubstr("do not carry the wall, because"));
  }
  const auto quiet = json("wall " + lhifam + "--accept-unstable --stiffness 8900 --duration 0.6");
  EXPECT_EQ(quiet["trust"]["verdict"], "doubtful");
  EXPECT_THAT(quiet["trust"]["reasons"].dump(),
              HasSubstr("UNSTABLE by linear analysis, with nobody holding: that no oscillation"));
  EXPECT_EQ(json("wall " + lhifam + "--stiffness 8800")["trust"]["verdict"], "sound");
}

// A stable wall that a limit ended was sure; of an unstable one that ran into it no oscillation was said to be seen.
TEST_F(Rig, AWallThatDidNotRunToItsEndIsDoubtful) {
  const auto wall_of = [&](const std::string& options) {
    const Outcome outcome = run("zwidth rig wall --json " + lhifam + options);
    EXPECT_EQ(outcome.status, 1);
    return nlohmann::json::parse(outcome.output, nullptr, false);
  };
  const auto stable = wall_of("--stiffness 4000 --position-limit 1e-5");
  EXPECT_EQ(stable["session"]["stop"], "position_limit");
  EXPECT_EQ(stable["trust"]["verdict"], "doubtful");
  EXPECT_THAT(stable["trust"]["reasons"].dump(), HasSubstr("the rig stopped before the wall's time was over"));
  const auto unstable = wall_of("--stiffness 20000 --accept-unstable --position-limit 1e-3");
  EXPECT_EQ(unstable["session"]["stop"], "position_limit");
  EXPECT_EQ(unstable["trust"]["verdict"], "doubtful");
  EXPECT_THAT(unstable["trust"]["reasons"].dump(),
              HasSubstr("UNSTABLE by linear analysis, with nobody holding: render softer"));
  EXPECT_THAT(unstable["trust"]["reasons"].dump(), Not(HasSubstr("was seen to grow")));
}

// 23 % too little and 16 % too much were read from walls whose force was cut off, 32 % too much under a long ramp.
TEST_F(Rig, NoLimitIsReadFromForceThatWasCutOff) {
  for (const std::string force : {"9", "10", "12", "13"}) {
    const auto limit = json("limit " + lhifam + "--amplitude 8.8 --saturation 100 --force-limit " + force);
    EXPECT_EQ(limit["trust"]["verdict"], "refused") << force;
    EXPECT_TRUE(limit["measured"]["critical_stiffness"].is_null()) << force;
    EXPECT_TRUE(limit["measured"]["stiffest_stable"].is_null()) << force;
    EXPECT_THAT(limit["trust"]["reasons"].dump(), HasSubstr("the force was cut off")) << force;
  }
  for (const std::string allowed : {"--force-limit 12", "--ramp 10"}) {
    const auto limit = json("limit " + lhifam + allowed);
    EXPECT_EQ(limit["trust"]["verdict"], "sound") << allowed;
    EXPECT_NEAR(limit["measured"]["critical_stiffness"].get<double>() / 8848.70869499712, 1.0, 0.02) << allowed;
  }
  expect_refused("limit " + lhifam + "--ramp 150", 2, "--ramp: is 150 s; must be from 0 to 10");
  const auto wall = json("wall " + lhifam + "--stiffness 4000 --amplitude 8.8 --force-limit 9 --saturation 9");
  EXPECT_THAT(wall["trust"]["reasons"].dump(), HasSubstr("force was kept back"));
  const auto ramp = json("wall " + lhifam + "--stiffness 4000 --duration 1 --ramp 10");
  EXPECT_THAT(ramp["trust"]["reasons"].dump(), HasSubstr("force was kept back"));
}

TEST_F(Rig, ALimitWithoutATrialSaysSo) {
  const Outcome outcome = run("zwidth rig limit " + lhifam + "--position-limit 1e-9 --json");
  const auto limit = nlohmann::json::parse(outcome.output, nullptr, false);
  EXPECT_EQ(limit["trust"]["reasons"][0], "no trial came to its end");
}

// Without damping no wall is stable; trials too short to see that made 797 N/m a sure limit.
TEST_F(Rig, NoLimitIsSureWhereSofterWallsWereNotRead) {
  write("free.toml",
        "name = 'free'\nmotion = 'linear'\n[[body]]\nname = 'm'\nmass = 1.0\n[loop]\nactuated = 'm'\nsensed = 'm'\n"
        "held = 'm'\nsampling_period = 1e-3\n");
  const auto limit = json("limit free.toml --from 100 --ceiling 1000");
  EXPECT_EQ(limit["trust"]["verdict"], "doubtful");
  EXPECT_THAT(limit["trust"]["reasons"].dump(), HasSubstr("softer walls may grow unseen"));
  EXPECT_TRUE(limit["measured"]["critical_stiffness_interval"].is_null());
  const auto watched = json("limit free.toml --from 3000 --ceiling 3000 --duration 20");
  EXPECT_EQ(watched["trials"][0]["stopped"], true) << "where nothing is predicted, nothing was watched";
}

// The wall that holds the device between trials was that of the start, unwatched, after the start had been found unstable.
TEST_F(Rig, AStartThatIsUnstableDoesNotHoldTheDevice) {
  const auto limit = json("limit " + lhifam + "--from 12000 --duration 60 --position-limit 0.02");
  EXPECT_EQ(limit["trials"][0]["grows"], true);
  EXPECT_TRUE(limit["session"]["stop"].is_null());
  EXPECT_NEAR(limit["measured"]["critical_stiffness"].get<double>() / 8848.70869499712, 1.0, 0.02);
}

// Swung from force limit to force limit for 17 of 20 s, with status 0.
TEST_F(Rig, ASwingBetweenTheForceLimitsEndsTheWall) {
  write("belt.toml",
        "name = 'belt'\nmotion = 'linear'\n[[body]]\nname = 'm'\nmass = 0.3\ndamping = 2\n[loop]\nactuated = 'm'\n"
        "sensed = 'm'\nheld = 'm'\nsampling_period = 0.01\n");
  const Outcome outcome =
      run("zwidth rig wall belt.toml --stiffness 1000 --force-limit 5 --amplitude 0.5 --accept-unstable --duration 20 "
          "--json");
  EXPECT_EQ(outcome.status, 1);
  const auto wall = nlohmann::json::parse(outcome.output, nullptr, false);
  EXPECT_EQ(wall["session"]["stop"], "saturation");
  EXPECT_LT(wall["session"]["stopped_at_s"].get<double>(), 3.0);
}

TEST_F(Rig, TheKnockFitsTheForceLimit) {
  for (const std::string action :
       {"measure ", "identify --duration 4 ", "relay --trials 1 ", "wall --stiffness 4000 ", "limit "}) {
    const Outcome outcome = run("zwidth rig " + action + lhifam + "--force-limit 6");
    EXPECT_EQ(outcome.status, 0) << action << outcome.errors;
  }
  EXPECT_DOUBLE_EQ(json("limit " + lhifam + "--force-limit 6")["knock"].get<double>(), 2.0);
}

// Where there is no measurement its trust was the device file's: sound.
TEST_F(Rig, WhatStoppedHasNoSoundAnswer) {
  for (const std::string action : {"measure", "identify", "relay", "limit"}) {
    const Outcome outcome = run("zwidth rig " + action + " " + lhifam + "--velocity-limit 1e-9 --json");
    EXPECT_EQ(outcome.status, 1) << action;
    const auto document = nlohmann::json::parse(outcome.output, nullptr, false);
    EXPECT_EQ(document["trust"]["verdict"], "refused") << action;
    EXPECT_THAT(document["trust"]["reasons"].dump(), HasSubstr("the velocity went beyond its limit")) << action;
  }
}

TEST_F(Rig, LimitsEndTheSessionAndTheRecordIsThere) {
  const Outcome outcome = run("zwidth rig wall " + lhifam +
                              "--stiffness 4000 --amplitude 50 --position-limit 1e-3 --flight-record f.csv --json");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("the position went beyond its limit"));
  const auto document = nlohmann::json::parse(outcome.output, nullptr, false);
  EXPECT_EQ(document["session"]["stop"], "position_limit");
  std::istringstream file(contents("f.csv"));
  std::string line;
  std::string last;
  std::size_t rows = 0;
  while (std::getline(file, line)) last = line, ++rows;
  EXPECT_EQ(rows, 1 + document["session"]["timing"]["cycles"].get<std::size_t>());
  EXPECT_THAT(last, ::testing::EndsWith(",3")) << "position_limit";
}

TEST_F(Rig, WhereNobodySaysWhereARigThatStoppedPutsItsRecordInAPlaceOfItsOwn) {
  const std::string stops = "zwidth rig wall " + lhifam + "--stiffness 4000 --amplitude 50 --position-limit 1e-3 ";
  const Outcome outcome =
      run("export XDG_STATE_HOME=$PWD/state; " + stops + "&& exit 9; cat state/zwidth/flight-*.csv");
  EXPECT_THAT(outcome.errors, HasSubstr("zwidth: flight record: "));
  EXPECT_THAT(outcome.errors, HasSubstr("/state/zwidth/flight-"));
  EXPECT_THAT(outcome.output, HasSubstr("time_s,force,position,velocity,wanted_force,latency_s,stop"));
  EXPECT_THAT(outcome.output, ::testing::EndsWith(",3\n")) << "position_limit";
  const Outcome oscillating = run("export XDG_STATE_HOME=$PWD/other; zwidth rig wall " + lhifam +
                                  "--stiffness 20000 --accept-unstable --duration 60; ls other/zwidth | wc -l");
  EXPECT_THAT(oscillating.output, ::testing::EndsWith("1\n")) << "a wall that was taken away";
  const Outcome nowhere = run("export TMPDIR=/no/such XDG_STATE_HOME=/dev/null/no; " + stops);
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_THAT(nowhere.errors, HasSubstr("name a file with --flight-record"));
  EXPECT_THAT(nowhere.errors, HasSubstr("the position went beyond its limit"));
  EXPECT_EQ(run("export XDG_STATE_HOME=$PWD/none; zwidth rig wall " + lhifam + "--stiffness 4000; ls none").status, 2)
      << "one that came to its end";
}

// A line that is written over, about ten times a second; lines as of a log where there is no terminal; no colours where
// they are not wanted.
TEST_F(Rig, ATerminalShowsWhatTheLoopDoes) {
  const std::string wall =
      "zwidth rig wall " + lhifam +
      "--stiffness 20 --real-time --duration 3 --set loop.sampling_period=0.02 --flight-record f.csv";
  const Outcome seen = run("export TERM=xterm NO_COLOR=1; script -qec '" + wall + "' /dev/null");
  EXPECT_THAT(seen.output, HasSubstr("\r\x1b[K"));
  EXPECT_THAT(seen.output, HasSubstr(" s  K 20 N/m  B 0 N s/m  F "));
  EXPECT_THAT(seen.output, HasSubstr("worst "));
  EXPECT_THAT(seen.output, ::testing::Not(HasSubstr("\x1b[3")));
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = seen.output.find("\x1b[K", at)) != std::string::npos; ++at) ++lines;
  EXPECT_LE(lines, 32U);
  const Outcome logged = run(wall);
  EXPECT_THAT(logged.errors, ::testing::Not(HasSubstr("\x1b")));
}

// It was cut in the middle, and its numbers lost their units.
TEST_F(Rig, ANarrowTerminalShowsFewerNumbersEachWithItsUnit) {
  const std::string wall =
      "zwidth rig wall " + lhifam +
      "--stiffness 20 --real-time --duration 1 --set loop.sampling_period=0.02 --flight-record f.csv";
  const auto longest_line = [&](int columns) {
    const Outcome seen =
        run(fmt::format("export TERM=xterm NO_COLOR=1; script -qec 'stty cols {}; {}' /dev/null", columns, wall));
    std::string longest;
    for (std::size_t at = 0; (at = seen.output.find("\x1b[K", at)) != std::string::npos;) {
      at += 3;
      const std::size_t end = seen.output.find('\r', at);
      if (end == std::string::npos || seen.output.compare(end, 2, "\r\x1b") != 0) break;  // the answer
      if (end - at > longest.size()) longest = seen.output.substr(at, end - at);
    }
    return longest;
  };
  const std::string wide = longest_line(80);
  EXPECT_LE(wide.size(), 82U) << "micro has two bytes";
  EXPECT_THAT(wide, HasSubstr(" s  K 20 N/m"));
  const std::string narrow = longest_line(40);
  EXPECT_LE(narrow.size(), 41U);
  EXPECT_THAT(narrow, ::testing::ContainsRegex("F +-?[0-9.]+ .?.?N  x +-?[0-9.]+ .?.?m"));
  EXPECT_THAT(narrow, ::testing::Not(HasSubstr("worst")));
  EXPECT_THAT(longest_line(20), ::testing::ContainsRegex("^F +-?[0-9.]+ .?.?N"));
}

TEST_F(Rig, TheFlightRecordIsReadByTheOtherCommands) {
  ASSERT_EQ(run("zwidth rig measure " + lhifam + "--duration 4 --flight-record f.csv --recording r.csv").status, 0);
  const Outcome frf = run("zwidth frf f.csv --force force --position position --json");
  EXPECT_EQ(frf.status, 0) << frf.errors;
  const Outcome identified =
      run("zwidth identify r.csv --force force --position position --structure devices/lhifam_rigid.toml --json");
  EXPECT_EQ(identified.status, 0) << identified.errors;
  const auto document = nlohmann::json::parse(identified.output, nullptr, false);
  EXPECT_EQ(document["schema"], "zwidth.identification/1");
  EXPECT_EQ(run("zwidth diagnose " + lhifam + "--recording f.csv --position position").status, 0);
}

TEST_F(Rig, IdentifyWritesTheDevice) {
  const std::string rigid = "devices/lhifam_rigid.toml --duration 4 --force-limit 6 --output-device found.toml";
  ASSERT_EQ(run("zwidth rig identify " + rigid).status, 0);
  const Outcome outcome = run("zwidth analyze found.toml --json");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NEAR(nlohmann::json::parse(outcome.output)["critical_stiffness"].get<double>() / 7000.76, 1.0, 0.03);
}

// Without noise what is left of the response is rounding, 83 times a noise that is rounding too.
TEST_F(Rig, RoundingIsNoFriction) {
  const Outcome outcome = run("zwidth rig identify devices/two_mass_drive.toml --json");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("\"verdict\""));
  EXPECT_THAT(outcome.output, ::testing::Not(HasSubstr("times its noise")));
}

// The force of a millimetre's swing did not move it against its dry friction: "the motion is constant".
TEST_F(Rig, TheDefaultForceMovesADeviceWithDryFriction) {
  const Outcome outcome = run("zwidth rig identify devices/capstan_paddle.toml --duration 12 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto found = nlohmann::json::parse(outcome.output, nullptr, false)["identification"];
  const Outcome truth = run("zwidth analyze devices/capstan_paddle.toml --json");
  const auto device = nlohmann::json::parse(truth.output, nullptr, false);
  EXPECT_LT(found["critical_stiffness_interval"][0], device["critical_stiffness"]);
  EXPECT_GT(found["critical_stiffness_interval"][1], device["critical_stiffness"]);
}

TEST_F(Rig, TheReportShowsWhatWasMeasured) {
  struct Page {
    std::string action;
    std::size_t figures;
  };
  for (const auto& [action, figures] : {Page{"check", 0}, Page{"measure", 1}, Page{"identify --duration 4", 2},
                                        Page{"relay", 1}, Page{"wall --stiffness 3000", 1}, Page{"limit", 1}}) {
    SCOPED_TRACE(action);
    EXPECT_EQ(run("zwidth rig " + action + " " + lhifam + "--report page.html").status, 0);
    const std::string page = contents("page.html");
    std::size_t drawn = 0;
    for (std::size_t at = page.find("<svg"); at != std::string::npos; at = page.find("<svg", at + 1)) ++drawn;
    EXPECT_EQ(drawn, figures);
    EXPECT_THAT(page, HasSubstr("<h1>Rig " + action.substr(0, action.find(' '))));
    EXPECT_THAT(page, ::testing::Not(HasSubstr("<pre"))) << "no lines of a terminal";
    for (const char* label : {"date", "program", "driver", "force limit", "position limit", "velocity limit"}) {
      EXPECT_THAT(page, HasSubstr(std::string("<th scope=\"row\">") + label + "</th>")) << label;
    }
    EXPECT_THAT(page, HasSubstr(">79500 N/m</td>")) << "a number of the device's file";
  }
}

TEST_F(Rig, AFigureOfNothingTakesNoPageWithIt) {
  const Outcome outcome =
      run("zwidth rig measure " + lhifam + "--position-limit 1e-5 --report page.html --figure page.svg");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(contents("page.html"), HasSubstr("</html>"));
  EXPECT_EQ(contents("page.svg"), "");
}

// gnuplot failed for want of points, and the answer was lost with the page.
TEST_F(Rig, ALimitOfWhichNothingWasReadHasAPageToo) {
  const Outcome outcome = run("zwidth rig limit " + lhifam + "--from 100 --ceiling 120 --report page.html");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("REFUSED"));
  EXPECT_THAT(contents("page.html"), HasSubstr("no oscillation grew"));
}

// A device cannot be asked again.
TEST_F(Rig, AFullDiskDoesNotTakeTheAnswer) {
  const Outcome outcome = run("zwidth rig limit " + lhifam + "--report /dev/full");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("K_CR measured"));
  EXPECT_THAT(outcome.errors, HasSubstr("/dev/full: cannot write"));
}

TEST_F(Rig, RelaySeeksTheLimitWhereAsked) {
  const auto bare = json("relay " + lhifam + "--amplitude 5 --trials 1");
  const auto sought = json("relay " + lhifam + "--amplitude 5 --trials 1 --seek-limit");
  EXPECT_GT(bare["table_2_row"]["frequency_hz"], 90.0);
  EXPECT_NEAR(sought["table_2_row"]["frequency_hz"].get<double>(), 6.4, 0.3);
  EXPECT_EQ(bare["trust"]["verdict"], "doubtful");
}

TEST_F(Rig, RelayGivesARowOfTable2) {
  const auto relay = json("relay " + lhifam + "--amplitude 5 --trials 1 --seek-limit --report relay.html");
  EXPECT_EQ(relay["relay"]["trials"].size(), 1U);
  EXPECT_EQ(relay["table_2_row"]["trials"], 1);
  EXPECT_GT(relay["table_2_row"]["frequency_hz"], 0.0);
  EXPECT_THAT(contents("relay.html"), HasSubstr("<li>The stiffest stable wall"));
  EXPECT_THAT(contents("relay.html"), HasSubstr("<th class=\"n\">trial</th><th class=\"n\">Hz</th>"));
}

TEST_F(Rig, KeepsTheClockWhereAsked) {
  const Outcome outcome =
      run("zwidth rig check " + lhifam + "--set loop.sampling_period=0.02 --real-time --duration 1 --json");
  const auto document = nlohmann::json::parse(outcome.output, nullptr, false);
  EXPECT_EQ(document["session"]["lock_step"], false);
  EXPECT_GT(document["session"]["timing"]["latency_s"]["count"], 3);
  EXPECT_NEAR(document["session"]["timing"]["period_s"]["p50"], 0.02, 0.01);
}

}  // namespace
}  // namespace zwidth::cli
