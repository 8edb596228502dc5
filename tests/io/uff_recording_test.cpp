#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "io/problem_data.hpp"
#include "io/recording_folder.hpp"
#include "io/uff_number.hpp"
#include "io/uff_text.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Samples = std::vector<double>;

class UffRecording : public RecordingFolder {
 protected:
  [[nodiscard]] tl::expected<Recording, InputError> read(const std::string& bytes,
                                                         const RecordingOptions& options) const {
    return read_recording(write("a.uff", bytes), options);
  }
  [[nodiscard]] std::string refusal(const std::string& bytes, const RecordingOptions& options) const {
    const auto recording = read(bytes, options);
    return recording ? "read" : data_of(recording.error());
  }
};

UffFunction named(const std::string& name, Samples numbers) {
  UffFunction function;
  function.id_lines[0] = name;
  function.numbers = std::move(numbers);
  return function;
}

/// How a real time record is written, and how exactly it comes back.
struct Written {
  const char* name;
  int data_type;
  bool even;
  bool binary;
  UffOrder order;
  bool single_abscissa;
};

class UffWritten : public UffRecording, public testing::WithParamInterface<Written> {};

INSTANTIATE_TEST_SUITE_P(
    Ways, UffWritten,
    testing::Values(Written{"TextSingleEven", 2, true, false, UffOrder::little, false},
                    Written{"TextSingleUneven", 2, false, false, UffOrder::little, false},
                    Written{"TextDoubleEven", 4, true, false, UffOrder::little, false},
                    Written{"TextDoubleUneven", 4, false, false, UffOrder::little, false},
                    Written{"BinarySingleEven", 2, true, true, UffOrder::little, false},
                    Written{"BinarySingleUnevenBig", 2, false, true, UffOrder::big, false},
                    Written{"BinaryDoubleEvenBig", 4, true, true, UffOrder::big, false},
                    Written{"BinaryDoubleUneven", 4, false, true, UffOrder::little, false},
                    Written{"BinaryDoubleUnevenSingleAbscissa", 4, false, true, UffOrder::little, true},
                    Written{"BinaryDoubleUnevenSingleAbscissaBig", 4, false, true, UffOrder::big, true}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(UffWritten, ComesBack) {
  const Written& way = GetParam();
  UffFunction function;
  function.data_type = way.data_type;
  function.even = way.even;
  function.step = 0.001;
  Samples samples;
  for (int i = 0; i < 7; ++i) samples.push_back(std::ldexp(i % 2 == 0 ? -1.0 - i : 3.25 + i, i - 3));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!way.even) function.numbers.push_back(0.001 * static_cast<double>(i));
    function.numbers.push_back(samples[i]);
  }
  const auto recording = read(way.binary ? uff_binary(function, way.order, way.single_abscissa) : uff_text(function),
                              columns_named({"1"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 0.001, 1e-10);
  ASSERT_EQ(recording->channels[0].samples.size(), samples.size());
  // E13.5 has six digits, E20.12 thirteen; the samples are exact in single precision.
  const double relative = way.binary ? 0.0 : way.data_type == 2 ? 5e-6 : 5e-13;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_NEAR(recording->channels[0].samples[i], samples[i], relative * std::abs(samples[i])) << i;
  }
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
}

TEST_F(UffRecording, FindsRecordsByIdPointEntityAndNumber) {
  UffFunction force = named("Run 7", {1.0, 2.0});
  force.node = 4;
  force.direction = -1;
  UffFunction angle = named("Run 7", {3.0, 4.0});
  angle.entity = "HANDLE";
  angle.node = 12;
  angle.direction = 6;
  angle.id_lines[3] = "angle of handle";
  const std::string file = uff_text(force) + uff_text(angle, "\r\n");
  for (const char* name : {"12+RZ", "HANDLE", "handle", "angle of handle", "2"}) {
    const auto recording = read(file, columns_named({name}));
    ASSERT_TRUE(recording.has_value()) << name << ": " << recording.error().str();
    EXPECT_EQ(recording->channels[0].samples, (Samples{3.0, 4.0})) << name;
  }
  const auto both = read(file, columns_named({"2", "4-X"}));
  ASSERT_TRUE(both.has_value()) << both.error().str();
  EXPECT_EQ(both->channels[1].samples, (Samples{1.0, 2.0}));
  EXPECT_EQ(refusal(file, columns_named({"Run 7"})), "Run 7: column_name_not_unique records=2 numbers=1, 2");
  const auto unknown = read(file, columns_named({"HANDEL"}));
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().place.key, "HANDEL");
  EXPECT_NE(unknown.error().allowed.find("\"HANDLE\""), std::string::npos) << unknown.error().allowed;
}

TEST_F(UffRecording, TakesALineOfMinusOneInTheHeaderForText) {
  UffFunction function = named("    -1", {1.0, -1.0, 2.0});
  function.id_lines[4] = "-1";
  function.direction = -1;
  const auto recording = read(uff_text(function), columns_named({"1"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, -1.0, 2.0}));
}

TEST_F(UffRecording, PassesOverOtherDatasetsAndSaysSo) {
  const std::string units = "    -1\n   164\n         1  SI: Meter (newton)        2\n  1.0E+00  1.0E+00\n    -1\n";
  const auto recording = read(units + uff_text(named("x", {1.0, 2.0})), columns_named({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_TRUE(mentions(recording->remarks, "passed over: 164"));
  EXPECT_EQ(refusal(units, columns_named({"x"})), "holds_none wanted=function datasets=164");
}

TEST_F(UffRecording, TakesAHeaderWithShortLines) {
  const std::string text =
      "    -1\n    58\nx\n\n\n\n\n    1\n         2         3         1  0.00000E+00  2.00000E-03\n        17\n\n\n\n"
      "  1.00000E+00  2.00000E+00  3.00000E+00\n    -1\n";
  const auto recording = read(text, columns_named({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->sampling_period, 2e-3);
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 3.0}));
}

TEST_F(UffRecording, TakesAHeaderThatDoesNotKeepToItsColumns) {
  const std::string text =
      "    -1\n    58\nx\n\n\n\n\n1 0 0 0 NONE 1 1 NONE 0 0\n2 3 1 0.0 2e-3 0.0\n17\n\n\n\n1 2 3\n    -1\n";
  const auto recording = read(text, columns_named({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->sampling_period, 2e-3);
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 3.0}));
}

TEST_F(UffRecording, WarnsOfARecordThatIsCutShort) {
  std::string text = uff_text(named("x", {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
  text.erase(text.find("  5.0000"));
  const auto recording = read(text, columns_named({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 3.0, 4.0}));
  EXPECT_TRUE(mentions(recording->remarks, "has 4 of the 6 points"));
  EXPECT_TRUE(mentions(recording->remarks, "no closing line -1"));
  EXPECT_EQ(warnings_in(recording->remarks), 2U);
}

TEST_F(UffRecording, NamesTheLineAtWhichADatasetThatIsNotClosedBegins) {
  const std::string whole = uff_text(named("x", {1.0, 2.0}));
  const auto recording = read(whole + "    -1\n   151\none line\nanother\n", columns_named({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  const auto found = std::ranges::find_if(recording->remarks, [](const Remark& each) {
    return each.finding && each.finding->code == FindingCode::dataset_not_closed;
  });
  ASSERT_NE(found, recording->remarks.end());
  const auto lines = static_cast<double>(std::ranges::count(whole, '\n'));
  EXPECT_EQ(found->finding->evidence.front().value, lines + 2.0);
}

TEST_F(UffRecording, RefusesBinaryDataOfAnotherLength) {
  const std::string whole = uff_binary(named("x", {1.0, 2.0, 3.0}), UffOrder::little);
  EXPECT_EQ(refusal(whole.substr(0, whole.size() - 10), columns_named({"x"})),
            "13:1: bytes_missing points=3 bytes=24 left=21 declared=24");
  std::string longer = whole;
  longer.insert(longer.size() - 7, "x");
  EXPECT_EQ(refusal(longer, columns_named({"x"})), "13:1: closing_line_missing points=3 bytes=24 left=32 declared=24");
}

// Writers exist that state the bytes of one number per point whatever the record holds.
TEST_F(UffRecording, TrustsTheDataMoreThanTheStatedBytes) {
  UffFunction function = named("x", {0.0, 1.0, 1e-3, 2.0, 2e-3, 3.0});
  function.even = false;
  std::string bytes = uff_binary(function, UffOrder::big);
  bytes.replace(bytes.find("          48"), 12, "          24");
  const auto recording = read(bytes, columns_named({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 3.0}));
}

TEST_F(UffRecording, RefusesRecordsThatWereNotSampledTogether) {
  const UffFunction x = named("x", {1.0, 2.0, 3.0});
  UffFunction later = named("later", {1.0, 2.0, 3.0});
  later.first = 0.5;
  UffFunction slower = named("slower", {1.0, 2.0, 3.0});
  slower.step = 2e-3;
  const std::string file = uff_text(x) + uff_text(later) + uff_text(slower) + uff_text(named("short", {1.0, 2.0}));
  const auto other = [&](const std::string& name) { return refusal(file, columns_named({"x", name})); };
  EXPECT_NE(other("later").find("later [m]: axes_differ axis=times other=x [m]"), std::string::npos);
  EXPECT_NE(other("slower").find("slower [m]: axes_differ axis=times other=x [m]"), std::string::npos);
  EXPECT_NE(other("short").find("short [m]: samples_of_two_lengths samples=2 expected=3 other=x [m]"),
            std::string::npos);
}

TEST_F(UffRecording, RefusesWhatIsNoTimeRecord) {
  UffFunction response = named("H", {1.0, 0.5, 2.0, -0.5});
  response.function_type = 4;
  response.data_type = 5;
  response.abscissa_quantity = 18;
  response.abscissa_unit = "Hz";
  EXPECT_EQ(refusal(uff_text(response), columns_named({"H"})),
            "2:1: H: wrong_kind kind=a complex frequency response, 2 points, every 0.001 Hz wanted=times");
}

TEST_F(UffRecording, WarnsWhereTheGivenRateIsNotTheFiles) {
  const std::string file = uff_text(named("x", {1.0, 2.0, 3.0}));
  RecordingOptions options = columns_named({"x"});
  options.rate = 1000.0;
  EXPECT_EQ(warnings_in(read(file, options)->remarks), 0U);
  options.rate = 2000.0;
  const auto recording = read(file, options);
  EXPECT_EQ(recording->sampling_period, 1.0 / 2000.0);
  EXPECT_TRUE(mentions(recording->remarks, "given as 2000 Hz; the file states 1000 Hz"));
  UffFunction in_milliseconds = named("x", {1.0, 2.0, 3.0});
  in_milliseconds.step = 2.0;
  in_milliseconds.abscissa_unit = "ms";
  EXPECT_NEAR(read(uff_text(in_milliseconds), columns_named({"x"}))->sampling_period, 2e-3, 1e-15);
}

TEST_F(UffRecording, NamesTheLineOfWhatIsWrong) {
  std::string text = uff_text(named("x", {1.0, 2.0, 3.0, 4.0, 5.0}));
  std::string damaged = text;
  damaged.replace(damaged.find("5.000000000000E+00"), 18, "five");
  EXPECT_EQ(refusal(damaged, columns_named({"x"})), "15:3: text_not_readable text=\"five\" wanted=number");
  EXPECT_EQ(refusal("    -1\n    58\nx\ny\n", columns_named({"x"})),
            "4:1: data_end_inside lines=11 part=a function's header");
  std::string form = text;
  form.replace(form.find("         4         5         1"), 30, "         3         5         1");
  EXPECT_EQ(refusal(form, columns_named({"x"})).find("9:1: text_not_readable text=\"3     "), 0U);
  EXPECT_TRUE(refusal(form, columns_named({"x"})).ends_with(" wanted=form"));
  std::string step = text;
  step.replace(step.find("1.00000E-03"), 11, "0.00000E+00");
  EXPECT_EQ(refusal(step, columns_named({"x"})), "9:1: wrong_field value=0 first=0 field=step");
  std::string more = text;
  more.insert(more.rfind("    -1"), " 1 2 3 4 5 6 7\n");
  EXPECT_EQ(refusal(more, columns_named({"x"})), "14:1: size_disagrees count=12 points=5 expected=5 unit=numbers");
  std::string binary = uff_binary(named("x", {1.0, 2.0}), UffOrder::little);
  binary.replace(binary.find("58b     1     2"), 15, "58b     1     1");
  EXPECT_EQ(refusal(binary, columns_named({"x"})), "2:1: wrong_field value=1 field=number format");
}

TEST_F(UffRecording, NeverCrashesOnAFileThatIsCutOff) {
  UffFunction complex = named("H", {0.0, 1.0, 0.5, 1.0, 2.0, -0.5});
  complex.data_type = 6;
  complex.even = false;
  const std::string whole = uff_text(named("x", {1.0, 2.0, 3.0})) + uff_binary(complex, UffOrder::little, true);
  RecordingOptions options = columns_named({"1"});
  options.format = RecordingFormat::uff;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto recording = read(whole.substr(0, size), options);
    if (recording) {
      EXPECT_LE(recording->channels[0].samples.size(), 3U);
    } else {
      EXPECT_FALSE(recording.error().what.empty());
    }
  }
}

TEST(FortranNumbers, AreReadAsFortranWritesThem) {
  const auto numbers = [](std::string_view text) {
    Samples taken;
    while (const auto number = take_fortran_number(text)) taken.push_back(*number);
    EXPECT_EQ(text, "");
    return taken;
  };
  EXPECT_EQ(numbers(" 1.5E+00-2.5E-01 3.0e1"), (Samples{1.5, -0.25, 30.0}));
  EXPECT_EQ(numbers("-1.00000E-100-1.00000E+02"), (Samples{-1e-100, -100.0}));
  EXPECT_EQ(numbers("1.5-100 2.5+010"), (Samples{1.5e-100, 2.5e10}));
  EXPECT_EQ(numbers("1.5D+02 -.5d0 +3. 7"), (Samples{150.0, -0.5, 3.0, 7.0}));
  EXPECT_EQ(numbers("1.5-2.5"), (Samples{1.5, -2.5}));
  const Samples missing = numbers("NaN ******* -Inf");
  ASSERT_EQ(missing.size(), 3U);
  for (const double value : missing) EXPECT_FALSE(std::isfinite(value));
  for (std::string_view wrong : {"five", "-", ".", "e5", "1e400"}) {
    std::string_view rest = wrong;
    EXPECT_FALSE(take_fortran_number(rest).has_value()) << wrong;
    EXPECT_EQ(rest, wrong);
  }
}

// Files of other programs, beside the project. The numbers were taken from the files by splitting their lines and
// unpacking their bytes in Python.
class RecordedUff : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings beside the project";
  }
  [[nodiscard]] static Channel first(const std::string& name, double period) {
    const auto recording = read_recording(folder + name, columns_named({"1"}));
    EXPECT_TRUE(recording.has_value()) << recording.error().str();
    if (!recording) return {};
    EXPECT_EQ(recording->sampling_period, period);
    return recording->channels.front();
  }
  [[nodiscard]] static std::string refusal(const std::string& name) {
    const auto recording = read_recording(folder + name, columns_named({"1"}));
    return recording || !recording.error().problem ? "no data" : data_of(*recording.error().problem);
  }
  inline static const std::string folder = ZWIDTH_SHARED_DIR "/data/uff58/";
};

TEST_F(RecordedUff, TextAndBinaryOfOneRecordAgree) {
  const Channel text = first("Sample_UFF58_ascii.uff", 1.52588e-05);
  const Channel binary = first("Sample_UFF58b_bin.uff", 1.52588e-05);
  EXPECT_EQ(text.name, "Mic 01.0Scalar [Pa]");
  ASSERT_EQ(text.samples.size(), 79292U);
  ASSERT_EQ(binary.samples.size(), 79292U);
  EXPECT_EQ(text.samples[0], -0.0147553);
  EXPECT_EQ(text.samples[40000], 0.0177452);
  EXPECT_EQ(text.samples.back(), -0.00431469);
  EXPECT_EQ(binary.samples[0], -0.014755260199308395);
  EXPECT_EQ(binary.samples[40000], 0.017745165154337883);
  EXPECT_EQ(binary.samples.back(), -0.004314688965678215);
  for (std::size_t i = 0; i < text.samples.size(); ++i) {
    ASSERT_NEAR(text.samples[i], binary.samples[i], 5.1e-6 * std::abs(binary.samples[i]) + 1e-12) << i;  // six digits
  }
}

TEST_F(RecordedUff, DoublesInBinary) {
  const Channel sine = first("binary8byte.uff", 0.01);
  EXPECT_EQ(sine.name, "sine 5 Hz [g]");
  ASSERT_EQ(sine.samples.size(), 250U);
  EXPECT_EQ(sine.samples[1], 0.30901697278022766);
  EXPECT_EQ(sine.samples.back(), 0.3090193569660187);
  for (std::size_t i = 0; i < sine.samples.size(); ++i) {  // a sine of single precision and a drifting phase
    EXPECT_NEAR(sine.samples[i], std::sin(2.0 * M_PI * 5.0 * 0.01 * static_cast<double>(i)), 1e-5);
  }
}

TEST_F(RecordedUff, HeadersThatAreNotAsWide) {
  const Channel short_header = first("time-history-not-all-columns-filled.uff", 5e-5);
  ASSERT_EQ(short_header.samples.size(), 13U);
  EXPECT_EQ(short_header.samples.front(), -3.81956);
  EXPECT_EQ(short_header.samples.back(), -5.84096);
  EXPECT_EQ(short_header.name, "1x : m/s²");
}

TEST_F(RecordedUff, ARecordOfFewerPointsThanItSaysIsReadWithAWarning) {
  const auto recording = read_recording(folder + "dataset_milestone_in_header.uff", columns_named({"1"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  ASSERT_EQ(recording->channels[0].samples.size(), 42U);
  EXPECT_EQ(recording->channels[0].samples.front(), -6.73633e-3);
  EXPECT_EQ(recording->channels[0].samples.back(), 5.39653e-3);
  EXPECT_TRUE(mentions(recording->remarks, "has 42 of the 2508876 points"));
}

TEST_F(RecordedUff, SpectraAreRefusedAsTimeRecords) {
  EXPECT_EQ(refusal("sample_dataset58_psd.uff"),
            "wrong_kind kind=a complex power spectral density, 3201 points, unevenly spaced wanted=times");
  EXPECT_EQ(refusal("non_ascii_header.uff"),
            "wrong_kind kind=a complex frequency response, 6 points, every 0.195313 Hz wanted=times");
}

// A line of complex numbers is no time record; read_response_table() takes it.
TEST_F(RecordedUff, EveryFileIsReadOrRefusedWithAReason) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto contents = list_recording(entry.path().string());
    const auto recording = read_recording(entry.path().string(), at_1_khz({"1"}));
    const bool is_uff = entry.path().extension() == ".uff";
    EXPECT_EQ(contents.has_value(), is_uff || entry.path().extension() == ".txt") << entry.path();
    if (is_uff) {
      EXPECT_EQ(contents->format, RecordingFormat::uff) << entry.path();
    }
    if (!recording) {
      EXPECT_FALSE(recording.error().what.empty() || recording.error().allowed.empty()) << entry.path();
    }
  }
}

}  // namespace
}  // namespace zwidth
