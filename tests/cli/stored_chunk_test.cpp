#include "study/stored_chunk.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <numeric>
#include <random>
#include <string>

namespace zwidth::study_engine {
namespace {

// HDF5 itself reads what stored_chunk() made, its checksum included, and a damaged byte is an error of its own.
class StoredChunk : public testing::Test {
 protected:
  // a name of its own: the tests run side by side
  StoredChunk()
      : path_(testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ".stored_chunk.h5") {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  }
  StoredChunk(const StoredChunk&) = delete;
  StoredChunk& operator=(const StoredChunk&) = delete;
  ~StoredChunk() override {
    H5Fclose(file_);
    std::remove(path_.c_str());
  }

  /// Whether HDF5 reads the bytes as these values, and zeros up to the capacity.
  template <typename T>
  [[nodiscard]] bool reads(const std::vector<unsigned char>& bytes, const std::vector<T>& values, hsize_t capacity,
                           hid_t type) {
    const hid_t space = H5Screate_simple(1, &capacity, nullptr);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 1, &capacity);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, deflate_level);
    H5Pset_fletcher32(properties);
    const std::string name = "data" + std::to_string(datasets_++);
    const hid_t data = H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    const hsize_t start = 0;
    bool is_same = H5Dwrite_chunk(data, H5P_DEFAULT, 0, &start, bytes.size(), bytes.data()) >= 0;
    std::vector<T> read(capacity, T{7});
    is_same = is_same && H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()) >= 0;
    std::vector<T> expected = values;
    expected.resize(capacity, T{});
    is_same = is_same && read == expected;
    H5Dclose(data);
    H5Pclose(properties);
    H5Sclose(space);
    return is_same;
  }

 private:
  std::string path_;
  hid_t file_ = -1;
  int datasets_ = 0;
};

TEST_F(StoredChunk, IsReadByHdf5) {
  std::mt19937_64 engine(20261123);
  std::normal_distribution<double> normal;
  for (const std::size_t capacity : {1U, 2U, 3U, 100U, 4095U, 4096U, 300'000U}) {
    for (const std::size_t count : {std::size_t{1}, (capacity + 1) / 2, capacity}) {
      SCOPED_TRACE(std::to_string(count) + " of " + std::to_string(capacity));
      std::vector<double> numbers(count);
      for (double& each : numbers) each = normal(engine);
      EXPECT_TRUE(reads(stored_chunk(numbers.data(), 8, count, capacity), numbers, capacity, H5T_NATIVE_DOUBLE));
      std::vector<std::int16_t> words(count);
      std::iota(words.begin(), words.end(), std::int16_t{-5});
      EXPECT_TRUE(reads(stored_chunk(words.data(), 2, count, capacity), words, capacity, H5T_NATIVE_INT16));
      std::vector<std::uint8_t> bytes(count);
      for (std::uint8_t& each : bytes) each = static_cast<std::uint8_t>(engine());
      EXPECT_TRUE(reads(stored_chunk(bytes.data(), 1, count, capacity), bytes, capacity, H5T_NATIVE_UINT8));
    }
  }
}

TEST_F(StoredChunk, IsNotReadWhereAByteIsDamaged) {
  const std::vector<double> numbers{1.0, 2.5, -3.75};
  std::vector<unsigned char> stored = stored_chunk(numbers.data(), 8, 3, 3);
  EXPECT_TRUE(reads(stored, numbers, 3, H5T_NATIVE_DOUBLE));
  for (unsigned char& byte : stored) {
    byte ^= 1U;
    EXPECT_FALSE(reads(stored, numbers, 3, H5T_NATIVE_DOUBLE));
    byte ^= 1U;
  }
}

}  // namespace
}  // namespace zwidth::study_engine
