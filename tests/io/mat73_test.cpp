// What MATLAB writes into files of version 7.3 and matio does not, and what is damaged.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/mat_writer.hpp"
#include "io/problem_data.hpp"
#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

/// Adds to an HDF5 file by HDF5's own functions.
class Hdf5Editor {
 public:
  explicit Hdf5Editor(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {}
  ~Hdf5Editor() { H5Fclose(file_); }
  Hdf5Editor(const Hdf5Editor&) = delete;
  Hdf5Editor& operator=(const Hdf5Editor&) = delete;

  /// A dataset of 32-bit numbers with the class that MATLAB would write.
  void add(const std::string& name, const std::string& matlab_class, std::vector<std::uint32_t> numbers,
           bool is_object) const {
    const hsize_t size = numbers.size();
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t dataset = H5Dcreate2(file_, name.c_str(), H5T_STD_U32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    const hid_t scalar = H5Screate(H5S_SCALAR);
    if (!matlab_class.empty()) {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, matlab_class.size());
      const hid_t attribute = H5Acreate2(dataset, "MATLAB_class", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
      H5Awrite(attribute, text, matlab_class.data());
      H5Aclose(attribute);
      H5Tclose(text);
    }
    if (is_object) {
      const hid_t attribute =
          H5Acreate2(dataset, "MATLAB_object_decode", H5T_STD_I32LE, scalar, H5P_DEFAULT, H5P_DEFAULT);
      const int decode = 3;
      H5Awrite(attribute, H5T_NATIVE_INT, &decode);
      H5Aclose(attribute);
    }
    H5Sclose(scalar);
    H5Dclose(dataset);
    H5Sclose(space);
  }
  /// A dataset that claims many numbers and stores none.
  void claim(const std::string& name, hsize_t count) const {
    const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 1024;
    H5Pset_chunk(list, 1, &chunk);
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    H5Dclose(H5Dcreate2(file_, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, list, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(list);
  }
  void link_group_to_itself(const std::string& name) const {
    const hid_t group = H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_hard(file_, name.c_str(), group, "again", H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(group);
  }
  void link_elsewhere(const std::string& name, const std::string& other) const {
    H5Lcreate_external(other.c_str(), "/x", file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
  void keep_elsewhere(const std::string& name, const std::string& other) const {
    const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(list, other.c_str(), 0, 2 * sizeof(double));
    const hsize_t size = 2;
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    H5Dclose(H5Dcreate2(file_, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, list, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(list);
  }

 private:
  hid_t file_;
};

class Mat73 : public RecordingFolder {
 protected:
  [[nodiscard]] std::string file_with_x() const {
    MatWriter writer(path("a.mat"), MAT_FT_MAT73);
    writer.add("x", {1.0, 2.0, 4.0});
    return path("a.mat");
  }
};

TEST_F(Mat73, SkipsObjectsAndReadsTheRest) {
  const std::string file = file_with_x();
  {
    const Hdf5Editor editor(file);
    editor.add("T", "table", {0xDD000000U, 2, 1, 1, 1, 1}, true);
    editor.add("when", "datetime", {0xDD000000U, 2, 1, 1, 2, 2}, true);
    editor.add("counts", "uint32", {7, 8}, false);
    editor.add("foreign", "", {9, 10}, false);
  }
  const auto recording = read_recording(file, at_1_khz({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 4.0}));
  EXPECT_TRUE(mentions(recording->remarks, "MATLAB objects are skipped: T, when"));
  const auto others = read_recording(file, at_1_khz({"counts", "foreign"}));
  ASSERT_TRUE(others.has_value()) << others.error().str();
  EXPECT_EQ(others->channels[0].samples, (Samples{7.0, 8.0}));
  EXPECT_EQ(others->channels[1].samples, (Samples{9.0, 10.0}));
}

TEST_F(Mat73, ReadsNoMoreThanTheFileHolds) {
  const std::string file = file_with_x();
  Hdf5Editor(file).claim("huge", hsize_t{1} << 60);
  Hdf5Editor(file).claim("large", hsize_t{1} << 25);
  const auto recording = read_recording(file, at_1_khz({"huge"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(data_of(recording.error()), "huge: has_too_many most=1.34218e+08 what=values");
  const auto large = read_recording(file, at_1_khz({"large"}));
  ASSERT_FALSE(large.has_value());
  EXPECT_EQ(data_of(large.error()), "large: bytes_missing bytes=2.68435e+08 left=0");
}

TEST_F(Mat73, FollowsNoCircleAndNoOtherFile) {
  const std::string file = file_with_x();
  const std::string secret = write("secret", std::string(16, 'x'));
  {
    const Hdf5Editor editor(file);
    editor.link_group_to_itself("loop");
    editor.link_elsewhere("away", path("a.mat"));
    editor.keep_elsewhere("outside", secret);
  }
  const auto recording = read_recording(file, at_1_khz({"x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  for (const char* name : {"away", "outside"}) {
    const auto other = read_recording(file, at_1_khz({name}));
    ASSERT_FALSE(other.has_value());
    EXPECT_EQ(data_of(other.error()), std::string(name) + ": lies_elsewhere");
  }
  std::string innermost = "loop";
  for (int i = 0; i < 33; ++i) innermost += ".again";
  const auto circle = read_recording(file, at_1_khz({innermost}));
  ASSERT_FALSE(circle.has_value());
  ASSERT_TRUE(circle.error().problem.has_value());
  EXPECT_EQ(data_of(*circle.error().problem), "nested_too_deep most=32");
}

TEST_F(Mat73, PrintsNothingOfItsOwnOnDamage) {
  const std::string file = file_with_x();
  const auto size = std::filesystem::file_size(file);
  testing::internal::CaptureStderr();
  for (std::uintmax_t left = size - 1; left > 512; left = left * 3 / 4) {
    std::filesystem::resize_file(file, left);
    const auto recording = read_recording(file, at_1_khz({"x"}));
    if (recording) {
      EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 4.0}));
    } else {
      EXPECT_FALSE(recording.error().what.empty());
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace zwidth
