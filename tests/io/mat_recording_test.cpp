#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "io/mat_writer.hpp"
#include "io/problem_data.hpp"
#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

struct Version {
  const char* name;
  mat_ft version;
  matio_compression compression;
};

/// What holds of every kind of file: version 5, compressed or not, and 7.3.
class MatRecording : public RecordingFolder, public testing::WithParamInterface<Version> {
 protected:
  [[nodiscard]] std::string file() const { return path("run.mat"); }
  template <class... Variables>
  void write_mat(Variables... variables) const {
    MatWriter writer(file(), GetParam().version);
    (writer.add(std::move(variables), GetParam().compression), ...);
  }
  [[nodiscard]] std::string refusal(const RecordingOptions& options) const {
    const auto recording = read_recording(file(), options);
    return recording ? "read" : data_of(recording.error());
  }
  [[nodiscard]] Samples samples(const std::string& name) const {
    const auto recording = read_recording(file(), at_1_khz({name}));
    EXPECT_TRUE(recording.has_value()) << recording.error().str();
    return recording ? recording->channels.front().samples : Samples{};
  }
};

INSTANTIATE_TEST_SUITE_P(Versions, MatRecording,
                         testing::Values(Version{"V5", MAT_FT_MAT5, MAT_COMPRESSION_NONE},
                                         Version{"V5Compressed", MAT_FT_MAT5, MAT_COMPRESSION_ZLIB},
                                         Version{"V73", MAT_FT_MAT73, MAT_COMPRESSION_NONE},
                                         Version{"V73Compressed", MAT_FT_MAT73, MAT_COMPRESSION_ZLIB}),
                         [](const auto& written) { return std::string(written.param.name); });

TEST_P(MatRecording, ReadsNumbersOfEveryClass) {
  using W = MatWriter;
  write_mat(W::array<double>("f64", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, 1, {1.5, -9.87654321e99}),
            W::array<float>("f32", MAT_C_SINGLE, MAT_T_SINGLE, 2, 1, {0.25F, -3.5F}),
            W::array<std::int8_t>("i8", MAT_C_INT8, MAT_T_INT8, 2, 1, {-128, 127}),
            W::array<std::uint8_t>("u8", MAT_C_UINT8, MAT_T_UINT8, 2, 1, {0, 255}),
            W::array<std::int16_t>("i16", MAT_C_INT16, MAT_T_INT16, 2, 1, {-32768, 32767}),
            W::array<std::uint16_t>("u16", MAT_C_UINT16, MAT_T_UINT16, 2, 1, {1, 65535}),
            W::array<std::int32_t>("i32", MAT_C_INT32, MAT_T_INT32, 2, 1, {-2147483647, 2147483647}),
            W::array<std::uint32_t>("u32", MAT_C_UINT32, MAT_T_UINT32, 2, 1, {7, 4294967295U}),
            W::array<std::int64_t>("i64", MAT_C_INT64, MAT_T_INT64, 2, 1, {-(1LL << 53), 1LL << 53}),
            W::array<std::uint64_t>("u64", MAT_C_UINT64, MAT_T_UINT64, 2, 1, {3, 1ULL << 52}),
            W::array<std::uint8_t>("flag", MAT_C_UINT8, MAT_T_UINT8, 2, 1, {0, 1}, MAT_F_LOGICAL));
  EXPECT_EQ(samples("f64"), (Samples{1.5, -9.87654321e99}));
  EXPECT_EQ(samples("f32"), (Samples{0.25, -3.5}));
  EXPECT_EQ(samples("i8"), (Samples{-128.0, 127.0}));
  EXPECT_EQ(samples("u8"), (Samples{0.0, 255.0}));
  EXPECT_EQ(samples("i16"), (Samples{-32768.0, 32767.0}));
  EXPECT_EQ(samples("u16"), (Samples{1.0, 65535.0}));
  EXPECT_EQ(samples("i32"), (Samples{-2147483647.0, 2147483647.0}));
  EXPECT_EQ(samples("u32"), (Samples{7.0, 4294967295.0}));
  EXPECT_EQ(samples("i64"), (Samples{-9007199254740992.0, 9007199254740992.0}));
  EXPECT_EQ(samples("u64"), (Samples{3.0, 4503599627370496.0}));
  EXPECT_EQ(samples("flag"), (Samples{0.0, 1.0}));
}

TEST_P(MatRecording, ReadsRowsLikeColumnsAndScales) {
  write_mat(MatWriter::array<double>("row", MAT_C_DOUBLE, MAT_T_DOUBLE, 1, 3, {1.0, 2.0, 4.0}),
            MatWriter::column("column", {8.0, 16.0, 32.0}));
  RecordingOptions options = at_1_khz({"column", "row"});
  options.columns[1].scale = -0.5;
  const auto recording = read_recording(file(), options);
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{8.0, 16.0, 32.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{-0.5, -1.0, -2.0}));
  EXPECT_EQ(recording->sampling_period, 1e-3);
}

TEST_P(MatRecording, ReadsAMatrixColumnByColumn) {
  write_mat(MatWriter::array<double>("data", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, 3, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
  EXPECT_EQ(samples("data.1"), (Samples{1.0, 2.0}));
  EXPECT_EQ(samples("data.3"), (Samples{5.0, 6.0}));
  EXPECT_EQ(refusal(at_1_khz({"data"})),
            "data: wrong_kind columns=3 kind=a matrix wanted=column choices=data.1 to data.3");
}

TEST_P(MatRecording, ReadsFieldsOfStructs) {
  std::vector<MatWriter::Variable> inner;
  inner.push_back(MatWriter::column("x", {1.0, 2.0, 3.0}));
  std::vector<std::vector<MatWriter::Variable>> inner_elements;
  inner_elements.push_back(std::move(inner));
  std::vector<MatWriter::Variable> outer;
  outer.push_back(MatWriter::column("force", {5.0, 6.0, 7.0}));
  outer.push_back(MatWriter::structure("deep", {"x"}, std::move(inner_elements)));
  std::vector<std::vector<MatWriter::Variable>> elements;
  elements.push_back(std::move(outer));
  write_mat(MatWriter::structure("run", {"force", "deep"}, std::move(elements)));
  EXPECT_EQ(samples("run.force"), (Samples{5.0, 6.0, 7.0}));
  EXPECT_EQ(samples("run.deep.x"), (Samples{1.0, 2.0, 3.0}));
  const std::string refused = refusal(at_1_khz({"run"}));  // version 7.3 lists by name
  const std::string structure = "run: wrong_kind kind=a struct wanted=field choices=";
  EXPECT_TRUE(refused == structure + "run.force, run.deep.x" || refused == structure + "run.deep.x, run.force")
      << refused;
}

TEST_P(MatRecording, ReadsElementsOfStructArrays) {
  std::vector<std::vector<MatWriter::Variable>> elements(2);
  elements[0].push_back(MatWriter::column("x", {1.0, 2.0}));
  elements[0].push_back(MatWriter::column("F", {3.0, 4.0}));
  elements[1].push_back(MatWriter::column("x", {5.0, 6.0, 7.0}));
  elements[1].push_back(MatWriter::column("F", {8.0, 9.0, 10.0}));
  write_mat(MatWriter::structure("run", {"x", "F"}, std::move(elements)));
  EXPECT_EQ(samples("run(1).x"), (Samples{1.0, 2.0}));
  EXPECT_EQ(samples("run(1).F"), (Samples{3.0, 4.0}));
  EXPECT_EQ(samples("run(2).x"), (Samples{5.0, 6.0, 7.0}));
  EXPECT_EQ(samples("run(2).F"), (Samples{8.0, 9.0, 10.0}));
}

TEST_P(MatRecording, SkipsWhatIsNoSignalAndSaysSo) {
  std::vector<MatWriter::Variable> in_cell;
  in_cell.push_back(MatWriter::column("", {1.0, 2.0}));
  write_mat(MatWriter::text("note", "locked"), MatWriter::cell("parts", std::move(in_cell)),
            MatWriter::complex("H", {1.0, 2.0}, {0.5, -0.5}), MatWriter::column("force", {5.0, 6.0}));
  const auto recording = read_recording(file(), at_1_khz({"force"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{5.0, 6.0}));
  EXPECT_TRUE(mentions(recording->remarks, "note (is text)"));
  EXPECT_TRUE(mentions(recording->remarks, "parts (is a cell array)"));
  EXPECT_TRUE(mentions(recording->remarks, "complex arrays are skipped: H"));
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
  EXPECT_EQ(refusal(at_1_khz({"H"})), "H: wrong_kind kind=complex wanted=array");
  EXPECT_EQ(refusal(at_1_khz({"note"})), "note: wrong_kind kind=text wanted=array");
  EXPECT_EQ(refusal(at_1_khz({"parts"})), "parts: wrong_kind kind=a cell array wanted=array");
}

TEST_P(MatRecording, NamesTheRateButDoesNotUseItUnasked) {
  write_mat(MatWriter::column("fs", {2500.0}), MatWriter::column("force", {5.0, 6.0}),
            MatWriter::column("gain", {2.0}));
  EXPECT_EQ(refusal(columns_named({"force"})), "no_times samples=2 rates=fs = 2500");
  EXPECT_EQ(refusal(at_1_khz({"fs"})), "fs: wrong_kind kind=a single number wanted=signal");
}

TEST_P(MatRecording, FindsTheTimesBesideTheSignal) {
  std::vector<std::vector<MatWriter::Variable>> elements(1);
  elements[0].push_back(MatWriter::column("t", {0.0, 0.002, 0.004}));
  elements[0].push_back(MatWriter::column("x", {1.0, 2.0, 3.0}));
  write_mat(MatWriter::column("time", {0.0, 0.5, 1.0}), MatWriter::structure("run", {"t", "x"}, std::move(elements)),
            MatWriter::column("t_short", {0.0, 1.0}), MatWriter::column("ms", {0.0, 4.0, 8.0}));
  const auto beside = read_recording(file(), columns_named({"run.x"}));
  ASSERT_TRUE(beside.has_value()) << beside.error().str();
  EXPECT_NEAR(beside->sampling_period, 0.002, 1e-15);
  RecordingOptions options = columns_named({"run.x"});
  options.time_column = "ms";
  options.time_scale = 1e-3;
  const auto asked = read_recording(file(), options);
  ASSERT_TRUE(asked.has_value()) << asked.error().str();
  EXPECT_NEAR(asked->sampling_period, 0.004, 1e-15);
  options.time_column = "t_short";
  EXPECT_EQ(refusal(options), "t_short: samples_of_two_lengths samples=2 expected=3 other=run.x");
}

TEST_P(MatRecording, RefusesSignalsOfDifferentLength) {
  write_mat(MatWriter::column("force", {1.0, 2.0, 3.0}), MatWriter::column("x", {1.0, 2.0}));
  EXPECT_EQ(refusal(at_1_khz({"force", "x"})), "x: samples_of_two_lengths samples=2 expected=3 other=force");
}

TEST_P(MatRecording, FillsAFewMissingSamplesAndRefusesMany) {
  Samples few(200, 1.0);
  few[57] = std::nan("");
  Samples many(200, 1.0);
  for (std::size_t i = 90; i < 100; ++i) many[i] = std::numeric_limits<double>::infinity();
  write_mat(MatWriter::column("few", few), MatWriter::column("many", many));
  const auto recording = read_recording(file(), at_1_khz({"few"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, Samples(200, 1.0));
  EXPECT_TRUE(mentions(recording->remarks, "1 of 200 samples are missing"));
  const auto gap = read_recording(file(), at_1_khz({"many"}));
  ASSERT_FALSE(gap.has_value());
  EXPECT_EQ(gap.error().place.key, "many");
  EXPECT_NE(gap.error().str().find("sample 91"), std::string::npos) << gap.error().str();
}

TEST_P(MatRecording, ListsWhatTheFileHas) {
  write_mat(MatWriter::column("force", {1.0, 2.0, 3.0}),
            MatWriter::array<float>("data", MAT_C_SINGLE, MAT_T_SINGLE, 2, 2, {1.0F, 2.0F, 3.0F, 4.0F}),
            MatWriter::column("fs", {2500.0}));
  const auto contents = list_recording(file());
  ASSERT_TRUE(contents.has_value()) << contents.error().str();
  EXPECT_EQ(contents->format, RecordingFormat::mat);
  std::vector<std::string> listed;
  for (const RecordingColumn& column : contents->columns) {
    listed.push_back(column.name + " " + std::to_string(column.size) + " " + column.detail);
  }
  std::sort(listed.begin(), listed.end());  // version 7.3 lists by name
  EXPECT_EQ(listed, (std::vector<std::string>{"data.1 2 single 2x2", "data.2 2 single 2x2", "force 3 double 3x1"}));
  EXPECT_TRUE(mentions(contents->remarks, "single numbers: fs = 2500"));
  const auto unknown = read_recording(file(), at_1_khz({"forse"}));
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().place.key, "forse");
  for (const char* named : {"\"force\"", "3 columns", "force (double 3x1)"}) {
    EXPECT_NE(unknown.error().allowed.find(named), std::string::npos) << unknown.error().str();
  }
}

TEST_P(MatRecording, RefusesAFileWithoutSignals) {
  write_mat(MatWriter::text("note", "locked"), MatWriter::column("fs", {2500.0}));
  EXPECT_EQ(refusal(at_1_khz({"x"})), "holds_none wanted=signals others=note (is text), fs (is a single number)");
}

TEST_F(RecordingFolder, RefusesMatVersion4Clearly) {
  {
    MatWriter writer(path("old.mat"), MAT_FT_MAT4);
    writer.add("force", {1.0, 2.0, 3.0});
  }
  const auto recording = read_recording(path("old.mat"), at_1_khz({"force"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(data_of(recording.error()), "unknown_version");
}

// The bench recording, read here and by SciPy 1.10 (scipy.io.loadmat), sums by NumPy in double precision.
TEST(RecordedMat, MotorBenchAsSciPyReadsIt) {
  const std::string file = ZWIDTH_SHARED_DIR "/data/two_mass_bench/MultisineTypeA.mat";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings beside the project";
  RecordingOptions options = columns_named({"iq_refx", "theta_mx", "theta_my", "msr"});
  options.rate = 2500.0;
  const auto recording = read_recording(file, options);
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  const auto value = [&](std::size_t channel, std::size_t i) { return recording->channels[channel].samples.at(i); };
  for (const Channel& channel : recording->channels) ASSERT_EQ(channel.samples.size(), 50000U);
  EXPECT_EQ(value(0, 0), 12.97525);
  EXPECT_EQ(value(0, 12345), -3.878988);
  EXPECT_EQ(value(1, 0), -7.456285);
  EXPECT_EQ(value(1, 49999), -7.500621);
  EXPECT_EQ(value(2, 12345), 0.5643911);
  EXPECT_EQ(value(3, 12345), 12347.0);  // 16-bit numbers in the file
  double sum = 0.0;
  for (const double x : recording->channels[1].samples) sum += x;
  EXPECT_NEAR(sum, -371289.815151, 1e-6);
  EXPECT_TRUE(mentions(recording->remarks, "MATLAB objects are skipped"));
  EXPECT_TRUE(mentions(recording->remarks, "ms.Hampl"));
}

TEST(RecordedMat, EmpsAsSciPyReadsIt) {
  const std::string file = ZWIDTH_SHARED_DIR "/data/emps/DATA_EMPS.mat";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings beside the project";
  const auto recording = read_recording(file, columns_named({"vir", "qm"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-15);
  ASSERT_EQ(recording->channels[0].samples.size(), 24841U);
  EXPECT_EQ(recording->channels[0].samples[12345], -0.9811446921112142);
  EXPECT_EQ(recording->channels[1].samples[12345], 0.0042463);
  EXPECT_EQ(recording->channels[1].samples.back(), 0.00361505);
}

TEST(RecordedMat, MatlabObjectsOnlyAreRefused) {
  const std::string file = ZWIDTH_SHARED_DIR "/data/two_mass_bench/opaque_objects_only.mat";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings beside the project";
  const auto recording = read_recording(file, at_1_khz({"x"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(data_of(recording.error()), "holds_none wanted=signals objects=mdl.Pv, mdl.Pp, frf.Pv, frf.Pp");
}

}  // namespace
}  // namespace zwidth
