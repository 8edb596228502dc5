#pragma once

#include <boost/endian/conversion.hpp>
#include <cstddef>
#include <span>
#include <vector>

namespace zwidth::internal {

enum class ByteOrder { little, big };

/// The number of type T whose bytes begin at `bytes`.
template <class T>
[[nodiscard]] T load(const unsigned char* bytes, ByteOrder order) {
  using boost::endian::endian_load;
  return order == ByteOrder::little ? endian_load<T, sizeof(T), boost::endian::order::little>(bytes)
                                    : endian_load<T, sizeof(T), boost::endian::order::big>(bytes);
}

/// The numbers of type T that `bytes` hold, one after the other.
template <class T>
[[nodiscard]] std::vector<double> load_all(std::span<const unsigned char> bytes, ByteOrder order) {
  std::vector<double> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<double>(load<T>(bytes.data() + i * sizeof(T), order));
  }
  return numbers;
}

}  // namespace zwidth::internal
