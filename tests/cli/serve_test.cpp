// How the server starts, ends, and bears many clients.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/served.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

class Serve : public Served {
 protected:
  /// Work of some seconds, in steps of a few milliseconds.
  [[nodiscard]] std::string long_work() const {
    return json{{"device_toml", contents("devices/lhifam.toml")},
                {"options", {{"sweep", "loop.delay=0:8e-3:10000"}, {"any-user", true}}}}
        .dump();
  }
  /// Bodies in a row: the work on it takes the longer the more there are.
  [[nodiscard]] static std::string chain(std::size_t bodies) {
    std::string text = "name = \"chain\"\n";
    for (std::size_t i = 0; i < bodies; ++i) {
      text += fmt::format("[[body]]\nname = \"b{}\"\nmass = {}\ndamping = 0.3\n", i,
                          0.2 + 0.03 * static_cast<double>((7 * i) % 10));
    }
    for (std::size_t i = 0; i + 1 < bodies; ++i) {
      text += fmt::format("[[link]]\nbetween = [\"b{}\", \"b{}\"]\nstiffness = {}\ndamping = 7\n", i, i + 1,
                          5e4 + 5e3 * static_cast<double>((3 * i) % 7));
    }
    return text + "[loop]\nsampling_period = 1e-3\ndelay = 0.4e-3\n";
  }
  [[nodiscard]] std::string whole(const std::string& command, const std::string& document) const {
    return request("POST", "/api/v1/" + command, document, "Content-Type: application/json\r\n");
  }
  /// The answer of a health check within that time.
  [[nodiscard]] bool answers_within(std::chrono::milliseconds time) const {
    const auto begin = std::chrono::steady_clock::now();
    return get("/api/v1/health").status == 200 && std::chrono::steady_clock::now() - begin < time;
  }
  void wait_until_it_works(double seconds = 0.05) const {
    const double before = work_done();
    for (int i = 0; i < 10000 && work_done() - before < seconds; ++i) std::this_thread::sleep_for(2ms);
  }
  /// Processor time of the server so far, s.
  [[nodiscard]] double work_done() const {
    std::ifstream stat(fmt::format("/proc/{}/stat", process()));
    std::string text;
    std::getline(stat, text);
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string skipped;
    for (int i = 3; i < 14; ++i) fields >> skipped;
    double user = 0.0;
    double system = 0.0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  }
};

TEST_F(Serve, PrintsItsAddressAndEndsWhenInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    start();
    EXPECT_THAT(address(), ::testing::MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/"));
    EXPECT_EQ(json::parse(get("/api/v1/health").body).at("status"), "ok");
    EXPECT_EQ(stop(signal), 0);
  }
}

TEST_F(Serve, WhatItCannotServeIsRefused) {
  start();
  const Outcome taken = run(fmt::format("zwidth serve --port {}", port()));
  EXPECT_EQ(taken.status, 1);
  EXPECT_THAT(taken.errors, HasSubstr("name another with --host and --port, 0 for any free port"));
  expect_refusal("zwidth serve --host evil.example", "--host: evil.example: is no address");
  expect_refusal("zwidth serve --host ''", "--host");
  expect_refusal("zwidth serve --port 70000", "--port");
  expect_refusal("zwidth serve missing.toml", "missing.toml: ");
  expect_refusal("zwidth serve devices/lhifam.toml --set loop.delay=-1", "loop.delay: is -1");
}

TEST_F(Serve, ElsewhereThanOnLoopbackTheTokenIsNeeded) {
  start({"--host", "0.0.0.0"});
  // One that a browser can open, of this machine's own.
  ASSERT_THAT(address(), ::testing::MatchesRegex("http://[1-9][0-9.]+:[0-9]+/#token=[0-9a-f]+"));
  const std::string token = address().substr(address().find('=') + 1);
  EXPECT_EQ(token.size(), 64U);
  EXPECT_EQ(get("/").status, 200);  // the page itself: the token is in its address' fragment
  const auto status = [&](const std::string& header) {
    return exchange(request("GET", "/api/v1/health", "", header)).status;
  };
  EXPECT_EQ(status(""), 403);
  EXPECT_EQ(status("Authorization: Bearer " + token + "\r\n"), 200);
  EXPECT_EQ(status("Authorization: bearer " + token + "\r\n"), 200);
  for (const std::string& wrong : {std::string(64, '0'), token.substr(1), token + "0", std::string(),
                                   token + "\r\nAuthorization: Bearer " + token}) {
    EXPECT_EQ(status("Authorization: Bearer " + wrong + "\r\n"), 403) << wrong;
  }
  EXPECT_EQ(status("Authorization: Basic " + token + "\r\n"), 403);
  EXPECT_EQ(status("Cookie: token=" + token + "\r\n"), 403);
  EXPECT_EQ(get("/api/v1/health?token=" + token).status, 403);
  EXPECT_EQ(stop(), 0);
  const std::string before = token;
  start({"--host", "0.0.0.0"});
  EXPECT_NE(address().substr(address().find('=') + 1), before);
}

TEST_F(Serve, AnInterruptFinishesWhatRuns) {
  start();
  Client client(port());
  const json request{{"device_toml", contents("devices/lhifam.toml")},
                     {"options", {{"sweep", "loop.delay=0:8e-3:400"}, {"any-user", true}}}};
  client.send(whole("design", request.dump()));
  wait_until_it_works(0.01);  // of a second and more, so that it is not done before anyone looks
  const Client idle(port());  // does not keep it alive
  HttpAnswer answer;
  std::thread waits([&] { answer = client.answer(); });
  EXPECT_EQ(stop(), 0);
  waits.join();
  EXPECT_EQ(answer.status, 200);
  EXPECT_THAT(answer.head, HasSubstr("Connection: close"));
  EXPECT_THAT(answer.body, StartsWith("{\"schema\":"));
}

TEST_F(Serve, AnInterruptWithoutWorkEndsItWhoeverIsConnected) {
  start();
  Client client(port());
  client.send(request("GET", "/api/v1/health"));
  EXPECT_EQ(client.answer().status, 200);
  const Client silent(port());
  EXPECT_EQ(stop(), 0);
}

// On a loop of many samples of delay some work tells nothing for seconds.
TEST_F(Serve, ASecondInterruptEndsWorkThatDoesNotHeedIt) {
  start();
  Client client(port());
  const json request{{"device_toml", contents("devices/lhifam.toml")},
                     {"options", {{"set", {"loop.delay=10", "wall.stiffness=0.1"}}, {"oscillates-hz", 0.05}}}};
  client.send(whole("diagnose", request.dump()));
  wait_until_it_works();
  ::kill(process(), SIGINT);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(stop(), 0);
}

TEST_F(Serve, ASecondInterruptEndsTheWork) {
  start();
  Client client(port());
  client.send(whole("design", long_work()));
  wait_until_it_works();
  ::kill(process(), SIGINT);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(stop(), 0);
  EXPECT_EQ(client.answer().status, 503);
}

TEST_F(Serve, WorkOfAClientThatLeavesIsEnded) {
  start();
  {
    Client client(port());
    client.send(whole("design", long_work()));
    wait_until_it_works();
  }
  // Within some steps of the work it stands still, long before the work were done.
  const auto end = std::chrono::steady_clock::now() + 5s;
  bool stands_still = false;
  while (!stands_still && std::chrono::steady_clock::now() < end) {
    const double before = work_done();
    std::this_thread::sleep_for(500ms);
    stands_still = work_done() - before < 0.02;
  }
  EXPECT_TRUE(stands_still);
  EXPECT_TRUE(is_alive());
}

// Work of a second and more that used to tell nothing.
TEST_F(Serve, WorkOfEveryKindIsEndedWhereTheClientLeaves) {
  start();
  const auto asked = [](std::size_t bodies, const json& options) {
    return json{{"device_toml", chain(bodies)}, {"options", options}}.dump();
  };
  for (const auto& [command, document] : std::vector<std::pair<std::string, std::string>>{
           {"region", asked(12, json::object())},
           {"recommend", asked(12, json::object())},
           {"design", asked(8, json::object())},
           {"design", asked(10, {{"target", 3000}})},
           {"analyze", asked(10, {{"users", "mass=0:2,damping=0:30,stiffness=0:1000"}})}}) {
    for (const bool is_pipelined : {false, true}) {
      double before = 0.0;
      {
        Client client(port());
        // Bytes of a next request must not hide that the client is gone.
        client.send(whole(command, document) + (is_pipelined ? "GET /" : ""));
        wait_until_it_works();
        before = work_done();
      }
      const auto end = std::chrono::steady_clock::now() + 20s;
      for (double last = -1.0; last < work_done() && std::chrono::steady_clock::now() < end;) {
        last = work_done();
        std::this_thread::sleep_for(300ms);
      }
      EXPECT_LT(work_done() - before, 0.5) << command;  // of two cores
    }
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(Serve, ASecondInterruptEndsSlowWorkAtOnce) {
  start();
  Client client(port());
  client.send(whole("region", json{{"device_toml", chain(10)}}.dump()));
  Client slow_reader(port());  // does not take its answer
  slow_reader.send(whole("bode", json{{"device_toml", chain(2)}, {"options", {{"points", 20000}}}}.dump()));
  wait_until_it_works();
  ::kill(process(), SIGINT);
  std::this_thread::sleep_for(100ms);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(stop(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s);        // 0.8 s, and what else the machine does
  EXPECT_THAT(client.answer().status, ::testing::AnyOf(503, 0));  // 0: not within the time for answers
}

TEST_F(Serve, MoreThanMayWaitIsToldSo) {
  start();
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 120; ++i) {
    clients.push_back(std::make_unique<Client>(port()));
    clients.back()->send(whole("design", long_work()));
  }
  std::atomic<int> busy = 0;
  std::vector<std::thread> waits;
  const int expected = 120 - 64 - static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (auto& client : clients) {
    waits.emplace_back([&] {
      if (client->answer().status == 503) ++busy;
    });
  }
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (busy < expected && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(busy, expected);
  EXPECT_TRUE(answers_within(1s));  // what needs no work is answered all the while
  ::kill(process(), SIGINT);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(stop(), 0);
  for (std::thread& each : waits) each.join();
  EXPECT_EQ(busy, 120);  // what ran or waited was ended by the second signal
}

TEST_F(Serve, QuickWorkDoesNotWaitForLongWork) {
  start();
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 20; ++i) {
    clients.push_back(std::make_unique<Client>(port()));
    clients.back()->send(whole("design", long_work()));
  }
  wait_until_it_works();
  const json device{{"device_toml", contents("devices/lhifam.toml")}};
  for (int i = 0; i < 5; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(post("analyze", device.dump()).status, 200);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);  // 20 s and more behind the others
  }
  ::kill(process(), SIGINT);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(stop(), 0);
}

TEST_F(Serve, MoreConnectionsThanItKeepsAreTurnedAway) {
  start();
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 256; ++i) clients.push_back(std::make_unique<Client>(port()));
  clients.front()->send(request("GET", "/api/v1/health"));
  EXPECT_EQ(clients.front()->answer().status, 200);
  EXPECT_EQ(get("/api/v1/health").status, 503);
  clients.clear();
  std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(is_alive());
}

TEST_F(Serve, AnswersAtOnceAreThoseOneByOne) {
  start();
  const std::vector<std::string> files{"lhifam", "lhifam_rigid", "capstan_paddle", "two_mass_drive"};
  std::vector<std::string> alone;
  for (const std::string& file : files) {
    // With a unit of its motion each: what the parsing remembers belongs to one request.
    alone.push_back(
        json{{"device_toml", contents("devices/" + file + ".toml")},
             {"options",
              {{"set", "wall.stiffness=10"},
               {"oscillates-hz", "5 Hz"},
               {"stiffness", file == "capstan_paddle" || file == "two_mass_drive" ? "20 N m/rad" : "2 kN/m"}}}}
            .dump());
  }
  std::vector<std::string> expected;
  for (const std::string& request : alone) {
    const HttpAnswer answer = post("diagnose", request);
    EXPECT_EQ(answer.status, 200) << answer.body;
    expected.push_back(answer.body);
  }
  std::vector<std::thread> threads;
  std::atomic<int> different = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      for (std::size_t k = 0; k < 10; ++k) {
        const std::size_t which = (i + k) % alone.size();
        if (post("diagnose", alone[which]).body != expected[which]) ++different;
      }
    });
  }
  for (std::thread& each : threads) each.join();
  EXPECT_EQ(different, 0);
}

TEST_F(Serve, TheRecordingLongestNotUsedGoes) {
  start();
  const auto recording = [](int number) { return fmt::format("a,b\n{},1\n2,2\n3,3\n", number); };
  const auto id_of = [&](int number) {
    return json::parse(upload(recording(number)).body).at("id").get<std::string>();
  };
  const std::string first = id_of(0);
  const std::string second = id_of(1);
  const auto is_there = [&](const std::string& id) {
    const json request{{"recording", id}, {"options", {{"force", "nothing"}, {"position", "b"}}}};
    return post("frf", request.dump()).body.find("no such column") != std::string::npos;
  };
  for (int i = 2; i < 32; ++i) (void)id_of(i);
  EXPECT_TRUE(is_there(first));  // and so used last
  (void)id_of(32);
  EXPECT_TRUE(is_there(first));
  EXPECT_FALSE(is_there(second));
}

TEST_F(Serve, RecordingsOfAllFormatsAreTakenFromMemory) {
  start();
  const Outcome made =
      run("/usr/bin/python3 -c 'import scipy.io, numpy as n; t = n.arange(50) * 0.01; "
          "scipy.io.savemat(\"run.mat\", {\"force\": n.sin(t), \"position\": n.cos(t), \"time\": t}, "
          "do_compression=True)'");
  ASSERT_EQ(made.status, 0) << made.errors;
  const json mat = json::parse(upload(contents("run.mat")).body);
  EXPECT_EQ(mat.at("format"), "mat");
  EXPECT_EQ(mat.at("columns").size(), 3U);
  const HttpAnswer damaged = upload(contents("run.mat").substr(0, 300));
  EXPECT_EQ(damaged.status, 400);
  EXPECT_EQ(json::parse(damaged.body).at("error").at("where"), "recording");
  EXPECT_THAT(damaged.body, ::testing::Not(HasSubstr("/proc/")));
  EXPECT_EQ(upload("").status, 400);
  EXPECT_EQ(upload(std::string(1000, '\0')).status, 400);
  EXPECT_TRUE(is_alive());
}

TEST_F(Serve, LargeBodiesAreInvited) {
  start();
  Client client(port());
  std::string recording = "a,b\n";
  while (recording.size() < (8U << 20)) recording += "1.5,2.5\n";
  client.send(
      fmt::format("POST /api/v1/recordings HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Type: "
                  "application/octet-stream\r\nContent-Length: {}\r\nExpect: 100-continue\r\n\r\n",
                  port(), recording.size()));
  EXPECT_EQ(client.answer().status, 100);
  client.send(recording);
  EXPECT_EQ(client.answer().status, 200);
}

// Clients that people use, beside our own bytes: the example of the documentation.
TEST_F(Serve, TheExamplesOfItsDocumentWork) {
  start();
  std::ifstream file(ZWIDTH_SOURCE_DIR "/docs/serve.md");
  const std::string document((std::istreambuf_iterator<char>(file)), {});
  const std::size_t begin = document.find("```sh\n") + 6;
  std::string example = document.substr(begin, document.find("```", begin) - begin);
  for (const std::string& own : {std::string("zwidth serve --port 8713 &\n"), std::string("kill %1\n")}) {
    ASSERT_THAT(example, HasSubstr(own));
    example.erase(example.find(own), own.size());
  }
  for (std::size_t at = example.find("8713"); at != std::string::npos; at = example.find("8713", at)) {
    example.replace(at, 4, std::to_string(port()));
  }
  std::istringstream answers(run(example).output);
  for (const char* schema : {"zwidth.analysis/1", "zwidth.frf/1"}) {
    std::string line;
    std::getline(answers, line);
    EXPECT_EQ(json::parse(line, nullptr, false).value("schema", ""), schema) << line;
  }
}

TEST_F(Serve, PythonGetsAnAnswer) {
  start();
  const std::string url = address() + "api/v1/analyze";
  write("ask.py",
        "import json, sys, urllib.request\n"
        "body = json.dumps({'device_toml': open('devices/lhifam.toml').read()}).encode()\n"
        "asked = urllib.request.Request(sys.argv[1], body, {'Content-Type': 'application/json'})\n"
        "print(json.load(urllib.request.urlopen(asked))['critical_stiffness'])\n");
  EXPECT_THAT(run("/usr/bin/python3 ask.py " + url).output, StartsWith("8848.70869499"));
}

// Nothing of a request names a file: the text of a mechanism's stands in the device.
TEST_F(Serve, OffersMechanismsAsText) {
  start({"devices/mechanisms/planar_arm.toml", "--set", "mechanism.pose.elbow=0.4"});
  const json devices = json::parse(get("/api/v1/devices").body).at("devices");
  EXPECT_EQ(devices.at(0).at("file"), "planar_arm.toml");
  EXPECT_EQ(devices.at(0).at("opened"), true);
  int mechanisms = 0;
  for (const json& each : devices) {
    if (!each.at("device").contains("mechanism")) continue;
    ++mechanisms;
    const std::string file = each.at("file");
    SCOPED_TRACE(file);
    const HttpAnswer answer = post("analyze", json{{"device_toml", each.at("device_toml")}}.dump());
    ASSERT_EQ(answer.status, 200) << answer.body;
    const bool is_opened = each.at("opened");
    const std::string line =
        is_opened ? "devices/mechanisms/planar_arm.toml --set mechanism.pose.elbow=0.4" : "devices/" + file;
    const Outcome printed = run("zwidth analyze --json " + line);
    EXPECT_EQ(json::parse(answer.body).at("critical_stiffness"), json::parse(printed.output).at("critical_stiffness"));
    EXPECT_EQ(json::parse(answer.body).at("mechanism"), json::parse(printed.output).at("mechanism"));
  }
  EXPECT_EQ(mechanisms, 4);
}

}  // namespace
}  // namespace zwidth::cli
