// What the program loads on demand is its own, or is refused before anything is computed with it.
#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The newest: one of another version may be left from before.
fs::path module_of(const std::string& name) {
  fs::path newest;
  for (const fs::directory_entry& each : fs::directory_iterator(ZWIDTH_MODULES_DIR)) {
    if (!each.path().filename().string().starts_with(name + "-")) continue;
    if (newest.empty() || each.last_write_time() > fs::last_write_time(newest)) newest = each.path();
  }
  return newest;
}

class Modules : public Workspace {};

TEST_F(Modules, ThatAreMissingCutShortOrOfAnotherBuildAreRefused) {
  const fs::path program = directory() / "other/bin";
  const fs::path modules =
      (program / fs::path(ZWIDTH_MODULES_DIR).lexically_relative(ZWIDTH_PROGRAM_DIR)).lexically_normal();
  fs::create_directories(program);
  fs::create_directories(modules);
  fs::copy_file(fs::path(ZWIDTH_PROGRAM_DIR) / "zwidth", program / "zwidth");
  const auto expect_refusals = [&](const std::string& why) {
    for (const char* command :
         {"other/bin/zwidth identify recordings/free_motion.csv --force force --position position --structure rigid",
          "other/bin/zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml --output units.h5"}) {
      const Outcome outcome = run(command);
      EXPECT_EQ(outcome.status, 1) << command;
      EXPECT_THAT(outcome.output, IsEmpty()) << command;
      EXPECT_THAT(outcome.errors, HasSubstr(why)) << command;
    }
    for (const fs::directory_entry& each : fs::directory_iterator(directory())) {
      EXPECT_FALSE(each.path().filename().string().starts_with("units.h5")) << "nothing was begun: " << each.path();
    }
  };
  const fs::path fits = module_of("fits");
  expect_refusals("a part of zwidth cannot be loaded: " + fits.filename().string());
  const auto whole = fs::file_size(fits);
  fs::copy_file(fits, modules / fits.filename());
  for (const std::uintmax_t left : {whole - 1, whole / 2, std::uintmax_t{9000}, std::uintmax_t{100}}) {
    fs::resize_file(modules / fits.filename(), left);
    expect_refusals(fits.filename().string() + " is cut short, " + std::to_string(left) + " bytes of ");
  }
  fs::copy_file(module_of("kernel"), modules / fits.filename(), fs::copy_options::overwrite_existing);
  expect_refusals(fits.filename().string() + " is of another build than the program");
}

}  // namespace
}  // namespace zwidth::cli
