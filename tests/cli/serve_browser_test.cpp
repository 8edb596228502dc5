// A browser is opened at the address.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "cli/served.hpp"

namespace zwidth::cli {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

class ServeBrowser : public Served {};

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

}  // namespace
}  // namespace zwidth::cli
