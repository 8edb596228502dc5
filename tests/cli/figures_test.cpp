#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Figures : public Workspace {
 protected:
  [[nodiscard]] bool exists(const std::string& name) const { return fs::exists(directory() / name); }
  void expect_refusal(const std::string& command, int status, const std::string& message) const {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, status) << command;
    EXPECT_THAT(outcome.errors, HasSubstr(message)) << command;
    EXPECT_THAT(outcome.errors, StartsWith("zwidth: ")) << command;
  }
};

// Without the last column, `trust`.
std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream cells(line.substr(0, line.rfind(',')));
  for (std::string cell; std::getline(cells, cell, ',');)
    numbers.push_back(cell.empty() ? std::nan("") : std::stod(cell));
  return numbers;
}

// A picture and a table have the same options everywhere.
TEST_F(Figures, EveryCommandWithAPictureDrawsIt) {
  const std::string locked = "identify recordings/locked_chirp.csv --force force --position position --method ";
  const std::string study =
      "study devices/lhifam.toml --study devices/studies/lhifam.toml --samples 200 --index-samples 0";
  ASSERT_EQ(run("cp -r " ZWIDTH_SOURCE_DIR "/recordings .").status, 0);
  for (const std::string& command :
       {std::string("analyze devices/lhifam.toml"), study,
        locked + "frequency-response --structure devices/lhifam.toml --free link.stiffness --locked handle",
        std::string("rig measure devices/lhifam.toml --duration 1"), std::string("rig relay devices/lhifam.toml"),
        std::string("rig wall devices/lhifam.toml --stiffness 3000 --duration 1"),
        std::string("rig limit devices/lhifam.toml")}) {
    SCOPED_TRACE(command);
    const Outcome outcome = run("rm -f a.svg && zwidth " + command + " --figure a.svg");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_THAT(contents("a.svg"), HasSubstr("</svg>"));
    expect_refusal("zwidth " + command + " --figure a.bmp", 2, "unknown extension");
  }
  expect_refusal("zwidth rig check devices/lhifam.toml --figure a.svg", 2, "--figure: is not for rig check");
  expect_refusal("zwidth analyze devices/lhifam.toml devices/lhifam_rigid.toml --figure a.svg", 2, "--figure: ");
}

TEST_F(Figures, AWidthIsThatOnPaper) {
  const std::string bode = "zwidth bode devices/lhifam.toml --figure ";
  ASSERT_EQ(
      run(bode + "a.svg --width 85mm && " + bode + "a.pdf --width 8.5cm && " + bode + "a.png --width 85mm").status, 0);
  EXPECT_THAT(contents("a.svg"), HasSubstr("<svg width=\"85mm\" height=\""));
  EXPECT_THAT(contents("a.pdf"), HasSubstr("/MediaBox [ 0 0 240 ")) << "points";
  const std::string png = contents("a.png");
  ASSERT_GT(png.size(), 20U);
  const auto byte = [&](std::size_t at) { return static_cast<unsigned>(static_cast<unsigned char>(png[at])); };
  EXPECT_NEAR(byte(18) * 256U + byte(19), 85.0 / 25.4 * 600.0, 1.0) << "600 dots per inch";
  expect_refusal(bode + "a.svg --width 85", 2, "--width: is 85000 mm");
  expect_refusal(bode + "a.svg --width 10mm", 2, "--width: is 10 mm");
  expect_refusal(bode + "a.svg --width 85kg", 2, "--width: ");
  expect_refusal(bode + "a.csv --width 85mm", 2, "--width: is for a figure");
  expect_refusal("zwidth bode devices/lhifam.toml --width 85mm", 2, "--width");
}

// Every text begins and ends on the page, frames stand beside each other on wide paper alone.
TEST_F(Figures, OnAnyWidthNothingLeavesThePage) {
  for (const std::string& command :
       {std::string("region devices/lhifam.toml"), std::string("analyze devices/lhifam.toml"),
        std::string("bode devices/lhifam.toml"), std::string("excite --amplitude 5")}) {
    for (const double width : {60.0, 85.0, 170.0, 400.0}) {
      SCOPED_TRACE(fmt::format("{} {} mm", command, width));
      ASSERT_EQ(run(fmt::format("zwidth {} --figure a.svg --width {}mm", command, width)).status, 0);
      const std::string svg = contents("a.svg");
      double page = 0.0;
      ASSERT_EQ(std::sscanf(svg.c_str() + svg.find("viewBox=\"0 0 "), "viewBox=\"0 0 %lf", &page), 1);
      std::size_t texts = 0;
      const std::string moved = "<g transform=\"translate(";
      for (std::size_t at = svg.find(moved); at != std::string::npos; at = svg.find(moved, at + 1)) {
        double x = 0.0;
        ASSERT_EQ(std::sscanf(svg.c_str() + at + moved.size(), "%lf", &x), 1);
        EXPECT_GE(x, 0.0);
        EXPECT_LE(x, page);
        ++texts;
      }
      EXPECT_GT(texts, 10U);
    }
  }
}

TEST_F(Figures, EveryCommandWithATableWritesIt) {
  ASSERT_EQ(run("zwidth analyze devices/lhifam.toml devices/capstan_paddle.toml --csv limits.csv && "
                "zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml --samples 200 --index-samples 0 "
                "--csv units.csv")
                .status,
            0);
  const auto lines_of = [&](const std::string& name) {
    std::istringstream rows(contents(name));
    std::vector<std::string> lines;
    for (std::string line; std::getline(rows, line);) lines.push_back(line);
    return lines;
  };
  const std::vector<std::string> limits = lines_of("limits.csv");
  ASSERT_EQ(limits.size(), 3U);
  EXPECT_EQ(limits.front(), "device,critical_stiffness,status,nobody,user,any_user,frequency_hz,stiffness_unit,trust");
  const auto document = nlohmann::json::parse(run("zwidth analyze devices/lhifam.toml --json").output);
  EXPECT_THAT(limits[1], HasSubstr(fmt::format(",{:.17g},finite,", document["critical_stiffness"].get<double>())));
  EXPECT_THAT(limits[1], ::testing::EndsWith(",N/m,sound"));
  const std::vector<std::string> units = lines_of("units.csv");
  ASSERT_EQ(units.size(), 201U);
  EXPECT_THAT(units.front(), StartsWith("sample,"));
  EXPECT_THAT(units.front(), ::testing::EndsWith(",critical_stiffness,status,mode,trust"));
}

TEST_F(Figures, BodeListsCrossoversWithoutAnOutput) {
  const Outcome outcome = run("zwidth bode devices/lhifam.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("<- limits"));
  EXPECT_THAT(outcome.output, HasSubstr("--output"));
}

TEST_F(Figures, BodeDrawsByExtension) {
  ASSERT_EQ(run("zwidth bode devices/lhifam.toml -o a.svg && zwidth bode devices/lhifam.toml -o a.PNG && "
                "zwidth bode devices/lhifam.toml devices/lhifam_rigid.toml --output a.pdf")
                .status,
            0);
  EXPECT_THAT(contents("a.svg"), HasSubstr("rigid body: critical"));
  EXPECT_THAT(contents("a.PNG"), StartsWith("\x89PNG"));
  EXPECT_THAT(contents("a.pdf"), StartsWith("%PDF"));
}

TEST_F(Figures, CsvIsTheLibrarysResponse) {
  ASSERT_EQ(run("zwidth bode devices/lhifam.toml --set loop.delay=2.25e-3 --to 5000 --output a.csv").status, 0);
  const Device device =
      *read_device_file((directory() / "devices/lhifam.toml").string(), std::vector<std::string>{"loop.delay=2.25e-3"});
  const SampledPlant plant = sampled_plant(device);
  const ModalForm form = modal_form(device);
  std::istringstream lines(contents("a.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "frequency_rad_s,frequency_hz,magnitude_db,phase_deg,continuous_magnitude_db,continuous_phase_deg,trust");
  constexpr double degree = std::numbers::pi / 180.0;
  std::size_t rows = 0;
  double last = 0.0;
  while (std::getline(lines, line)) {
    const std::vector<double> row = numbers_of(line);
    ASSERT_EQ(row.size(), 6U) << line;
    EXPECT_GT(row[0], last);
    last = row[0];
    EXPECT_NEAR(row[1], row[0] / (2.0 * std::numbers::pi), 1e-12 * row[0]);
    const auto continuous = std::polar(std::pow(10.0, row[4] / 20.0), row[5] * degree);
    EXPECT_LT(std::abs(continuous - response(form, row[0])), 1e-9 * std::abs(continuous)) << line;
    if (row[0] > std::numbers::pi / 1e-3) {
      EXPECT_TRUE(std::isnan(row[2]) && std::isnan(row[3])) << line;
    } else {
      const auto sampled = std::polar(std::pow(10.0, row[2] / 20.0), row[3] * degree);
      EXPECT_LT(std::abs(sampled - response(plant, row[0])), 1e-9 * std::abs(sampled)) << line;
    }
    ++rows;
  }
  EXPECT_GE(rows, 400U);
  EXPECT_NEAR(last, 5000.0, 1e-9);
}

TEST_F(Figures, JsonIsOneLinePerDevice) {
  const Outcome outcome = run("zwidth bode devices/lhifam.toml devices/lhifam_rigid.toml --json --points 10");
  ASSERT_EQ(outcome.status, 0);
  std::istringstream lines(outcome.output);
  std::string line;
  int documents = 0;
  while (std::getline(lines, line)) {
    const auto document = nlohmann::json::parse(line);
    EXPECT_EQ(document.at("schema"), "zwidth.bode/1");
    EXPECT_EQ(document.at("sampled").at("frequency_rad_s").size(), document.at("sampled").at("phase_deg").size());
    EXPECT_FALSE(document.at("crossovers").empty());
    ++documents;
  }
  EXPECT_EQ(documents, 2);
}

TEST_F(Figures, TheVirtualDamperIsClosedInTheMarkedCurve) {
  // At a crossover the closed response is -1/K; the csv is asked for just that frequency.
  const std::string damper = "--set wall.damping=5 --set wall.velocity_filter_hz=60 ";
  const auto analysis = nlohmann::json::parse(run("zwidth analyze devices/lhifam.toml --json " + damper).output);
  const double frequency = analysis.at("critical_frequency_rad_s");
  ASSERT_EQ(
      run(fmt::format("zwidth bode devices/lhifam.toml {} --from {:.17g} --output a.csv", damper, frequency)).status,
      0);
  std::istringstream lines(contents("a.csv"));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  const std::vector<double> row = numbers_of(line);
  EXPECT_NEAR(row[0], frequency, 1e-9 * frequency);
  EXPECT_NEAR(row[2], -analysis.at("critical_stiffness_db").get<double>(), 1e-7);
  EXPECT_NEAR(row[3], -180.0, 1e-6);
}

TEST_F(Figures, PhaseKeepsContinuousWithAVirtualDamperAndALongDelay) {
  ASSERT_EQ(run("zwidth bode devices/lhifam.toml --set wall.damping=200 --set loop.delay=40e-3 --output a.csv").status,
            0);
  std::istringstream lines(contents("a.csv"));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  double last = numbers_of(line)[3];
  while (std::getline(lines, line)) {
    const std::vector<double> row = numbers_of(line);
    // At the Nyquist frequency itself the response turns real at once.
    if (row[0] < 0.999 * std::numbers::pi / 1e-3) {
      EXPECT_LT(std::abs(row[3] - last), 90.0) << line;
    }
    last = row[3];
  }
}

TEST_F(Figures, BodeRefusals) {
  expect_refusal("zwidth bode devices/lhifam.toml --output a.jpg", 2, "unknown extension; .svg, .png, .pdf or .csv");
  expect_refusal("zwidth bode devices/lhifam.toml --from 0 -o a.svg", 2, "--from: is 0; must be a number of rad/s > 0");
  expect_refusal("zwidth bode devices/lhifam.toml --to nan -o a.svg", 2, "--to: is nan");
  expect_refusal("zwidth bode devices/lhifam.toml --from 100 --to 10 -o a.svg", 2,
                 "--to: is 10 rad/s; above the lowest frequency, 100 rad/s");
  expect_refusal("zwidth bode devices/lhifam.toml --from 4000 --to 5000 -o a.svg", 2, "below the Nyquist frequency");
  expect_refusal("zwidth bode devices/lhifam.toml --points 1 -o a.svg", 2, "--points");
  expect_refusal("zwidth bode devices/lhifam.toml devices/lhifam_rigid.toml -o a.csv", 2, "one device");
  expect_refusal("zwidth bode devices/lhifam.toml devices/quanser_torsion.toml -o a.svg", 2, "linear and rotary");
  expect_refusal("d=devices/lhifam.toml; zwidth bode $d $d $d $d $d -o a.svg", 2, "at most 4");
  expect_refusal("mkdir a.svg; zwidth bode devices/lhifam.toml -o a.svg", 1, "is a directory");
  expect_refusal("zwidth bode devices/lhifam.toml -o none/a.png", 1, "none/a.png: cannot write");
  EXPECT_FALSE(exists("a.jpg"));
}

TEST_F(Figures, AFailedFigureLeavesTheOldFile) {
  write("a.svg", "old");
  // Without gnuplot on the path.
  const Outcome outcome =
      run("program=$(command -v zwidth); PATH=/nonexistent $program bode devices/lhifam.toml -o a.svg");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("apt-get install gnuplot-nox"));
  EXPECT_EQ(contents("a.svg"), "old");
}

TEST_F(Figures, ACrossoverAtRestIsListedAndNotPlotted) {
  write("rest.toml", "[transfer_function]\nnumerator = [-1]\ndenominator = [1, 1]\n[loop]\nsampling_period = 0.1\n");
  const Outcome outcome = run("zwidth analyze --json rest.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const auto answer = nlohmann::json::parse(outcome.output);
  EXPECT_NEAR(answer.at("critical_stiffness").get<double>(), 1.0, 1e-12);
  EXPECT_EQ(answer.at("critical_frequency_hz"), 0.0);
  ASSERT_EQ(run("zwidth bode rest.toml -o a.svg && zwidth bode rest.toml -o a.csv && "
                "zwidth analyze rest.toml --report a.html")
                .status,
            0);
  for (const char* name : {"a.svg", "a.html"}) {
    EXPECT_THAT(contents(name), HasSubstr("at 0 Hz (a real pole at rest)")) << name;
    EXPECT_THAT(contents(name), Not(HasSubstr("inf"))) << name;
  }
  EXPECT_THAT(contents("a.csv"), Not(HasSubstr("nan")));
  EXPECT_THAT(run("zwidth bode rest.toml").output, HasSubstr("<- limits, a real pole at rest"));
}

TEST_F(Figures, OptionsOfTheFigureNeedOne) {
  for (const std::string option : {"--from", "--to", "--points"}) {
    expect_refusal("zwidth bode devices/lhifam.toml " + option + " 10", 2, option + ": is for a figure");
  }
  EXPECT_EQ(run("zwidth bode devices/lhifam.toml --points 10 --json").status, 0);
}

TEST_F(Figures, ReproduceFillsAFolderAndLeavesTheRestAlone) {
  const Outcome outcome =
      run("mkdir -p paper/lhifam; echo mine > paper/lhifam/notes.txt; zwidth reproduce paper/lhifam");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const auto figures = {"figure_03.svg", "figure_04.svg",          "figure_07.svg",        "figure_08.svg",
                        "figure_09.svg", "figure_10.svg",          "figure_10_delays.svg", "figure_11.svg",
                        "figure_12.svg", "figure_12_friction.svg", "figure_14.svg"};
  for (const std::string name : figures) EXPECT_GT(contents("paper/lhifam/" + name).size(), 10000U) << name;
  EXPECT_GT(contents("paper/lhifam/index.html").size(), 100000U);
  EXPECT_EQ(contents("paper/lhifam/notes.txt"), "mine\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(directory() / "paper/lhifam"), fs::directory_iterator()),
            static_cast<std::ptrdiff_t>(figures.size()) + 2);
}

TEST_F(Figures, ReproduceRefusals) {
  expect_refusal("zwidth reproduce", 2, "OUTDIR");
  expect_refusal("echo x > file; zwidth reproduce file", 1, "file");
  expect_refusal("echo x > file; timeout 2 zwidth reproduce file/below", 1, "cannot make the directory");
}

TEST_F(Figures, BodeTakesItsRangeInHertz) {
  ASSERT_EQ(run("zwidth bode devices/lhifam.toml --from-hz 1 --to-hz 100 --csv hertz.csv").status, 0);
  ASSERT_EQ(
      run("zwidth bode devices/lhifam.toml --from 6.283185307179586 --to 628.3185307179587 --output rad.csv").status,
      0);
  EXPECT_EQ(contents("hertz.csv"), contents("rad.csv"));
  expect_refusal("zwidth bode devices/lhifam.toml --from 1 --from-hz 1 --csv a.csv", 2, "--from");
}

}  // namespace
}  // namespace zwidth::cli
