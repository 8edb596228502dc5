// Sketches and bridges compile for what they are made for, without a warning; libraries of vendors are stubs of the functions
// that are used (tests/rig/stubs).
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace zwidth::rig {
namespace {

const std::string source_folder = ZWIDTH_SOURCE_DIR;
const std::string stub_headers = " -I" + source_folder + "/tests/rig/stubs";
const std::string firmware_headers = " -I" + source_folder + "/firmware";
const std::string strict_warnings = " -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror";

bool runs(const std::string& command) { return std::system((command + " 2>&1").c_str()) == 0; }
bool is_there(const std::string& program) { return runs("command -v " + program + " > /dev/null"); }

class FirmwareBuild : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "zwidth_firmware_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  [[nodiscard]] bool compiles(const std::string& compiler, const std::string& file) const {
    return runs(compiler + " -c " + file + " -o " + (folder / "object.o").string());
  }
  std::filesystem::path folder;
};

TEST_F(FirmwareBuild, TheHeaderForEveryLanguageAndProcessor) {
  const std::string header = " -x c " + source_folder + "/firmware/zwidth_serial.h";
  const std::string of_cpp = " -x c++ " + source_folder + "/firmware/zwidth_serial.h";
  const auto is_clean = [&](const std::string& compiler, const std::string& file) {
    return runs(compiler + strict_warnings + " -Wno-unused-function -fsyntax-only" + file);
  };
  EXPECT_TRUE(is_clean("cc -std=c99", header));
  EXPECT_TRUE(is_clean("c++ -std=c++11", of_cpp));
  for (const std::string processor : {"atmega328p", "atmega2560", "atmega32u4"}) {
    if (is_there("avr-gcc")) {
      EXPECT_TRUE(is_clean("avr-gcc -std=c99 -mmcu=" + processor, header));
    }
  }
  for (const std::string processor : {"cortex-m0plus", "cortex-m4", "cortex-m7"}) {  // Pico; STM32, Teensy 3; Teensy 4
    if (!is_there("arm-none-eabi-gcc")) continue;
    EXPECT_TRUE(is_clean("arm-none-eabi-gcc -std=c99 -mthumb -mcpu=" + processor, header));
    EXPECT_TRUE(is_clean("arm-none-eabi-g++ -std=gnu++14 -mthumb -mcpu=" + processor, of_cpp));
  }
}

TEST_F(FirmwareBuild, TheSketchOfASimplefocMotor) {
  const std::string sketch = " -x c++ " + source_folder + "/firmware/examples/simplefoc_motor/simplefoc_motor.ino";
  EXPECT_TRUE(compiles("c++ -std=gnu++14 -Wall -Wextra -Werror" + stub_headers + firmware_headers, sketch));
  if (!is_there("arm-none-eabi-g++")) GTEST_SKIP() << "scripts/install-dependencies tests brings the compiler";
  EXPECT_TRUE(compiles(
      "arm-none-eabi-g++ -std=gnu++14 -mcpu=cortex-m4 -mthumb -Wall -Wextra -Werror" + stub_headers + firmware_headers,
      sketch));
}

// With the wall that the program writes for its device file.
TEST_F(FirmwareBuild, TheSketchOfAPaddleWithAWallOfItsOwn) {
  const std::string core = "/usr/share/arduino/hardware/arduino/avr";
  const std::string paddle = source_folder + "/firmware/examples/hapkit_paddle/hapkit_paddle";
  ASSERT_TRUE(runs(ZWIDTH_PROGRAM " export " + paddle +
                   ".toml --format c --safety-factor 0.5 --accept-doubt --output " + (folder / "wall.h").string() +
                   " > /dev/null"));
  if (!is_there("avr-g++") || !std::filesystem::exists(core))
    GTEST_SKIP() << "scripts/install-dependencies tests brings the compiler";
  EXPECT_TRUE(
      compiles("avr-g++ -mmcu=atmega328p -DF_CPU=16000000L -DARDUINO=10807 -Os -std=gnu++11 -Wall -Wextra -Werror"
               " -I" +
                   core + "/cores/arduino -I" + core + "/variants/standard -include Arduino.h -I" + folder.string() +
                   firmware_headers,
               "-x c++ " + paddle + ".ino"));
}

TEST_F(FirmwareBuild, TheBridgesToDevicesOfVendors) {
  for (const std::string vendor : {"force_dimension", "openhaptics"}) {
    EXPECT_TRUE(
        compiles("cc -std=c99 -O1 -Wall -Wextra -Werror" + stub_headers + " -I" + source_folder + "/examples/udp_drive",
                 source_folder + "/examples/bridges/" + vendor + ".c"));
  }
}

}  // namespace
}  // namespace zwidth::rig
