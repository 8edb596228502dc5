// MAT files of version 5 byte by byte: what MATLAB writes and matio does not, and what is damaged.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "io/inflate.hpp"
#include "io/problem_data.hpp"
#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Samples = std::vector<double>;
enum class Order { little, big };

/// Writes the elements of a file in one byte order.
class Mat5Writer {
 public:
  explicit Mat5Writer(Order order) : order_(order) {}

  template <class T>
  [[nodiscard]] std::string number(T value) const {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if ((order_ == Order::little) != (std::endian::native == std::endian::little))
      bytes = {bytes.rbegin(), bytes.rend()};
    return bytes;
  }
  [[nodiscard]] std::string header() const {
    std::string bytes = "MATLAB 5.0 MAT-file";
    bytes.resize(124, ' ');
    std::fill(bytes.begin() + 116, bytes.end(), '\0');
    return bytes + number<std::uint16_t>(0x0100) + (order_ == Order::little ? "IM" : "MI");
  }
  [[nodiscard]] std::string element(std::uint32_t type, std::string bytes) const {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
    return number(type) + number(size) + bytes;
  }
  [[nodiscard]] std::string short_element(std::uint32_t type, std::string bytes) const {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    bytes.resize(4, '\0');
    return number(size << 16 | type) + bytes;
  }
  [[nodiscard]] std::string head(std::uint32_t matlab_class, std::int32_t rows, std::int32_t columns,
                                 const std::string& name) const {
    return element(6, number(matlab_class) + number(std::uint32_t{0})) + element(5, number(rows) + number(columns)) +
           element(1, name);
  }
  /// A variable of class double.
  [[nodiscard]] std::string column(const std::string& name, const Samples& values) const {
    std::string bytes;
    for (const double value : values) bytes += number(value);
    return element(14, head(6, static_cast<std::int32_t>(values.size()), 1, name) + element(9, bytes));
  }
  /// A MATLAB object, as MATLAB writes one without compression: it has no size.
  [[nodiscard]] std::string object(const std::string& name) const {
    return element(14, element(6, number(std::uint32_t{17}) + number(std::uint32_t{0})) + element(1, name) +
                           element(1, "MCOS") + element(1, "timeseries") +
                           element(14, head(13, 1, 1, "") + element(6, number(std::uint32_t{1}))));
  }
  [[nodiscard]] std::string compressed(const std::string& variable) const {
    std::string bytes(compressBound(variable.size()), '\0');
    uLongf size = bytes.size();
    compress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(variable.data()),
             variable.size());
    bytes.resize(size);
    return number(std::uint32_t{15}) + number(static_cast<std::uint32_t>(size)) + bytes;  // not padded
  }

 private:
  Order order_;
};

class Mat5Bytes : public RecordingFolder, public testing::WithParamInterface<Order> {
 protected:
  Mat5Writer mat{GetParam()};

  [[nodiscard]] tl::expected<Recording, InputError> read(const std::string& variables, const std::string& name) const {
    return read_recording(write("a.mat", mat.header() + variables), at_1_khz({name}));
  }
  [[nodiscard]] std::string refusal(const std::string& variables, const std::string& name) const {
    const auto recording = read(variables, name);
    return recording ? "read" : data_of(recording.error());
  }
  /// What is wrong with the variable that cannot be read, where another one can.
  [[nodiscard]] std::string damage(const std::string& variable) const {
    const std::string variables = variable + mat.column("good", {1.0, 2.0});
    const auto recording = read(variables, "good");
    if (!recording) return data_of(recording.error());
    for (const Remark& remark : recording->remarks) {
      const bool is_damage = remark.finding && remark.finding->code == FindingCode::damaged_skipped;
      if (is_damage) {
        EXPECT_EQ(remark.finding->subjects.at(0).text.find("byte 128 ("), 0U) << remark.what;
        return refusal(variables, "byte 128");
      }
    }
    return "no warning";
  }
};

INSTANTIATE_TEST_SUITE_P(Orders, Mat5Bytes, testing::Values(Order::little, Order::big),
                         [](const auto& tested) { return tested.param == Order::little ? "Little" : "Big"; });

TEST_P(Mat5Bytes, ReadsEitherByteOrderCompressedOrNot) {
  const auto plain = read(mat.column("x", {1.5, -2.25}), "x");
  ASSERT_TRUE(plain.has_value()) << plain.error().str();
  EXPECT_EQ(plain->channels[0].samples, (Samples{1.5, -2.25}));
  const auto packed =
      read(mat.compressed(mat.column("x", {1.5, -2.25})) + mat.compressed(mat.column("y", {3.0, 4.0})), "y");
  ASSERT_TRUE(packed.has_value()) << packed.error().str();
  EXPECT_EQ(packed->channels[0].samples, (Samples{3.0, 4.0}));
}

// MATLAB keeps a double array whose values are small whole numbers in as few bytes as they take.
TEST_P(Mat5Bytes, ReadsDoublesThatAreKeptAsSmallIntegers) {
  const std::string numbers = mat.number(std::int16_t{-300}) + mat.number(std::int16_t{25});
  const auto recording = read(mat.element(14, mat.head(6, 2, 1, "x") + mat.short_element(3, numbers)), "x");
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{-300.0, 25.0}));
}

TEST_P(Mat5Bytes, ReadsOnBehindAnObject) {
  for (const bool packed : {false, true}) {
    const std::string object = packed ? mat.compressed(mat.object("ts")) : mat.object("ts");
    const auto recording = read(object + mat.column("x", {1.0, 2.0}), "x");
    ASSERT_TRUE(recording.has_value()) << recording.error().str();
    EXPECT_TRUE(mentions(recording->remarks, "MATLAB objects are skipped: ts"));
  }
  EXPECT_EQ(refusal(mat.object("ts"), "x"), "holds_none wanted=signals objects=ts");
}

TEST_P(Mat5Bytes, SkipsAVariableWhoseSizesContradictEachOther) {
  const std::string two_numbers = mat.element(9, mat.number(1.0) + mat.number(2.0));
  const std::string start = "byte 128: ";
  EXPECT_EQ(damage(mat.element(14, mat.head(6, 2147483647, 2147483647, "x") + two_numbers)),
            start + "size_disagrees count=16 unit=bytes");
  EXPECT_EQ(damage(mat.element(14, mat.head(6, 3, 1, "x") + two_numbers)),
            start + "size_disagrees count=16 unit=bytes");
  EXPECT_EQ(damage(mat.element(14, mat.head(6, 2, -1, "x") + two_numbers)), start + "wrong_field value=-1 field=size");
  EXPECT_EQ(damage(mat.element(14, mat.head(6, 2, 1, "x") + mat.number(std::uint32_t{9}) +
                                       mat.number(std::uint32_t{0xFFFFFFF0U}) + mat.number(1.0))),
            start + "bytes_missing bytes=4.29497e+09 left=8");
  EXPECT_EQ(damage(mat.element(14, mat.head(6, 2, 1, "x"))), start + "data_end_inside part=an element");
  EXPECT_EQ(damage(mat.element(14, mat.head(6, 2, 1, "x") + mat.element(8, std::string(16, 'x')))),
            start + "wrong_element type=8 bytes=16 part=numbers");
  EXPECT_EQ(damage(mat.element(14, mat.element(9, mat.number(1.0)))),
            start + "wrong_element type=9 bytes=8 part=flags");
}

TEST_P(Mat5Bytes, SkipsAVariableThatDoesNotUnpack) {
  std::string packed = mat.compressed(mat.column("x", Samples(100, 1.0)));
  packed[packed.size() - 2] ^= 0x10;  // in the checksum
  EXPECT_EQ(damage(packed), "byte 128: does_not_unpack");
}

// matio writes an outermost size that is too large where it compresses text.
TEST_P(Mat5Bytes, ReadsACompressedVariableWhoseOutermostSizeIsWrong) {
  std::string variable = mat.column("x", {1.0, 2.0});
  variable.replace(4, 4, mat.number(static_cast<std::uint32_t>(variable.size())));
  const auto recording = read(mat.compressed(variable), "x");
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0}));
  EXPECT_EQ(damage(mat.compressed("too short")), "byte 128: does_not_unpack");
}

TEST_P(Mat5Bytes, BoundsNestingAndStructs) {
  std::string field = mat.column("", {1.0, 2.0});
  for (int depth = 0; depth < 100; ++depth) {
    field = mat.element(14, mat.head(2, 1, 1, "s") + mat.short_element(5, mat.number(std::int32_t{8})) +
                                mat.element(1, std::string("f\0\0\0\0\0\0\0", 8)) + field);
  }
  EXPECT_EQ(damage(field), "byte 128: nested_too_deep most=32");
  const std::string vast =
      mat.element(14, mat.head(2, 2147483647, 1000, "s") + mat.short_element(5, mat.number(std::int32_t{8})) +
                          mat.element(1, std::string("f\0\0\0\0\0\0\0", 8)));
  const auto recording = read(vast + mat.column("good", {1.0, 2.0}), "good");
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(refusal(vast + mat.column("good", {1.0, 2.0}), "s"), "s: has_too_many most=20000 what=fields");
}

TEST_P(Mat5Bytes, RefusesAFileThatIsCutOff) {
  const std::string variables = mat.column("x", {1.0, 2.0}) + mat.compressed(mat.column("y", {3.0, 4.0}));
  const std::string whole = mat.header() + variables;
  const std::size_t second = mat.header().size() + mat.column("x", {1.0, 2.0}).size();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    RecordingOptions options = at_1_khz({"x"});
    options.format = RecordingFormat::mat;
    const auto recording = read_recording(write("cut.mat", whole.substr(0, size)), options);
    ASSERT_EQ(recording.has_value(), size == second) << "cut to " << size << " bytes";
    if (!recording) {
      EXPECT_FALSE(recording.error().what.empty());
    }
  }
  const std::size_t packed_bytes = whole.size() - second - 8;  // behind the tag
  EXPECT_EQ(refusal(variables.substr(0, variables.size() - 1), "x"),
            fmt::format("bytes_missing bytes={} left={} byte=208", packed_bytes, packed_bytes - 1));
}

TEST_P(Mat5Bytes, NeverCrashesOnAWrongByte) {
  const std::string whole =
      mat.header() + mat.column("x", {1.0, 2.0}) + mat.object("ts") +
      mat.element(14, mat.head(2, 1, 1, "s") + mat.short_element(5, mat.number(std::int32_t{8})) +
                          mat.element(1, std::string("f\0\0\0\0\0\0\0", 8)) + mat.column("", {3.0, 4.0}));
  for (std::size_t place = 124; place < whole.size(); ++place) {
    for (const int flip : {0x01, 0x80, 0xFF}) {
      std::string damaged = whole;
      damaged[place] = static_cast<char>(damaged[place] ^ flip);
      RecordingOptions options = at_1_khz({"x"});
      options.format = RecordingFormat::mat;
      const auto recording = read_recording(write("flip.mat", damaged), options);
      if (recording) {
        EXPECT_GE(recording->channels[0].samples.size(), 2U);
      } else {
        EXPECT_FALSE(recording.error().what.empty());
      }
    }
  }
}

TEST(Inflate, StopsAtItsLimit) {
  const std::string zeros(1 << 20, '\0');
  std::vector<unsigned char> packed(compressBound(zeros.size()));
  uLongf size = packed.size();
  ASSERT_EQ(compress(packed.data(), &size, reinterpret_cast<const Bytef*>(zeros.data()), zeros.size()), Z_OK);
  packed.resize(size);
  const auto whole = inflate_all(packed, zeros.size());
  ASSERT_TRUE(whole.has_value());
  EXPECT_EQ(whole->size(), zeros.size());
  const auto too_much = inflate_all(packed, zeros.size() - 1);
  ASSERT_FALSE(too_much.has_value());
  EXPECT_EQ(too_much.error(), InflateFailure::too_large);
  packed.resize(size / 2);
  EXPECT_EQ(inflate_all(packed, zeros.size()), tl::unexpected(InflateFailure::damaged));
  EXPECT_EQ(inflate_all({}, zeros.size()), tl::unexpected(InflateFailure::damaged));
}

}  // namespace
}  // namespace zwidth
