// What docs/rig_drives.md and docs/rig_method.md show of drives, as it stands there: the [driver] table, the commands, the rates of the lines.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "rig/drive_kinds.hpp"
#include "rig/printing_process.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/serial_device.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::rig {
namespace {

using test::DriveKind;

std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string document_of_buses() { return text_of(ZWIDTH_SOURCE_DIR "/docs/rig_can.md"); }

std::string document() {
  return text_of(ZWIDTH_SOURCE_DIR "/docs/rig_drives.md") + text_of(ZWIDTH_SOURCE_DIR "/docs/rig_method.md");
}

/// The lines of all fenced blocks of a language.
std::vector<std::string> lines_of(const std::string& language) {
  std::stringstream text(document());
  std::vector<std::string> lines;
  bool is_inside = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      is_inside = !is_inside && line == "```" + language;
    } else if (is_inside) {
      lines.push_back(line);
    }
  }
  return lines;
}

/// A carriage with the documents' [driver], at a rate that a busy machine keeps.
std::string belt() {
  std::string text =
      "name = \"belt\"\nmotion = \"linear\"\n[[body]]\nname = \"carriage\"\nmass = 2\ndamping = 8\n"
      "[loop]\nsampling_period = 0.04\n";
  for (const std::string& line : lines_of("toml")) text += line + "\n";
  return text;
}

TEST(Documents, TheirDriverTableIsRead) {
  const auto device = parse_device(belt(), "belt.toml");
  ASSERT_TRUE(device) << device.error().str();
  const MotorDrive& drive = device->parameters().driver.value();
  EXPECT_DOUBLE_EQ(drive.position_per_turn(), -0.0125) << "25 mm, a gear of 2, backwards";
  EXPECT_DOUBLE_EQ(drive.torque_constant.value(), 0.05);
  EXPECT_EQ(drive.baud, 921600);
}

// With the port that the emulator prints in the place of theirs.
TEST(Documents, TheirCommandsRunOnTheEmulatorThatTheyName) {
  std::string name = (std::filesystem::temp_directory_path() / "zwidth_documents_XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  const std::filesystem::path folder = name;
  std::ofstream(folder / "belt.toml") << belt();
  int emulators = 0;
  int commands = 0;
  for (const std::string& line : lines_of("text")) {
    std::smatch kind;
    if (std::regex_search(line, kind, std::regex("drive_emulator (\\w+) belt\\.toml"))) {
      EXPECT_EQ(kind[1], "odrive");
      ++emulators;
    }
    if (!line.starts_with("zwidth ")) continue;
    const test::PrintingProcess emulator({ZWIDTH_DRIVE_EMULATOR, "odrive", (folder / "belt.toml").string()});
    std::string port = emulator.line();
    ASSERT_FALSE(port.empty());
    port.pop_back();
    const std::string command =
        fmt::format("cd {} && {}{} > output 2>&1", folder.string(), ZWIDTH_PROGRAM,
                    std::regex_replace(line.substr(6), std::regex("odrive:/dev/[^ ]+"), "odrive:" + port));
    int status = -1;
    for (int i = 0; i < 3 && status != 0; ++i) status = std::system(command.c_str());  // a machine that pauses stops it
    EXPECT_EQ(status, 0) << line << "\n" << text_of(folder / "output");
    ++commands;
  }
  EXPECT_EQ(emulators, 1);
  EXPECT_EQ(commands, 3);
  const auto measured = read_device_file((folder / "measured.toml").string());
  ASSERT_TRUE(measured);
  EXPECT_GT(measured->loop().delay, 0.0);
  std::filesystem::remove_all(folder);
}

class DocumentedDrive : public testing::TestWithParam<DriveKind> {};

TEST_P(DocumentedDrive, CarriesWhatItsRowSays) {
  const std::string row = fmt::format("\\| `{}` \\| [^\\n]* \\| (\\d+) \\| (\\d+) \\| (\\d+) \\|\\n", GetParam().name);
  std::smatch cells;
  const std::string text = document();
  ASSERT_TRUE(std::regex_search(text, cells, std::regex(row)));
  const Device device = test::belt_device();
  test::PtyEmulator emulator(GetParam().firmware(), device);
  const auto driver =
      GetParam().driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  const DriverFacts& facts = driver->facts();
  EXPECT_EQ(std::stoi(cells[1]), std::lround(10.0 * facts.byte_rate.value()));
  EXPECT_EQ(std::stod(cells[2]), facts.bytes_per_cycle);
  EXPECT_EQ(std::stod(cells[3]), std::floor(0.8 * facts.byte_rate.value() / facts.bytes_per_cycle));
}

INSTANTIATE_TEST_SUITE_P(Drive, DocumentedDrive, testing::ValuesIn(test::drive_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

class DocumentedBus : public testing::TestWithParam<DriveKind> {};

TEST_P(DocumentedBus, CarriesWhatItsRowSays) {
  const std::string row =
      fmt::format("\\| `{}` \\| [^\\n]* \\| (\\d+)[^|]* \\| (\\d+) us \\| (\\d+) \\|\\n", GetParam().name);
  std::smatch cells;
  const std::string text = document_of_buses();
  ASSERT_TRUE(std::regex_search(text, cells, std::regex(row)));
  const Device device = test::belt_device_of(GetParam());
  test::PtyEmulator emulator(GetParam().firmware(), device);
  const auto driver =
      GetParam().driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  const DriverFacts& facts = driver->facts();
  EXPECT_EQ(std::stod(cells[2]), std::round(1e6 * facts.bus_time_per_cycle));
  const double cycle = facts.bus_time_per_cycle + facts.bytes_per_cycle / facts.byte_rate.value();
  EXPECT_EQ(std::stod(cells[3]), std::floor(0.8 / cycle));
}

INSTANTIATE_TEST_SUITE_P(Can, DocumentedBus, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);

}  // namespace
}  // namespace zwidth::rig
