// What is told of a request that cannot be answered: the field, what was given, what is allowed.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "cli/served.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class ServedErrors : public Served {
 protected:
  ServedErrors() { start(); }
};

TEST_F(ServedErrors, AnErrorNamesTheFieldThatCausedIt) {
  const std::string device = contents("devices/lhifam.toml");
  const auto expect_place = [&](const std::string& command, const json& options, const std::string& where,
                                const std::string& text) {
    json request{{"options", options}};
    if (!text.empty()) request["device_toml"] = text;
    const HttpAnswer answer = post(command, request.dump());
    EXPECT_EQ(answer.status, 400) << command << options;
    const json error = json::parse(answer.body).at("error");
    EXPECT_EQ(error.at("where"), where) << answer.body;
    EXPECT_THAT(error.at("what").get<std::string>(), ::testing::Not(::testing::IsEmpty()));
  };
  expect_place("bode", {{"points", "abc"}}, "options.points", device);
  expect_place("bode", {{"points", 1}}, "options.points", device);
  expect_place("bode", {{"points", -5}}, "options.points", device);
  expect_place("bode", {{"from", "abc"}}, "options.from", device);
  expect_place("simulate", {{"contact", "soft"}}, "options.contact", device);
  expect_place("region", {{"raster", 1}}, "options.raster", device);
  expect_place("bode", {{"pionts", 10}}, "options.pionts", device);
  expect_place("bode", {{"from", 100}, {"to", 10}}, "options.to", device);
  expect_place("export", json::object(), "options.format", device);
  expect_place("export", {{"format", "docx"}}, "options.format", device);
  expect_place("design", {{"sweep", "loop.delay=0:1e-3:3"}, {"target", 5}}, "options.sweep", device);
  expect_place("design", {{"sweep", "loop.dely=0:1:3"}}, "options.sweep", device);
  expect_place("recommend", {{"gain-margin-db", 1000}}, "options.gain-margin-db", device);
  expect_place("simulate", {{"duration", "5 kg"}}, "options.duration", device);
  expect_place("simulate", {{"overrun", {1, 2, 3}}}, "options.overrun", device);
  expect_place("analyze", {{"users", "mass=2:1"}}, "options.users", device);
  expect_place("analyze", {{"set", "loop.delay"}}, "options.set", device);
  expect_place("diagnose", {{"oscillates-hz", 6}, {"stiffness", 1e40}}, "options.stiffness", device);
  expect_place("simulate", {{"start-velocity", 0}}, "options.start-velocity", device);
  expect_place("export", {{"format", "c"}}, "device.wall.stiffness", device);
  expect_place("analyze", {{"set", "loop.delay=-1"}}, "device.loop.delay", device);
  expect_place("analyze", json::object(), "device", "");
  expect_place("frf", {{"force", 1}}, "recording", "");
  expect_place("frf", {{"force", 1}}, "device", device);
  expect_place("analyze", json::object(), "device:1:7", "name =");
  expect_place("analyze", json::object(), "device.body.a b.mass",
               "body = [{name = \"a b\", mass = -1}]\nloop.sampling_period = 1e-3");
}

TEST_F(ServedErrors, ADamperOnTheDriveIsNamedWhereItStandsInTheWayOfARecord) {
  const json request{{"device_toml", contents("devices/lhifam_drive_damper.toml")},
                     {"recording", json::parse(upload(contents("recordings/locked_chirp.csv")).body).at("id")},
                     {"options", {{"force", "force"}, {"position", "position"}}}};
  const HttpAnswer answer = post("identify", request.dump());
  EXPECT_EQ(answer.status, 400);
  const json error = json::parse(answer.body).at("error");
  EXPECT_EQ(error.at("where"), "device.loop.damper");
  EXPECT_EQ(error.at("code"), "damper_closed_while_recorded");
  EXPECT_FALSE(error.at("allowed").get<std::string>().empty());
}

// A std::regex takes stack for every character: one such number ended the program.
TEST_F(ServedErrors, ANumberOfAHundredThousandDigitsIsRefusedAndTheServerLives) {
  const json request{{"device_toml", contents("devices/lhifam.toml")},
                     {"options", {{"amplitude", 5}, {"seed", std::string(100'000, '7')}}}};
  const HttpAnswer answer = post("relay", request.dump());
  EXPECT_EQ(answer.status, 400);
  EXPECT_EQ(json::parse(answer.body).at("error").at("where"), "options.seed");
  EXPECT_EQ(
      post("relay", json{{"device_toml", contents("devices/lhifam.toml")}, {"options", {{"amplitude", 5}}}}.dump())
          .status,
      200);
}

// The device's own reasons are not cut at their semicolons and colons into a place and what is allowed.
TEST_F(ServedErrors, WorkThatFailsHasNoPlace) {
  for (const std::string verdict : {"doubtful", "refused"}) {
    const std::string device = contents("devices/lhifam.toml") + "\n[uncertainty]\nverdict = '" + verdict +
                               "'\nreasons = ['one: a; b', 'another']\n";
    const json request{{"device_toml", device}, {"options", {{"format", "c"}, {"stiffness", 100}}}};
    const HttpAnswer answer = post("export", request.dump());
    EXPECT_EQ(answer.status, 400);
    const json error = json::parse(answer.body).at("error");
    EXPECT_EQ(error.at("where"), "") << error;
    EXPECT_THAT(error.at("what").get<std::string>(), HasSubstr("one: a; b; another")) << error;
    EXPECT_EQ(error.at("allowed"), "") << error;
  }
}

// Not by the names that the command line has for them.
TEST_F(ServedErrors, AnErrorCallsOptionsAsARequestDoes) {
  const std::string device = contents("devices/lhifam.toml");
  const auto error_of = [&](const std::string& command, const std::string& text, const json& options) {
    return json::parse(post(command, json{{"device_toml", text}, {"options", options}}.dump()).body).at("error");
  };
  const std::string doubtful = device + "\n[uncertainty]\nverdict = 'doubtful'\nreasons = ['guessed']\n";
  EXPECT_THAT(error_of("export", doubtful, {{"format", "c"}, {"stiffness", 100}}).at("what").get<std::string>(),
              HasSubstr("; options.accept-doubt writes the wall all the same"));
  EXPECT_EQ(error_of("export", device, {{"format", "c"}}).at("allowed"),
            "set it, or give options.stiffness or options.safety-factor");
  EXPECT_EQ(error_of("diagnose", device, json::object()).at("allowed"),
            "give the frequency, or a recording that shows it with recording");
  EXPECT_EQ(error_of("simulate", device, json::object()).at("where"), "options");
}

TEST_F(ServedErrors, AStudyIsBoundedAndNamesNoFile) {
  const auto expect_place = [&](const json& options, const json& study, const std::string& where) {
    json request{{"device_toml", contents("devices/lhifam.toml")}, {"options", options}};
    if (study.is_string()) request["study_toml"] = study;
    if (study.is_object()) request["study"] = study;
    const HttpAnswer answer = post("study", request.dump());
    ASSERT_EQ(answer.status, 400) << request;
    EXPECT_EQ(json::parse(answer.body).at("error").at("where"), where) << answer.body;
  };
  const std::string good = contents("devices/studies/lhifam.toml");
  expect_place(json::object(), nullptr, "study");
  expect_place(json::object(), "samples =", "study:1:10");
  expect_place(json::object(), json{{"samples", -1}}, "study.samples");
  expect_place({{"study", "devices/studies/lhifam.toml"}}, nullptr, "options.study");
  expect_place({{"samples", 1000000000}}, good, "options.samples");
  expect_place({{"rare-samples", 10000000}}, good, "options.samples");
  expect_place({{"threads", 1000}}, good, "options.threads");
  expect_place({{"output", "units.h5"}}, good, "options.output");
  expect_place({{"resume", true}}, good, "options.resume");
  expect_place(json::object(), "[[parameter]]\nkey = \"loop.delay\"\ndistribution = \"file\"\nfile = \"/etc/passwd\"\n",
               "study.parameter.0.file");
  json request{{"device_toml", contents("devices/lhifam.toml")}, {"study_toml", good}};
  EXPECT_EQ(json::parse(post("analyze", request.dump()).body).at("error").at("where"), "study");
}

TEST_F(ServedErrors, AnErrorSaysWhatWasGivenAndWhatIsAllowed) {
  const std::string device = contents("devices/lhifam.toml");
  const auto error_of = [&](const std::string& command, const json& options, const std::string& text) {
    const HttpAnswer answer = post(command, json{{"device_toml", text}, {"options", options}}.dump());
    return json::parse(answer.body).at("error");
  };
  const auto expect_error = [&](const std::string& command, const json& options, const std::string& what,
                                const std::string& allowed) {
    const json error = error_of(command, options, device);
    EXPECT_EQ(error.at("what"), what) << error;
    EXPECT_THAT(error.at("allowed").get<std::string>(), HasSubstr(allowed)) << error;
    EXPECT_FALSE(error.contains("line")) << error;
  };
  expect_error("bode", {{"points", "-5"}}, "is -5", "a whole number, 0 or more");
  expect_error("bode", {{"points", -5}}, "is -5", "a whole number, 0 or more");
  expect_error("bode", {{"points", 1}}, "is 1", "must be 2 to 100000");
  expect_error("bode", {{"points", 40.5}}, "is 40.5", "a whole number");
  expect_error("bode", {{"from", "abc"}}, "\"abc\" is no number", "a number of rad/s");
  expect_error("export", json::object(), "is missing", "a value");
  expect_error("relay", {{"amplitude", 5}, {"variation", "abc"}}, "is abc", "a number");
  expect_error("relay", {{"amplitude", 5}, {"trials", 2000}}, "is 2000", "a whole number from 1 to 1000");
  expect_error("simulate", {{"contact", "soft"}}, "is soft", "bilateral, unilateral");
  // Places in the text, of its grammar and of its keys.
  json error = error_of("analyze", json::object(), "name = \"a\"\nbody = [\n");
  EXPECT_EQ(error.at("line"), 2) << error;
  EXPECT_EQ(error.at("column"), 10) << error;
  error = error_of("analyze", json::object(),
                   "name = \"a\"\n[[body]]\nname = \"b\"\n  mass = -1\n[loop]\nsampling_period = 1e-3\n");
  EXPECT_EQ(error.at("where"), "device.body.b.mass") << error;
  EXPECT_EQ(error.at("line"), 4) << error;
  error = error_of("analyze", json::object(), device + "\n[lop]\ndelay = 1\n");
  EXPECT_THAT(error.dump(), HasSubstr("did you mean")) << error;
  EXPECT_EQ(error.at("line"), std::count(device.begin(), device.end(), '\n') + 2) << error;
  // Of a device that came as JSON there are no lines.
  const HttpAnswer of_json = post("analyze", R"({"device":{"body":[{"name":"b","mass":-1}]}})");
  EXPECT_FALSE(json::parse(of_json.body).at("error").contains("line")) << of_json.body;
}

TEST_F(ServedErrors, AMeasuredLimitIsRefusedByItsCode) {
  const std::string device = contents("devices/lhifam.toml");
  const auto error_of = [&](const char* limit) {
    const json request{{"device_toml", device}, {"options", {{"limit", limit}}}};
    const HttpAnswer answer = post("identify", request.dump());
    EXPECT_EQ(answer.status, 400) << limit;
    return json::parse(answer.body).at("error");
  };
  for (const auto& [limit, code] : {std::pair{"B=0, hz=40", "limit_without_stiffness"},
                                    {"K=0", "not_finite_and_positive"},
                                    {"K=3, B=-1", "negative"},
                                    {"K=3, hz=0", "not_finite_and_positive"},
                                    {"K=3, K=4", "given_twice"},
                                    {"K=3,5", "limit_part_without_value"},
                                    {"K=3, stifness=4", "no_number_of_limit"},
                                    {"K=3 kg", "unit_of_other_measure"},
                                    {"K=3 N m/rad", "unit_of_other_measure"}}) {
    const json error = error_of(limit);
    EXPECT_EQ(error.at("code"), code) << limit << error;
    EXPECT_EQ(error.at("place").at("option"), "limit") << limit << error;
  }
  EXPECT_EQ(error_of("K=3, stifness=4").at("suggestion"), "K");
  EXPECT_EQ(error_of("K=3, frequency=40").at("suggestion"), "hz");
  EXPECT_EQ(error_of("K=3, other=40").at("suggestion"), nullptr);
}

TEST_F(ServedErrors, AnErrorHasItsPlaceAndAllProblemsAsFields) {
  const auto error_of = [&](const std::string& command, const json& options, const std::string& text) {
    const HttpAnswer answer = post(command, json{{"device_toml", text}, {"options", options}}.dump());
    EXPECT_EQ(answer.status, 400);
    return json::parse(answer.body).at("error");
  };
  const std::string text =
      "[[body]]\nname = \"a\"\nmass = -1\ndamping = \"5 Ns/m\"\n[loop]\nsampling_period = \"2 kHz\"\n";
  const json error = error_of("analyze", json::object(), text);
  ASSERT_EQ(error.at("problems").size(), 3U) << error;
  const auto field = [&](std::size_t i, const char* name) { return error.at("problems").at(i).at(name); };
  const auto place = [](int line, int column, const char* key) {
    return json{{"file", "device"}, {"line", line}, {"column", column}, {"key", key}, {"option", nullptr}};
  };
  EXPECT_EQ(field(0, "place"), place(4, 11, "body.a.damping"));
  EXPECT_EQ(field(0, "suggestion"), "5 N s/m");
  EXPECT_EQ(field(1, "place"), place(6, 19, "loop.sampling_period"));
  EXPECT_EQ(field(1, "suggestion"), "0.5 ms");
  EXPECT_EQ(field(2, "place"), place(3, 8, "body.a.mass"));
  EXPECT_EQ(field(2, "suggestion"), nullptr);
  EXPECT_EQ(field(2, "where"), "device.body.a.mass");
  EXPECT_EQ(field(0, "code"), "unknown_unit");
  EXPECT_EQ(field(1, "code"), "unit_of_other_measure");
  EXPECT_EQ(field(2, "code"), "no_finite_number");
  for (const char* name : {"where", "what", "allowed", "place", "suggestion", "code"})
    EXPECT_EQ(error.at(name), field(0, name));
  // Of an option, and of a key that is overridden: there is no line.
  const std::string device = contents("devices/lhifam.toml");
  json other = error_of("simulate", {{"contact", "bilaterl"}}, device);
  EXPECT_EQ(other.at("place").at("option"), "contact") << other;
  EXPECT_EQ(other.at("suggestion"), "bilateral") << other;
  other = error_of("analyze", {{"set", "loop.delay=2 kHz"}}, device);
  EXPECT_EQ(other.at("where"), "device.loop.delay") << other;
  EXPECT_EQ(
      other.at("place"),
      (json{{"file", "device"}, {"line", nullptr}, {"column", nullptr}, {"key", "loop.delay"}, {"option", nullptr}}));
  EXPECT_EQ(other.at("suggestion"), "0.5 ms") << other;
  EXPECT_EQ(other.at("code"), "unit_of_other_measure") << other;
  other = error_of("relay", {{"amplitude", 5}, {"variation", "0,25"}}, device);
  EXPECT_EQ(other.at("place").at("option"), "variation") << other;
  EXPECT_EQ(other.at("suggestion"), "0.25") << other;
  EXPECT_EQ(other.at("code"), nullptr) << other;  // it has words alone
}

// Another reader may take the first of two, ours would take the last.
TEST_F(ServedErrors, AKeyThatIsGivenTwiceIsRefusedWithItsPlace) {
  for (const auto& [place, document] : std::vector<std::pair<std::string, std::string>>{
           {"device_toml", R"({"device_toml":"a","device_toml":"b"})"},
           {"options.set", R"({"options":{"set":"a=1","points":3,"set":"b=1"}})"},
           {"device.loop.delay", R"({"device":{"name":"x","loop":{"delay":1,"delay":2}}})"},
           {"device.body.mass", R"({"device":{"body":[{"mass":1},{"name":"b","mass":1,"\u006dass":2}]}})"}}) {
    const HttpAnswer answer = post("analyze", document);
    EXPECT_EQ(answer.status, 400) << document;
    const json error = json::parse(answer.body).at("error");
    EXPECT_EQ(error.at("where"), place) << error;
    EXPECT_EQ(error.at("what"), "is given twice") << error;
  }
  // The same key of two objects is none twice.
  const HttpAnswer once =
      post("analyze", R"({"device":{"body":[{"name":"a","mass":1,"damping":2}],"loop":{"sampling_period":1e-3}}})");
  EXPECT_EQ(once.status, 200) << once.body;
}

TEST_F(ServedErrors, WhatARequestMayMakeIsBounded) {
  const json asked{{"options", {{"amplitude", 1}, {"duration", 30000}, {"output", "-"}}}};
  const HttpAnswer many = post("excite", asked.dump());
  EXPECT_EQ(many.status, 400);
  EXPECT_EQ(json::parse(many.body).at("error").at("where"), "options.duration") << many.body;
  EXPECT_THAT(many.body, HasSubstr("makes 30000000 samples"));
  const json long_run{{"device_toml", contents("devices/lhifam.toml")},
                      {"options", {{"set", "wall.stiffness=3000"}, {"duration", 1e4}}}};
  EXPECT_THAT(post("simulate", long_run.dump()).body, HasSubstr("makes 10000000 samples"));
  // 160 kB that unpack to 160 MB.
  const Outcome made =
      run("/usr/bin/python3 -c 'import scipy.io, numpy as n; "
          "scipy.io.savemat(\"bomb.mat\", {\"force\": n.zeros(20_000_000)}, do_compression=True)'");
  ASSERT_EQ(made.status, 0) << made.errors;
  const std::string bomb = contents("bomb.mat");
  EXPECT_LT(bomb.size(), 500'000U);
  const HttpAnswer unpacked = upload(bomb);
  EXPECT_EQ(unpacked.status, 400);
  EXPECT_THAT(unpacked.body, HasSubstr("at most 134217728 bytes"));
}

}  // namespace
}  // namespace zwidth::cli
