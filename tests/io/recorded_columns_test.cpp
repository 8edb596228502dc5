#include "zwidth/io/recorded_columns.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "io/recording_folder.hpp"

namespace zwidth {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

RecordedColumns two_columns() { return {"bench", {{"f", {1.0, 2.0, 3.0}}, {"x", {4.0, 5.0, 6.0}}}, 1e-3}; }

std::string refusal(const RecordedColumns& recorded, const RecordingOptions& options) {
  const auto recording = read_recording(recorded, options);
  return recording ? "read" : data_of(recording.error());
}

class RecordedColumnsAndFile : public RecordingFolder {};

TEST(RecordedColumns, AreScaledAndInTheOrderAskedFor) {
  RecordingOptions options = columns_named({"x", "f"});
  options.columns[0].scale = 1e-3;
  const auto recording = read_recording(two_columns(), options);
  ASSERT_TRUE(recording.has_value());
  EXPECT_EQ(recording->channels[0].samples, (std::vector<double>{4.0 * 1e-3, 5.0 * 1e-3, 6.0 * 1e-3}));
  EXPECT_EQ(recording->channels[1].samples, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(recording->sampling_period, 1e-3);
  EXPECT_EQ(recording->source, "bench");
}

TEST(RecordedColumns, ARateOverridesThePeriodAndATimeColumnIsFound) {
  RecordingOptions options = columns_named({"f"});
  options.rate = 500.0;
  EXPECT_EQ(read_recording(two_columns(), options)->sampling_period, 2e-3);
  const RecordedColumns timed{"bench", {{"time [ms]", {0.0, 4.0, 8.0}}, {"f", {1.0, 2.0, 3.0}}}, {}};
  EXPECT_DOUBLE_EQ(read_recording(timed, columns_named({"f"}))->sampling_period, 4e-3);
}

TEST(RecordedColumns, RefusesWhatIsNoRecording) {
  const RecordingOptions options = columns_named({"f"});
  RecordedColumns recorded = two_columns();
  EXPECT_EQ(refusal(recorded, columns_named({"g"})), "g: no_such_column columns=2 names=f, x");
  EXPECT_EQ(read_recording(recorded, columns_named({"g"})).error().place.file, "bench");
  recorded.sampling_period = missing;
  EXPECT_EQ(refusal(recorded, options), "sampling_period: not_finite_and_positive value=nan in=s unit=s");
  EXPECT_EQ(data_of(*find_problem(recorded)), "sampling_period: not_finite_and_positive value=nan in=s unit=s");
  recorded.sampling_period.reset();
  EXPECT_FALSE(find_problem(recorded));
  EXPECT_EQ(refusal(recorded, options), "no_times");
  recorded = two_columns();
  recorded.columns[1].samples.pop_back();
  EXPECT_EQ(refusal(recorded, options), "x: samples_of_two_lengths samples=2 expected=3 other=f");
  recorded.columns = {{"f", {}}};
  EXPECT_EQ(refusal(recorded, options), "f: too_few_samples samples=0");
  recorded.columns = {{"f", {1.0, missing, 3.0}}};
  EXPECT_EQ(refusal(recorded, options), "f: too_many_samples_missing missing=1 samples=3 sample=2");
}

TEST_F(RecordedColumnsAndFile, SayTheSame) {
  std::string text = "t,f\n";
  RecordedColumns recorded{"run.csv", {{"t", {}}, {"f", {}}}, {}};
  for (int i = 0; i < 300; ++i) {
    const double time = i * 0.0078125;
    const bool is_missing = i == 17;
    text += std::to_string(time) + "," + (is_missing ? "nan" : std::to_string(i % 7)) + "\n";
    recorded.columns[0].samples.push_back(std::stod(std::to_string(time)));
    recorded.columns[1].samples.push_back(is_missing ? missing : i % 7);
  }
  const auto from_file = read_recording(write("run.csv", text), columns_named({"f"}));
  const auto from_memory = read_recording(recorded, columns_named({"f"}));
  ASSERT_TRUE(from_file && from_memory);
  EXPECT_EQ(from_file->channels[0].samples, from_memory->channels[0].samples);
  EXPECT_EQ(from_file->sampling_period, from_memory->sampling_period);
}

}  // namespace
}  // namespace zwidth
