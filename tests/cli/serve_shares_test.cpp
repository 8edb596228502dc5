// What one client may hold of a server that others use too.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/served.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

constexpr const char* one = "127.0.0.2";
constexpr const char* other = "127.0.0.3";

class ServeShares : public Served {
 protected:
  ServeShares() {
    start({"--host", "0.0.0.0"});
    authorization_ = "Authorization: Bearer " + address().substr(address().find('=') + 1) + "\r\n";
  }

  [[nodiscard]] std::string health() const { return request("GET", "/api/v1/health", "", authorization_); }
  /// Work of some seconds.
  [[nodiscard]] std::string work() const {
    const nlohmann::json document{{"device_toml", contents("devices/lhifam.toml")},
                                  {"options", {{"sweep", "loop.delay=0:8e-3:10000"}, {"any-user", true}}}};
    return request("POST", "/api/v1/design", document.dump(), authorization_ + "Content-Type: application/json\r\n");
  }
  [[nodiscard]] HttpAnswer answer_to(const char* from) const {
    Client client(port(), from);
    client.send(health());
    return client.answer();
  }

 private:
  std::string authorization_;
};

TEST_F(ServeShares, HalfOfTheConnectionsAreAsManyAsOneClientHas) {
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 128; ++i) clients.push_back(std::make_unique<Client>(port(), one));
  clients.back()->send(health());
  EXPECT_EQ(clients.back()->answer().status, 200);
  const HttpAnswer refused = answer_to(one);
  EXPECT_EQ(refused.status, 429);
  EXPECT_THAT(refused.head, HasSubstr("Retry-After: 1\r\n"));
  EXPECT_THAT(refused.head, HasSubstr("X-Content-Type-Options: nosniff\r\n"));
  EXPECT_THAT(refused.body, HasSubstr(R"("what":"too many connections of yours")"));
  EXPECT_EQ(answer_to(other).status, 200);
  clients.resize(100);
  const auto end = std::chrono::steady_clock::now() + 10s;
  while (answer_to(one).status != 200 && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(answer_to(one).status, 200);
}

TEST_F(ServeShares, HalfOfTheRequestsThatWaitAreAsManyAsOneClientHas) {
  std::vector<std::unique_ptr<Client>> clients;
  std::vector<std::thread> waits;
  std::atomic<int> refused = 0;
  for (int i = 0; i < 40; ++i) {
    clients.push_back(std::make_unique<Client>(port(), one));
    clients.back()->send(work());
  }
  for (auto& client : clients) {
    waits.emplace_back([&] {
      const HttpAnswer answer = client->answer();
      if (answer.status == 429 && answer.body.find("too many requests of yours wait") != std::string::npos) ++refused;
    });
  }
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (refused < 8 && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(refused, 8);
  Client waiting(port(), other);
  waiting.send(work());
  EXPECT_EQ(answer_to(one).status, 200);  // what needs no work is answered
  ::kill(process(), SIGINT);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(stop(), 0);
  const HttpAnswer waited = waiting.answer();  // until the second signal ended it
  EXPECT_EQ(waited.status, 503);
  EXPECT_THAT(waited.body, HasSubstr("cancelled"));
  for (std::thread& each : waits) each.join();
  EXPECT_EQ(refused, 8);
}

}  // namespace
}  // namespace zwidth::cli
