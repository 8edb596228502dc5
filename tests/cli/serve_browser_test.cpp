// What a browser gets: it is opened at the address, and answered soon.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "cli/served.hpp"
#include "zwidth/zwidth.hpp"

namespace zwidth::cli {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

class ServeBrowser : public Served {
 protected:
  /// Least time of so many calls, ms: of the work itself, whatever else the machine does.
  template <typename Work>
  [[nodiscard]] static double least_ms(int calls, const Work& work) {
    double least = 1e9;
    for (int i = 0; i < calls; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      work();
      least =
          std::min(least, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
    return least;
  }
};

TEST_F(ServeBrowser, IsOpenedAtTheAddress) {
  const std::string folder = directory().string() + "/programs";
  const std::string opened = directory().string() + "/opened";
  std::filesystem::create_directory(folder);
  std::ofstream(folder + "/xdg-open") << "#!/bin/sh\necho \"$1\" > " << opened << ".part && mv " << opened << ".part "
                                      << opened << "\n";
  ASSERT_EQ(::chmod((folder + "/xdg-open").c_str(), 0755), 0);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder + ":" + path).c_str(), 1);
  start({"--open"});
  ::setenv("PATH", path.c_str(), 1);
  const auto end = std::chrono::steady_clock::now() + 10s;
  while (!std::filesystem::exists(opened) && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(10ms);
  std::ifstream file(opened);
  std::string asked;
  std::getline(file, asked);
  EXPECT_EQ(asked, address());
}

TEST_F(ServeBrowser, AnalyzeTakesAtMostHalfAMillisecondMoreThanTheLibrary) {
  start();
  const std::string toml = contents("devices/lhifam.toml");
  const tl::expected<Device, InputError> device = parse_device(toml, "device");
  ASSERT_TRUE(device);
  double stiffness = 0.0;
  const double library = least_ms(300, [&] { stiffness = analyze(*device).critical.stiffness; });
  const std::string asked = request("POST", "/api/v1/analyze", nlohmann::json{{"device_toml", toml}}.dump(),
                                    "Content-Type: application/json\r\n");
  Client client(port());
  std::string body;
  const double served = least_ms(300, [&] {
    client.send(asked);
    body = client.answer().body;
  });
  EXPECT_EQ(nlohmann::json::parse(body).at("critical_stiffness"), stiffness);
  EXPECT_LT(served, library + 0.5) << "the library's own: " << library << " ms";
  std::cout << "analyze: " << library << " ms, over HTTP " << served << " ms\n";
}

}  // namespace
}  // namespace zwidth::cli
