#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "io/problem_data.hpp"
#include "io/recording_folder.hpp"
#include "io/uff_text.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;  // rad

class ResponseTable : public RecordingFolder {
 protected:
  [[nodiscard]] tl::expected<FrequencyResponse, InputError> read(const std::string& text,
                                                                 const ResponseTableOptions& options = {}) const {
    return read_response_table(write("a.csv", text), options);
  }
  [[nodiscard]] std::string refusal(const std::string& text, const ResponseTableOptions& options = {}) const {
    const auto response = read(text, options);
    return response ? "read" : response.error().str().substr(path("a.csv").size() + 1);
  }
};

ResponseTableOptions in_columns(const std::string& magnitude, const std::string& phase) {
  ResponseTableOptions options;
  options.magnitude = magnitude;
  options.phase = phase;
  return options;
}

// One response, P(10 Hz) = 3 + 4j and P(20 Hz) = -2j, in every way that it is written.
struct Written {
  const char* how;
  std::string text;
  ResponseTableOptions options = {};
};

ResponseTableOptions with(void (*set)(ResponseTableOptions&)) {
  ResponseTableOptions options;
  set(options);
  return options;
}

class ResponseWritten : public ResponseTable, public testing::WithParamInterface<Written> {};

INSTANTIATE_TEST_SUITE_P(
    Ways, ResponseWritten,
    testing::Values(Written{"NamedParts", "f,re,im\n10,3,4\n20,0,-2\n"},
                    Written{"UnitsInNames",
                            "Frequency [Hz];Magnitude (dB);Phase [deg]\n10;13.9794000867204;53.13010235415598\n"
                            "20;6.020599913279624;-90\n"},
                    Written{"SuffixesOfUnits",
                            "frequency_rad_s,magnitude_db,phase_rad\n62.83185307179586,13.9794000867204,"
                            "0.9272952180016122\n125.66370614359172,6.020599913279624,-1.5707963267948966\n"},
                    Written{"BothFrequencies",
                            "frequency_rad_s,frequency_hz,magnitude,magnitude_lower,magnitude_upper,phase_deg\n"
                            "62.83,10,5,4,6,53.13010235415598\n125.66,20,2,1,3,-90\n"},
                    Written{"Omega", "omega,real,imag\n62.83185307179586,3,4\n125.66370614359172,0,-2\n"},
                    Written{"DecimalComma", "f;re;im\n10,0;3,0;4,0\n20,0;0,0;-2,0\n"},
                    Written{"Unsorted", "f,re,im\n20,0,-2\n10,3,4\n"},
                    Written{"ComplexBehindFrequency", "10 (3+4j)\n20 (0-2j)\n"},
                    Written{"Numbered", "10 9 3 4\n20 9 0 -2\n", with([](ResponseTableOptions& o) {
                              o.real = "3";
                              o.imaginary = "4";
                            })},
                    Written{"ScaledKilohertzInRadians", "0.01 5000 0.9272952180016122\n0.02 2000 -1.5707963267948966\n",
                            with([](ResponseTableOptions& o) {
                              o.magnitude = "2";
                              o.phase = "3";
                              o.phase_in_degrees = false;
                              o.scale = 1e-3;
                              o.frequency_scale = 1e3 * turn;
                            })},
                    Written{"UnitsGivenAgainstTheNames",
                            "f [rad/s],mag,phase [deg]\n10,5,0.9272952180016122\n20,2,-1.5707963267948966\n",
                            with([](ResponseTableOptions& o) {
                              o.phase_in_degrees = false;
                              o.frequency_scale = turn;
                            })},
                    Written{"DecibelsAsked", "10 13.9794000867204 53.13010235415598\n20 6.020599913279624 -90\n",
                            with([](ResponseTableOptions& o) {
                              o.magnitude = "2";
                              o.phase = "3";
                              o.magnitude_in_db = true;
                            })},
                    Written{"ListOfComplexNumbers", "(1+0j)\n(3+4j)\n-2j\n",
                            with([](ResponseTableOptions& o) { o.frequency_step = 10.0 * turn; })}),
    [](const auto& tested) { return std::string(tested.param.how); });

TEST_P(ResponseWritten, ReadsTheSame) {
  const auto response = read(GetParam().text, GetParam().options);
  ASSERT_TRUE(response.has_value()) << response.error().str();
  ASSERT_EQ(response->points.size(), 2U);
  EXPECT_NEAR(response->points[0].frequency, 10.0 * turn, 1e-12 * turn);
  EXPECT_NEAR(response->points[1].frequency, 20.0 * turn, 1e-12 * turn);
  EXPECT_NEAR(std::abs(response->points[0].value - std::complex(3.0, 4.0)), 0.0, 1e-13);
  EXPECT_NEAR(std::abs(response->points[1].value - std::complex(0.0, -2.0)), 0.0, 1e-13);
  EXPECT_EQ(response->averages, 0.0);
  EXPECT_FALSE(response->sampling_period.has_value());
  EXPECT_EQ(warnings_in(response->remarks), 0U);
}

// What `frf --csv` writes of the critical stiffness was lost on the way back.
TEST_F(ResponseTable, SaysWhatItsCriticalStiffnessIsWorth) {
  const std::string header = "frequency_hz,real,imaginary,trust,trust_reasons\n";
  const auto said = read(header + "1,2,3,doubtful,\"dry friction; repeat it, harder | noise\"\n2,2,3,doubtful,\n");
  ASSERT_TRUE(said && said->trust);
  EXPECT_EQ(said->trust->verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(said->trust->reasons, (std::vector<std::string>{"dry friction; repeat it, harder", "noise"}));
  const auto sound = read(header + "1,2,3,sound,\n2,2,3,sound,\n");
  ASSERT_TRUE(sound && sound->trust);
  EXPECT_TRUE(sound->trust->sound());
  const auto without_reasons = read("frequency_hz,real,imaginary,trust\n1,2,3,refused\n2,2,3,refused\n");
  ASSERT_TRUE(without_reasons && without_reasons->trust);
  EXPECT_TRUE(without_reasons->trust->refused());
  EXPECT_FALSE(read("frequency_hz,real,imaginary\n1,2,3\n2,2,3\n")->trust);
  EXPECT_FALSE(read("frequency_hz,real,imaginary,trust\n1,2,3,0.5\n2,2,3,0.5\n")->trust);
}

TEST_F(ResponseTable, SaysWhereANameOverridesAUnit) {
  const auto response = read("f [rad/s],mag [dB],phase [rad]\n10,0,0\n20,0,0\n");
  ASSERT_TRUE(response.has_value()) << response.error().str();
  EXPECT_EQ(response->points[0].frequency, 10.0);
  for (const char* unit : {"read in rad/s, as its name says", "read in dB", "read in radians"}) {
    EXPECT_TRUE(mentions(response->remarks, unit)) << unit;
  }
}

TEST_F(ResponseTable, LeavesOutZeroAndMissingLinesAndSaysSo) {
  const auto response = read("f,re,im\n0,1,0\n10,3,4\n15,NaN,1\n20,0,-2\n30,1,\n");
  ASSERT_TRUE(response.has_value()) << response.error().str();
  EXPECT_EQ(response->points.size(), 2U);
  EXPECT_TRUE(mentions(response->remarks, "the value at 0 Hz is left out, the first at line 2"));
  EXPECT_TRUE(mentions(response->remarks,
                       "2 of 5 lines have NaN, an infinity or no number and are left out, the first at line 4"));
  EXPECT_EQ(warnings_in(response->remarks), 1U);
}

TEST_F(ResponseTable, PoolsRepeatedFrequenciesWithTheNoiseOfTheRepeats) {
  const auto response = read("f,re,im\n20,0,-2\n10,3,4\n10,5,4\n10,4,1\n20,0,-4\n30,1,0\n");
  ASSERT_TRUE(response.has_value()) << response.error().str();
  ASSERT_EQ(response->points.size(), 3U);
  EXPECT_EQ(response->points[0].value, std::complex<double>(4.0, 3.0));
  EXPECT_NEAR(response->points[0].variance, (2.0 + 2.0 + 4.0) / 6.0, 1e-15);  // sum |H_i - H|^2 / (n (n - 1))
  EXPECT_EQ(response->points[1].value, std::complex<double>(0.0, -3.0));
  EXPECT_NEAR(response->points[1].variance, 1.0, 1e-15);
  // The line that comes once has the mean relative variance of one measurement: (4/25 + 2/9) / 2.
  EXPECT_NEAR(response->points[2].variance, 0.5 * (4.0 / 25.0 + 2.0 / 9.0), 1e-15);
  EXPECT_EQ(response->averages, 2.0);
  EXPECT_TRUE(mentions(response->remarks, "6 lines at 3 frequencies are averaged"));
}

TEST_F(ResponseTable, IntervalsOfRepeatedFrequenciesHoldTheTruth) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 0.1);
  std::size_t held = 0;
  constexpr int tables = 200;
  constexpr int lines = 10;
  for (int table = 0; table < tables; ++table) {
    std::string text = "f,re,im\n";
    for (int i = 0; i < 4 * lines; ++i) {
      text += fmt::format("{},{},{}\n", 10 * (1 + i % lines), 3.0 + normal(random), 4.0 + normal(random));
    }
    const auto response = read(text);
    ASSERT_TRUE(response.has_value()) << response.error().str();
    ASSERT_EQ(response->points.size(), std::size_t{lines});
    for (const ResponsePoint& point : response->points) {
      held += std::abs(point.value - std::complex(3.0, 4.0)) <= confidence_radius(point, response->averages) ? 1U : 0U;
    }
  }
  // 2000 discs of 95 %, within four standard deviations.
  EXPECT_NEAR(static_cast<double>(held) / (tables * lines), 0.95, 0.02);
}

class RefusedResponse : public ResponseTable {
 protected:
  [[nodiscard]] std::string data(const std::string& text, const ResponseTableOptions& options = {}) const {
    const auto response = read(text, options);
    return response ? "read" : data_of(response.error());
  }
};

TEST_F(RefusedResponse, SaysWhatIsNoResponseAtItsLine) {
  EXPECT_EQ(data("f,re,im\n10,3,4\n20,0,-2\n10,3,4\n"), "4:1: frequency: response_line_twice hertz=10 line=2");
  EXPECT_EQ(data("f,re,im\n10,3,4\n-20,0,-2\n"), "3:1: frequency: frequency_out_of_range hertz=-20");
  EXPECT_EQ(data("f,re,im\n10,3,4\n"), "too_few_samples samples=1 lines=1");
  EXPECT_EQ(data("f,mag,phase\n10,3,4\n20,-6,-2\n"), "3:4: mag: magnitude_below_zero value=-6");
  EXPECT_EQ(data("f,re,im\n10,3,4\n20,x,-2\n"), "3:4: re: no_number_in_cell cell=\"x\" decimal_mark=.");
  ResponseTableOptions sampled;
  sampled.sampling_period = 0.01;
  EXPECT_EQ(data("f,re,im\n10,3,4\n50,1,0\n50.1,0,-2\n", sampled),
            "4:1: frequency: frequency_out_of_range hertz=50.1 nyquist=50");
  ResponseTableOptions coherent;
  coherent.coherence = "c";
  EXPECT_EQ(data("f,re,im,c\n10,3,4,0.9\n20,0,-2,1.1\n", coherent), "3:1: coherence: no_share value=1.1");
  ResponseTableOptions large;
  large.scale = 1e300;
  EXPECT_EQ(data("f,re,im\n10,3,4\n20,1e10,-2\n", large), "3:1: sample_too_large scale=1e+300");
}

TEST_F(RefusedResponse, SaysWhichColumnsAreNotClear) {
  EXPECT_EQ(data("10 3 4\n20 0 -2\n"), "no_response_column names=1, 2, 3");
  EXPECT_EQ(data("f,re,real,im\n10,3,3,4\n20,0,0,-2\n"),
            "response_column_ambiguous first=\"re\" second=\"real\" quantity=real");
  EXPECT_EQ(data("f,mag,phase\n10,3,4\n20,6,-2\n", in_columns("mga", "phase")),
            "mga: no_such_column columns=3 names=f, mag, phase meant=mag");
  EXPECT_EQ(data("f,mag,x\n10,3,4\n20,6,-2\n", in_columns("mag", "")),
            "no_response_column names=f, mag, x quantity=phase");
  EXPECT_EQ(data("(1+2j)\n(3+4j)\n"), "no_response_column names=1 quantity=frequency");
  EXPECT_EQ(data("10 3\n20 0\n"), "1:4: 2: no_number_in_cell cell=\"3\" as=complex");
  ResponseTableOptions both;
  both.frequency = "f";
  both.frequency_step = 1.0;
  EXPECT_EQ(data("f,re,im\n10,3,4\n20,0,-2\n", both), "f: asked_for_beside of=frequencies");
}

TEST_F(ResponseTable, RefusesImpossibleOptions) {
  const std::string file = write("a.csv", "f,re,im\n10,3,4\n20,0,-2\n");
  EXPECT_THROW((void)read_response_table(file, with([](ResponseTableOptions& o) { o.scale = 0.0; })), Error);
  EXPECT_THROW((void)read_response_table(file, with([](ResponseTableOptions& o) { o.frequency_scale = -1.0; })), Error);
  EXPECT_THROW((void)read_response_table(file, with([](ResponseTableOptions& o) { o.sampling_period = 0.0; })), Error);
  EXPECT_THROW((void)read_response_table(file, with([](ResponseTableOptions& o) { o.frequency_step = std::nan(""); })),
               Error);
}

TEST_F(ResponseTable, KeepsTheSamplingPeriodAndTheNyquistLine) {
  ResponseTableOptions sampled;
  sampled.sampling_period = 0.01;
  const auto response = read("f,re,im\n10,3,4\n50,-1,0\n", sampled);
  ASSERT_TRUE(response.has_value()) << response.error().str();
  EXPECT_EQ(response->sampling_period, 0.01);
  EXPECT_LE(response->points.back().frequency, std::numbers::pi / 0.01);
}

/// A response at 10 and 20 Hz and a coherence of the same frequencies.
UffFunction uff_response(int ordinate_quantity, std::vector<double> numbers) {
  UffFunction function;
  function.function_type = 4;
  function.data_type = 6;
  function.first = 10.0;
  function.step = 10.0;
  function.abscissa_quantity = 18;
  function.abscissa_unit = "Hz";
  function.ordinate_quantity = ordinate_quantity;
  function.id_lines[0] = "H";
  function.numbers = std::move(numbers);
  return function;
}

TEST_F(ResponseTable, TurnsVelocityAndAccelerationOfAUniversalFileIntoPosition) {
  // Of P = 1 / (m s^2), m = 2 kg: w^2 m x = -F, so that the acceleration per force is 1/2 at every frequency.
  const std::vector<double> acceleration{0.5, 0.0, 0.5, 0.0};
  std::vector<double> velocity;
  std::vector<double> position;
  for (const double w : {10.0 * turn, 20.0 * turn}) {
    velocity.insert(velocity.end(), {0.0, -0.5 / w});
    position.insert(position.end(), {-0.5 / (w * w), 0.0});
  }
  for (const auto& [quantity, numbers] : {std::pair{12, acceleration}, {11, velocity}, {8, position}}) {
    const auto response = read(uff_text(uff_response(quantity, numbers)));
    ASSERT_TRUE(response.has_value()) << response.error().str();
    for (std::size_t i = 0; i < 2; ++i) {
      const double w = response->points[i].frequency;
      EXPECT_NEAR(w, 10.0 * turn * static_cast<double>(i + 1), 1e-9);
      EXPECT_NEAR(std::abs(response->points[i].value * 2.0 * w * w + 1.0), 0.0, 1e-11) << quantity;
    }
    EXPECT_EQ(mentions(response->remarks, "to get a position"), quantity != 8);
    EXPECT_EQ(warnings_in(response->remarks), 0U);
  }
  const auto unknown = read(uff_text(uff_response(0, position)));
  ASSERT_TRUE(unknown.has_value());
  EXPECT_TRUE(mentions(unknown->remarks, "does not say what it measures"));
  EXPECT_EQ(warnings_in(unknown->remarks), 1U);
}

TEST_F(ResponseTable, ReadsTheCoherenceOfAUniversalFile) {
  UffFunction coherence = uff_response(0, {0.9, 0.8});
  coherence.function_type = 6;
  coherence.data_type = 2;
  coherence.id_lines[0] = "gamma2";
  ResponseTableOptions options;
  options.coherence = "gamma2";
  const std::string response_text = uff_text(uff_response(8, {1.0, 0.0, 0.5, 0.0}));
  const auto response = read(response_text + uff_text(coherence), options);
  ASSERT_TRUE(response.has_value()) << response.error().str();
  EXPECT_NEAR(response->points[0].coherence, 0.9, 1e-6);
  EXPECT_NEAR(response->points[1].coherence, 0.8, 1e-6);
  coherence.step = 5.0;
  const auto refused = read(response_text + uff_text(coherence), options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(data_of(refused.error()), "17:1: gamma2: axes_differ axis=frequencies other=the response");
}

TEST_F(ResponseTable, AsksForTheRecordWhereAUniversalFileHasSeveral) {
  UffFunction second = uff_response(8, {1.0, 0.0, 0.5, 0.0});
  second.id_lines[0] = "G";
  const std::string file = uff_text(uff_response(8, {2.0, 0.0, 0.25, 0.0})) + uff_text(second);
  EXPECT_EQ(data_of(read(file, {}).error()), "not_one_record records=2 choices=H [m], G [m]");
  ResponseTableOptions options;
  options.real = "G";
  const auto response = read(file, options);
  ASSERT_TRUE(response.has_value()) << response.error().str();
  EXPECT_EQ(response->points[0].value, std::complex(1.0, 0.0));
  EXPECT_EQ(data_of(read(file, in_columns("2", "3")).error()), "2: file_without_columns");
  UffFunction time;
  time.numbers = {1.0, 2.0};
  EXPECT_EQ(data_of(read(uff_text(time), {}).error()),
            "holds_none wanted=frequency response others=1+Z [m] (time response)");
}

class RecordedResponse : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings beside the project";
  }
  inline static const std::string folder = ZWIDTH_SHARED_DIR "/data/uff58/";
};

TEST_F(RecordedResponse, OfANonAsciiUniversalFile) {
  const auto response = read_response_table(folder + "non_ascii_header.uff", {});
  ASSERT_TRUE(response.has_value()) << response.error().str();
  ASSERT_EQ(response->points.size(), 5U);
  EXPECT_NEAR(response->points[0].frequency, 0.195313 * turn, 1e-12);
  EXPECT_EQ(response->points[0].value, std::complex(-0.0599924, -0.055326));
  EXPECT_EQ(response->points[4].value, std::complex(3.75037, 2.93363));
  EXPECT_TRUE(mentions(response->remarks, "(1/N)*(m/s²)"));
}

TEST_F(RecordedResponse, OfAListOfComplexNumbers) {
  ResponseTableOptions options;
  options.frequency_step = 0.5 * turn;
  const auto response = read_response_table(folder + "meas_point_1.txt", options);
  ASSERT_TRUE(response.has_value()) << response.error().str();
  ASSERT_EQ(response->points.size(), 1000U);  // of 1001; the first is at 0 Hz
  EXPECT_EQ(response->points[0].value, std::complex(-0.17515115491765987, -0.12042372070051006));
  EXPECT_NEAR(response->points[999].frequency, 500.0 * turn, 1e-9);
}

TEST_F(RecordedResponse, APowerSpectralDensityIsNone) {
  const auto response = read_response_table(folder + "sample_dataset58_psd.uff", {});
  ASSERT_FALSE(response.has_value());
  EXPECT_EQ(data_of(response.error()),
            "holds_none wanted=frequency response others=Power Spectral Density (PSD) (power spectral density)");
}

}  // namespace
}  // namespace zwidth
