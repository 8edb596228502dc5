// What must not be let in, each refused as it is told, with the server alive after all of it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/served.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using std::chrono_literals::operator""s;

class Hostile : public Served {
 protected:
  Hostile() { start(); }

  /// A whole request in which {P} is the port; every \n is a line's end.
  [[nodiscard]] std::string raw(std::string text) const {
    for (std::size_t at = text.find("{P}"); at != std::string::npos; at = text.find("{P}")) {
      text.replace(at, 3, std::to_string(port()));
    }
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) {
      text.replace(at, 1, "\r\n");
    }
    return text;
  }

  void expect_refusal(int status, const std::string& bytes) const {
    const HttpAnswer answer = exchange(bytes);
    const std::string asked = bytes.substr(0, 200);
    EXPECT_EQ(answer.status, status) << asked << "\n" << answer.body;
    const json document = json::parse(answer.body, nullptr, false);
    ASSERT_TRUE(document.is_object() && document.contains("error")) << asked << "\n" << answer.body;
    for (const char* key : {"where", "what", "allowed"}) EXPECT_TRUE(document["error"].contains(key)) << asked;
    EXPECT_THAT(answer.head, HasSubstr("X-Content-Type-Options: nosniff")) << asked;
  }
  void expect_raw_refusal(int status, const std::string& text) const { expect_refusal(status, raw(text)); }
};

TEST_F(Hostile, ForeignHostsAreMisdirected) {
  for (const char* host :
       {"Host: evil.example", "Host: evil.example:{P}", "Host: localhost", "Host: localhost:1",
        "Host: localhost.evil:{P}", "Host: 127.0.0.1", "Host: 127.0.0.1:{P}.evil", "Host: 0.0.0.0:{P}",
        "Host: [::1]:{P}", "Host: 127.1:{P}", "Host: 2130706433:{P}", "Host: localhost.:{P}",
        "Host: user@localhost:{P}", "Host: localhost:{P}, evil.example", "Host:", "X-None: 1",
        "Host: localhost:{P}\nHost: localhost:{P}", "Host: localhost:{P}\nHost: evil.example"}) {
    for (const char* path : {"/", "/api/v1/health"}) {
      expect_raw_refusal(421, fmt::format("GET {} HTTP/1.1\n{}\n\n", path, host));
    }
  }
  expect_raw_refusal(421, "GET / HTTP/1.0\n\n");
  EXPECT_EQ(exchange(raw("GET /api/v1/health HTTP/1.1\nHost: localhost:{P}\n\n")).status, 200);
  EXPECT_EQ(exchange(raw("GET /api/v1/health HTTP/1.0\nHost: 127.0.0.1:{P}\n\n")).status, 200);
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, ForeignOriginsAreForbidden) {
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:{P}", "http://127.0.0.1",
                             "http://localhost:{P}", "http://127.0.0.1:{P}.evil.example", "http://127.0.0.1:{P}/",
                             "file://", "", "http://127.0.0.1:{P}\nOrigin: http://127.0.0.1:{P}"}) {
    expect_raw_refusal(403, fmt::format("GET /api/v1/health HTTP/1.1\nHost: 127.0.0.1:{{P}}\nOrigin: {}\n\n", origin));
  }
  EXPECT_EQ(exchange(raw("GET /api/v1/health HTTP/1.1\nHost: 127.0.0.1:{P}\nOrigin: http://127.0.0.1:{P}\n\n")).status,
            200);
  EXPECT_EQ(exchange(raw("GET /api/v1/health HTTP/1.1\nHost: localhost:{P}\nOrigin: http://localhost:{P}\n\n")).status,
            200);
}

TEST_F(Hostile, PathsReachNoDisk) {
  for (const char* path : {"/etc/passwd",
                           "/../../../../etc/passwd",
                           "/..%2f..%2fetc/passwd",
                           "/%2e%2e/etc/passwd",
                           "//etc/passwd",
                           "/assets/../index.html",
                           "/assets/%2e%2e/index.html",
                           "/./",
                           "/index.html/..",
                           "/api",
                           "/api/",
                           "/api/v1",
                           "/api/v1/",
                           "/api/v1/health/",
                           "/api/v1/../v1/health",
                           "/api/v2/health",
                           "/API/v1/health",
                           "/api/v1/serve",
                           "/api/v1/reproduce",
                           "/api/v1/%61nalyze",
                           "/proc/self/environ",
                           "/devices/lhifam.toml",
                           "/.git/config",
                           "/\\..\\..\\etc"}) {
    expect_refusal(404, request("GET", path));
  }
  expect_raw_refusal(400, "GET http://evil.example/ HTTP/1.1\nHost: 127.0.0.1:{P}\n\n");
  expect_raw_refusal(400, "GET http://127.0.0.1:{P}/ HTTP/1.1\nHost: 127.0.0.1:{P}\n\n");
  expect_raw_refusal(400, "CONNECT evil.example:80 HTTP/1.1\nHost: 127.0.0.1:{P}\n\n");
  expect_raw_refusal(400, "OPTIONS * HTTP/1.1\nHost: 127.0.0.1:{P}\n\n");
  EXPECT_EQ(get("/?any=query").status, 200);
  expect_refusal(400, request("GET", "/api/v1/health?x=1"));
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, MethodsTypesAndSizesAreThoseOfThePath) {
  expect_refusal(405, request("POST", "/", "{}"));
  expect_refusal(405, request("DELETE", "/"));
  expect_refusal(405, request("TRACE", "/"));
  expect_refusal(405, request("OPTIONS", "/api/v1/analyze"));
  expect_refusal(405, request("GET", "/api/v1/analyze"));
  expect_refusal(405, request("PUT", "/api/v1/recordings"));
  expect_refusal(405, request("POST", "/api/v1/devices", "{}"));
  EXPECT_THAT(exchange(request("GET", "/api/v1/analyze")).head, HasSubstr("Allow: POST\r\n"));
  for (const char* type : {"", "Content-Type: text/plain\r\n", "Content-Type: application/x-www-form-urlencoded\r\n",
                           "Content-Type: multipart/form-data\r\n", "Content-Type: application/jsonp\r\n",
                           "Content-Type: application/octet-stream\r\n"}) {
    expect_refusal(415, request("POST", "/api/v1/analyze", "{}", type));
  }
  expect_refusal(415, request("POST", "/api/v1/recordings", "a,b\n1,2\n", "Content-Type: text/csv\r\n"));
  const std::string json_type = "Content-Type: application/json\r\n";
  for (const char* encoding : {"gzip", "deflate", "br", "identity", "gzip, gzip"}) {
    expect_refusal(
        415, request("POST", "/api/v1/analyze", "\x1f\x8b\x08", json_type + "Content-Encoding: " + encoding + "\r\n"));
  }
  expect_refusal(413, request("POST", "/api/v1/analyze", std::string((1 << 20) + 1, ' '), json_type));
  expect_raw_refusal(413,
                     "POST /api/v1/analyze HTTP/1.1\nHost: 127.0.0.1:{P}\nContent-Type: application/json\n"
                     "Content-Length: 99999999999\n\n");
  expect_raw_refusal(413,
                     "POST /api/v1/recordings HTTP/1.1\nHost: 127.0.0.1:{P}\n"
                     "Content-Type: application/octet-stream\nContent-Length: 67108865\n\n");
  expect_raw_refusal(413, "GET /api/v1/health HTTP/1.1\nHost: 127.0.0.1:{P}\nContent-Length: 5\n\nhello");
  expect_raw_refusal(413, "GET / HTTP/1.1\nHost: 127.0.0.1:{P}\nX-Long: " + std::string(20000, 'x') + "\n\n");
  expect_raw_refusal(413, "GET /" + std::string(20000, 'x') + " HTTP/1.1\nHost: 127.0.0.1:{P}\n\n");
  std::string many = "GET / HTTP/1.1\nHost: 127.0.0.1:{P}\n";
  for (int i = 0; i < 3000; ++i) many += fmt::format("A{}: b\n", i);
  expect_raw_refusal(413, many + "\n");
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, LengthsAreOneAndPlain) {
  const std::string head = "POST /api/v1/analyze HTTP/1.1\nHost: 127.0.0.1:{P}\nContent-Type: application/json\n";
  expect_raw_refusal(400, head + "\n{}");
  for (const char* length :
       {"Content-Length: 2\nContent-Length: 3", "Content-Length: 2\nContent-Length: 2", "Content-Length: 2, 2",
        "Content-Length: -2", "Content-Length: +2", "Content-Length: 0x2", "Content-Length: two",
        "Content-Length: 99999999999999999999999", "Transfer-Encoding: chunked",
        "Transfer-Encoding: chunked\nContent-Length: 2", "Content-Length: 2\nTransfer-Encoding: chunked",
        "Transfer-Encoding: gzip, chunked", "Transfer-Encoding: xchunked\nContent-Length: 2",
        "Transfer-Encoding: identity\nContent-Length: 2", "Content-Length: 2\nTransfer-Encoding : chunked",
        "Content-Length: 2\nExpect: something"}) {
    expect_raw_refusal(400, head + length + "\n\n{}");
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, WhatIsNoHttpIsRefused) {
  for (const char* text :
       {"hello\n\n", "GET\n\n", "GET / HTTP/3.0\nHost: 127.0.0.1:{P}\n\n",
        "GET / HTTP/1.1\nHost: 127.0.0.1:{P}\nno colon\n\n", "G\x01T / HTTP/1.1\nHost: 127.0.0.1:{P}\n\n",
        "GET / HTTP/1.1\nHo st: 127.0.0.1:{P}\n\n", "GET / HTTP/1.1\nHost: 127.0.0.1:{P}\nA: \x01\n\n",
        "GET  / HTTP/1.1\nHost: 127.0.0.1:{P}\n\n", "GET / HTTP/1.1\nHost: 127.0.0.1:{P}\nX-A: folded\n here\n\n",
        "GET / HTTP/1.1\nHost: 127.0.0.1:{P}\nX-A: folded\n\there\n\n", "\x16\x03\x01\x02\x01\x01\x01\xfc\x03\x03\n\n",
        "PRI * HTTP/2.0\n\nSM\n\n"}) {
    expect_raw_refusal(400, text);
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, DocumentsAreUtf8ObjectsOfKnownKeysAndNoGreatDepth) {
  const auto expect_bad = [&](const std::string& body, const std::string& where) {
    const HttpAnswer answer = post("analyze", body);
    EXPECT_EQ(answer.status, 400) << body.substr(0, 200);
    EXPECT_EQ(json::parse(answer.body).at("error").at("where"), where) << body.substr(0, 200) << answer.body;
  };
  expect_bad("", "request");
  expect_bad("{", "request");
  expect_bad("[]", "request");
  expect_bad("null", "request");
  expect_bad("{} {}", "request");
  expect_bad("{\"device_toml\":\"\xff\xfe\"}", "request");
  expect_bad("{\"device_toml\":\"\xed\xa0\x80\"}", "request");
  expect_bad("{\"device_toml\":\"\xc0\xaf\"}", "request");
  expect_bad("{\"device_toml\":\"\\ud800\"}", "request");
  expect_bad("{\"device_toml\":1e999}", "request");
  expect_bad(std::string(500000, '['), "request");
  expect_bad(std::string(500000, '[') + std::string(500000, ']'), "request");
  expect_bad(R"({"device":)" + std::string(100, '[') + std::string(100, ']') + "}", "request");
  expect_bad(R"({"devise":{}})", "devise");
  expect_bad(R"({"device":[]})", "device");
  expect_bad(R"({"device":{"name":null}})", "device.name");
  expect_bad(R"({"device":{},"device_toml":""})", "device_toml");
  expect_bad(R"({"device_toml":5})", "device_toml");
  expect_bad(R"({"device_toml":")" + std::string(200000, '[') + "\"}", "device:1:3");
  expect_bad(R"({"recording":"0123"})", "recording");
  expect_bad(R"({"recording":{"id":"/etc/passwd"}})", "recording");
  expect_bad(R"({"recording":{"id":"a","path":"/etc/passwd"}})", "recording");
  expect_bad(R"({"recordings":"a"})", "recordings");
  expect_bad(R"({"options":[]})", "options");
  const std::string zipped("\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03\xab\xae\x05\x00\x43\xbf\xa6\xa3\x02\x00\x00\x00",
                           22);
  expect_bad(zipped, "request");  // {} in gzip, of which no header tells
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, NoOptionReachesADisk) {
  write("secret.csv", "hush,force,position\n0,1,2\n1,1,2\n2,1,2\n");
  const std::string secret = (directory() / "secret.csv").string();
  const std::string device = contents("devices/lhifam.toml");
  const auto expect_bad = [&](const std::string& command, const json& options) {
    json request{{"options", options}};
    if (command != "frf" && command != "identify") request["device_toml"] = device;
    const HttpAnswer answer = post(command, request.dump());
    EXPECT_EQ(answer.status, 400) << command << options << answer.body;
    EXPECT_THAT(answer.body, ::testing::Not(HasSubstr("hush"))) << command << options;
  };
  for (const std::string& path : {secret, std::string("secret.csv"), std::string("-"), std::string("/dev/stdin")}) {
    expect_bad("simulate", {{"user-force", path}, {"set", "wall.stiffness=1000"}});
    expect_bad("relay", {{"recording", path}, {"force", "force"}, {"position", "position"}});
    expect_bad("diagnose", {{"recording", path}, {"position", "position"}, {"stiffness", 1000}});
    expect_bad("frf", {{"FILE", path}, {"force", "force"}, {"position", "position"}});
    expect_bad("frf", {{"", path}, {"force", "force"}, {"position", "position"}});
    expect_bad("identify", {{"structure", path}, {"MORE", path}});
    expect_bad("identify", {{"structure", path}});
    expect_bad("excite", {{"device", path}, {"amplitude", 1}});
  }
  const std::string made = (directory() / "made").string();
  for (const auto& [command, option, ending] :
       std::vector<std::array<std::string, 3>>{{"analyze", "report", ".html"},
                                               {"bode", "output", ".csv"},
                                               {"region", "csv", ".csv"},
                                               {"region", "output", ".svg"},
                                               {"design", "write", ".toml"},
                                               {"recommend", "write", ".toml"},
                                               {"simulate", "csv", ".csv"},
                                               {"simulate", "figure", ".svg"},
                                               {"relay", "csv", ".csv"},
                                               {"export", "output", ".c"},
                                               {"excite", "output", ".csv"},
                                               {"excite", "figure", ".svg"},
                                               {"workspace", "csv", ".csv"},
                                               {"workspace", "output", ".svg"},
                                               {"workspace", "worst-to", ".toml"}}) {
    json options{{option, made + ending}};
    if (command == "relay" || command == "excite") options["amplitude"] = 1;
    if (command == "export") options["format"] = "octave";
    if (option == "write" && command == "design") options["notch"] = true;
    expect_bad(command, options);
    EXPECT_FALSE(std::filesystem::exists(made + ending)) << command;
  }
  for (const char* option : {"help", "version", "generate", "-h", "report=x", "set=x", "--set", "h", "o", ""}) {
    expect_bad("analyze", {{option, "x"}});
    expect_bad("analyze", {{option, true}});
  }
  expect_bad("analyze", {{"set", ""}});
  expect_bad("analyze", {{"set", {"a=1", "--report=/tmp/x"}}});
  expect_bad("analyze", {{"set", {{"a", 1}}}});
  expect_bad("analyze", {{"worst-user", "yes"}});
  expect_bad("bode", {{"points", true}});
  expect_bad("bode", {{"points", {10, 20}}});
  expect_bad("design", {{"sweep", std::string("loop.delay=0:1e-3:5\0x", 21)}});
  const std::string id = json::parse(upload(contents("secret.csv")).body).at("id");
  for (const char* name : {"../secret.csv", "/etc/passwd", "--list", "", "a\nb", "-"}) {
    const json request{{"recording", {{"id", id}, {"name", name}}},
                       {"options", {{"force", "force"}, {"position", "position"}}}};
    EXPECT_EQ(post("frf", request.dump()).status, 400) << name;
  }
  // Nor does a message tell where this process holds the bytes.
  const json twice{{"recording", {{"id", id}, {"name", "run.csv"}}},
                   {"options", {{"force", "force"}, {"position", "force"}, {"rate", 1000}}}};
  EXPECT_THAT(
      post("frf", twice.dump()).body,
      HasSubstr(R"("where":"options.position","what":"column 'force' is named as the force and as the motion")"));
  // A name that is a command's or an option's word is a name all the same.
  for (const char* name : {"frf", "device", "FILE", "force=2"}) {
    const json request{{"recording", {{"id", id}, {"name", name}}},
                       {"options", {{"force", "nothing"}, {"position", "position"}}}};
    EXPECT_THAT(post("frf", request.dump()).body, HasSubstr("\"where\":\"options.force\"")) << name;
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, PipelinedRequestsAreEachJudged) {
  Client client(port());
  client.send(
      raw("GET /api/v1/health HTTP/1.1\nHost: 127.0.0.1:{P}\n\n"
          "GET /api/v1/health HTTP/1.1\nHost: evil.example\n\n"
          "GET /api/v1/health HTTP/1.1\nHost: 127.0.0.1:{P}\n\n"));
  EXPECT_EQ(client.answer().status, 200);
  EXPECT_EQ(client.answer().status, 421);
  EXPECT_TRUE(client.is_ended_within(5s));  // nothing more is read of who was refused
  Client smuggler(port());
  smuggler.send(
      raw("POST /api/v1/analyze HTTP/1.1\nHost: 127.0.0.1:{P}\nContent-Type: application/json\nContent-Length: 2\n\n"
          "{}GET /api/v1/health HTTP/1.1\nHost: 127.0.0.1:{P}\n\n"));
  EXPECT_EQ(smuggler.answer().status, 400);
  EXPECT_EQ(smuggler.answer().status, 200);
  Client many(port());
  std::string requests;
  for (int i = 0; i < 300; ++i) requests += request("GET", "/api/v1/health");
  many.send(requests);
  for (int i = 0; i < 300; ++i) ASSERT_EQ(many.answer().status, 200) << i;
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, SlowClientsAreToldSo) {
  Client silent(port());
  Client slow_head(port());
  slow_head.send("GET / HTTP/1.1\r\n");
  std::vector<std::thread> others;
  int of_dripping_head = 0;
  others.emplace_back([&] {
    Client drips(port());
    drips.send("GET / HTTP/1.1\r\n");
    std::atomic<bool> is_over = false;
    std::thread answers([&] {
      of_dripping_head = drips.answer().status;
      is_over = true;
    });
    for (int i = 0; i < 30 && !is_over; ++i) {
      drips.send("X: y\r\n");
      std::this_thread::sleep_for(1s);
    }
    answers.join();
  });
  int of_slow_body = 0;
  others.emplace_back([&] {
    Client slow_body(port());
    slow_body.send(
        raw("POST /api/v1/analyze HTTP/1.1\nHost: 127.0.0.1:{P}\nContent-Type: application/json\n"
            "Content-Length: 1000\n\n"));
    std::atomic<bool> is_over = false;
    std::thread answers([&] {
      of_slow_body = slow_body.answer().status;
      is_over = true;
    });
    for (int i = 0; i < 90 && !is_over; ++i) {
      slow_body.send(" ");
      std::this_thread::sleep_for(1s);
    }
    answers.join();
  });
  EXPECT_TRUE(silent.is_ended_within(20s));
  EXPECT_EQ(slow_head.answer().status, 408);
  EXPECT_TRUE(slow_head.is_ended_within(5s));
  for (std::thread& each : others) each.join();
  EXPECT_EQ(of_dripping_head, 408);
  EXPECT_EQ(of_slow_body, 408);
  EXPECT_TRUE(is_alive());
}

TEST_F(Hostile, PagesMayLoadNothingForeign) {
  const HttpAnswer page = get("/");
  EXPECT_EQ(page.status, 200);
  for (const char* header : {"Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; ",
                             "frame-ancestors 'none'", "base-uri 'none'", "form-action 'none'",
                             "X-Content-Type-Options: nosniff\r\n", "Referrer-Policy: no-referrer\r\n",
                             "X-Frame-Options: DENY\r\n", "Cross-Origin-Resource-Policy: same-origin\r\n"}) {
    EXPECT_THAT(page.head, HasSubstr(header));
  }
  EXPECT_THAT(page.head, ::testing::Not(HasSubstr("unsafe-")));
  EXPECT_THAT(page.head, ::testing::Not(HasSubstr("Access-Control-")));
  for (const char* foreign : {"http://", "https://", "src=\"//"})
    EXPECT_THAT(page.body, ::testing::Not(HasSubstr(foreign)));
  const HttpAnswer zipped = exchange(request("GET", "/", "", "Accept-Encoding: gzip, br\r\n"));
  EXPECT_THAT(zipped.head, HasSubstr("Content-Encoding: gzip\r\n"));
  EXPECT_TRUE(zipped.body.starts_with("\x1f\x8b"));
  EXPECT_EQ(exchange(request("GET", "/", "", "Accept-Encoding: gzip;q=0\r\n")).body, page.body);
}

}  // namespace
}  // namespace zwidth::cli
