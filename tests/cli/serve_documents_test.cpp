// What the server answers is what the command line prints, to the last bit.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "cli/served.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;

/// One question in both forms: the options as a request has them give those of the command line.
struct Asked {
  std::string command;
  std::string device = {};  ///< file; of identify the structure, of excite --device
  std::vector<std::string> recordings = {};
  json options = json::object();
  std::string study = {};  ///< file
};

std::string quoted(const json& value) {
  return "'" + (value.is_string() ? value.get<std::string>() : value.dump()) + "'";
}

std::string command_line(const Asked& asked) {
  const std::string name = asked.command == "recommend" ? "design" : asked.command;
  std::string line = "zwidth " + name;
  if (!asked.device.empty()) {
    const std::string option = name == "identify" ? " --structure " : name == "excite" ? " --device " : " ";
    line += option + asked.device;
  }
  const bool is_named = name == "relay" || name == "diagnose" || name == "simulate";
  const std::string option = name == "simulate" ? " --user-force " : is_named ? " --recording " : " ";
  for (const std::string& recording : asked.recordings) line += option + recording;
  if (!asked.study.empty()) line += " --study " + asked.study;
  if (asked.command == "recommend") line += " --recommend";
  for (const auto& [key, value] : asked.options.items()) {
    if (value == false) continue;
    if (value.is_boolean()) {
      line += " --" + key;
    } else {
      for (const json& each : value.is_array() ? value : json::array({value})) line += " --" + key + " " + quoted(each);
    }
  }
  return name == "export" ? line : line + " --json";
}

const std::string lhifam = "devices/lhifam.toml";
const std::string mechanism_as_text = "arm.toml";

class ServedDocuments : public Served {
 protected:
  ServedDocuments() {
    for (const char* name : {"locked_chirp.csv", "free_motion.csv"})
      write(name, contents(std::string("recordings/") + name));
    EXPECT_EQ(run("zwidth relay devices/lhifam.toml --amplitude 5 --delay 4e-3 --start 0.03 --csv run.csv").status, 0);
    EXPECT_EQ(run("zwidth frf locked_chirp.csv --force force --position position --csv frf.csv").status, 0);
    std::string arm = contents("devices/mechanisms/planar_arm.toml");
    const std::string file = "file = \"planar_arm.xml\"";
    arm.replace(arm.find(file), file.size(), "text = '''" + contents("devices/mechanisms/planar_arm.xml") + "'''");
    write(mechanism_as_text, arm);
    start();
    devices_ = json::parse(get("/api/v1/devices").body).at("devices");
  }

  [[nodiscard]] json device_of(const std::string& file) const {
    for (const json& each : devices_) {
      if ("devices/" + each.at("file").get<std::string>() == file) return each;
    }
    return nullptr;
  }

  [[nodiscard]] json recording(const std::string& file) const {
    return {{"id", json::parse(upload(contents(file)).body).at("id")}, {"name", file}};
  }

  [[nodiscard]] json request_of(const Asked& asked) const {
    json request{{"options", asked.options}};
    if (!asked.device.empty()) request["device_toml"] = contents(asked.device);
    if (!asked.study.empty()) request["study_toml"] = contents(asked.study);
    for (const std::string& file : asked.recordings) request["recordings"].push_back(recording(file));
    return request;
  }

  void expect_same(const Asked& asked) const {
    const std::string line = command_line(asked);
    const Outcome printed = run(line);
    json request = request_of(asked);
    const HttpAnswer answer = post(asked.command, request.dump());
    EXPECT_EQ(printed.status, 0) << line << "\n" << printed.errors;
    EXPECT_EQ(answer.status, 200) << line;
    EXPECT_EQ(answer.body, printed.output) << line;
    const json device = device_of(asked.device);
    if (device.is_null()) return;
    request.erase("device_toml");
    request["device"] = device.at("device");  // the same device as JSON
    EXPECT_EQ(post(asked.command, request.dump()).body, printed.output) << line;
  }

 private:
  json devices_;
};

std::vector<Asked> questions() {
  return {
      {"analyze", lhifam},
      {"analyze", "devices/capstan_paddle.toml"},
      {"analyze", "devices/two_mass_drive.toml", {}, {{"worst-user", true}, {"require-stable", false}}},
      {"analyze", lhifam, {}, {{"users", "mass=0:2,damping=0:30,stiffness=0:1000"}}},
      {"analyze", lhifam, {}, {{"set", {"wall.stiffness=5000", "wall.damping=5", "loop.delay=0.3e-3"}}}},
      {"bode", lhifam, {}, {{"points", 77}, {"from", 0.1}, {"to", "2 kHz"}}},
      {"region", lhifam, {}, {{"set", "wall.velocity_filter_hz=100"}}},
      {"design", lhifam},
      {"design", lhifam, {}, {{"sweep", {"loop.delay=0:4e-3:5", "link.damping=5:50:4"}}, {"any-user", true}}},
      {"design", lhifam, {}, {{"compare", "sensed=motor,handle"}, {"operator", {0.5, 6, 135}}}},
      {"design", lhifam, {}, {{"target", 12000}}},
      {"design", "devices/lhifam_reduced_pretension.toml", {}, {{"notch", true}, {"drift-percent", 10}}},
      {"recommend", lhifam, {}, {{"ripple", 0.1}, {"goal", "width"}}},
      {"diagnose", lhifam, {}, {{"oscillates-hz", 6.3}, {"stiffness", 9500}}},
      {"diagnose", lhifam, {"run.csv"}, {{"position", 3}, {"stiffness", 9500}}},
      {"export", lhifam, {}, {{"format", "json"}}},
      {"simulate", lhifam, {}, {{"set", "wall.stiffness=5000"}, {"lost-samples", 0.05}, {"overrun", {0.1, 1e-3}}}},
      {"simulate", lhifam, {}, {{"set", "wall.stiffness=5000"}, {"user-force", "step:5@0.1"}, {"duration", "0.5 s"}}},
      {"simulate",
       lhifam,
       {"free_motion.csv"},
       {{"set", "wall.stiffness=5000"}, {"user-force-column", "force"}, {"user-force-scale", 0.01}}},
      {"relay", lhifam, {}, {{"amplitude", 5}, {"trials", 2}, {"seed", 7}}},
      {"relay", lhifam, {"run.csv"}, {{"force", 2}, {"position", 3}, {"delay", 4e-3}}},
      {"relay", "", {"run.csv"}, {{"force", "force_1"}, {"position", "position_1"}, {"motion", "linear"}}},
      {"frf", "", {"locked_chirp.csv"}, {{"force", "force"}, {"position", "position"}, {"points", true}}},
      {"frf", "", {"locked_chirp.csv"}, {{"list", true}, {"delimiter", "comma"}, {"header", true}}},
      {"frf", "", {"frf.csv"}, {{"table", true}, {"magnitude", "magnitude"}, {"phase", "phase_deg"}, {"rate", 1000}}},
      {"identify",
       lhifam,
       {"locked_chirp.csv"},
       {{"force", "force"},
        {"position", "position"},
        {"locked", {"handle"}},
        {"free", {"link.stiffness", "link.damping"}},
        {"points", true}}},
      {"identify",
       "",
       {"free_motion.csv"},
       {{"force", "force"}, {"position", "position"}, {"method", "inverse-dynamics"}}},
      {"identify", "", {"locked_chirp.csv"}, {{"force", "force"}, {"position", "position"}, {"structure", "rigid"}}},
      {"excite", lhifam, {}, {{"amplitude", 2}, {"duration", 1}, {"stroke", 0.5}}},
      {"excite", "", {}, {{"kind", "noise"}, {"amplitude", 3}, {"duration", 1}}},
      {"study", lhifam, {}, {{"samples", 300}, {"seed", 5}}, "devices/studies/lhifam.toml"},
#ifdef ZWIDTH_MUJOCO
      {"workspace",
       mechanism_as_text,
       {},
       {{"poses", "shoulder=0:60:2 deg,elbow=30:120:2 deg"}, {"stiffness", "300 N/m"}, {"normals", 3}}},
      {"workspace",
       mechanism_as_text,
       {},
       {{"points", {"0.3,0.2,0", "2,0,0"}}, {"normals", {"1,0,0", "0,1,0"}}, {"all-directions", true}}},
#endif
  };
}

TEST_F(ServedDocuments, AreThoseOfTheCommandLineBitForBit) {
  std::set<std::string> asked;
  for (const Asked& each : questions()) {
    expect_same(each);
    asked.insert(each.command);
  }
  // Every command but those that make files and this server itself; a new command stands here or there.
  std::set<std::string> no_requests{"reproduce", "rig", "serve"};
#ifndef ZWIDTH_MUJOCO
  no_requests.insert("workspace");
#endif
  std::istringstream help(run("zwidth --help").output);
  std::set<std::string> missing;
  bool in_list = false;
  for (std::string line; std::getline(help, line);) {
    if (line.empty()) in_list = false;
    const std::string name = in_list ? line.substr(2, line.find(' ', 2) - 2) : "";
    if (in_list && !no_requests.contains(name) && !asked.contains(name)) missing.insert(name);
    if (line == "Commands:") in_list = true;
  }
  EXPECT_THAT(missing, ::testing::IsEmpty());
}

TEST_F(ServedDocuments, WhatIsNoDocumentIsAText) {
  const json request{{"device_toml", contents(lhifam)}, {"options", {{"format", "c"}, {"stiffness", 3000}}}};
  const json answer = json::parse(post("export", request.dump()).body);
  EXPECT_EQ(answer.at("schema"), "zwidth.text/1");
  EXPECT_EQ(answer.at("text"), run("zwidth export devices/lhifam.toml --format c --stiffness 3000").output);
  const json found{{"device_toml", contents(lhifam)},
                   {"recording", recording("locked_chirp.csv")},
                   {"options",
                    {{"force", "force"},
                     {"position", "position"},
                     {"locked", "handle"},
                     {"free", "link.stiffness"},
                     {"output-device", "-"}}}};
  EXPECT_EQ(json::parse(post("identify", found.dump()).body).at("text"),
            run("zwidth identify locked_chirp.csv --structure devices/lhifam.toml --force force --position position "
                "--locked handle --free link.stiffness --output-device -")
                .output);
}

TEST_F(ServedDocuments, OfARefusedDeviceSayThatItIsRefused) {
  const std::string doubtful = contents(lhifam) + "\n[uncertainty]\nverdict = \"refused\"\nwarning = \"no fit\"\n";
  write("refused.toml", doubtful);
  const HttpAnswer answer = post("region", json{{"device_toml", doubtful}}.dump());
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, run("zwidth region refused.toml --json").output);
  EXPECT_EQ(json::parse(answer.body).at("trust").at("verdict"), "refused");
}

TEST_F(ServedDocuments, RecordingsAreNamedByTheirDigest) {
  const HttpAnswer answer = upload("abc,def\n1,2\n3,4\n");
  EXPECT_EQ(answer.status, 200);
  const json contents = json::parse(answer.body);
  const json expected_columns =
      json::parse(R"([{"name":"abc","samples":2,"detail":"numbers"},{"name":"def","samples":2,"detail":"numbers"}])");
  EXPECT_EQ(contents.at("columns"), expected_columns);
  EXPECT_EQ(contents.at("format"), "text");
  write("abc", "abc,def\n1,2\n3,4\n");
  EXPECT_EQ(contents.at("id").get<std::string>() + "  abc\n", run("sha256sum abc").output);
  EXPECT_EQ(json::parse(upload("abc,def\n1,2\n3,4\n").body), contents);
}

TEST_F(ServedDocuments, ProgressComesAheadOfTheSameDocument) {
  const Asked sweep{"design", lhifam, {}, {{"sweep", "loop.delay=0:8e-3:3000"}, {"any-user", true}}};
  const HttpAnswer answer = post("design", request_of(sweep).dump(), "Accept: application/x-ndjson\r\n");
  std::istringstream lines(answer.body);
  double before = 0.0;
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!last.empty()) {
      const double fraction = json::parse(last).at("progress");
      EXPECT_GE(fraction, before);
      before = fraction;
    }
    last = line;
  }
  EXPECT_GT(before, 0.0);
  EXPECT_EQ(last + "\n", run(command_line(sweep)).output);
}

TEST_F(ServedDocuments, DevicesOfTheCommandLineComeFirst) {
  EXPECT_EQ(stop(), 0);
  write("mine.toml", contents("devices/lhifam_rigid.toml"));
  start({"mine.toml"});
  const json devices = json::parse(get("/api/v1/devices").body).at("devices");
  EXPECT_EQ(devices.at(0).at("file"), "mine.toml");
  EXPECT_EQ(devices.at(0).at("opened"), true);
  EXPECT_EQ(devices.at(1).at("opened"), false);
  EXPECT_EQ(devices.size(), 13U);  // three of them mechanisms
}

}  // namespace
}  // namespace zwidth::cli
