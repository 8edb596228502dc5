#include "identification/model/row_sums.hpp"

#include <cstddef>
#include <utility>

namespace zwidth::internal {
namespace {

/// As many rows as there are `j`: their factors stay in registers.
template <Eigen::Index... j>
void add_few_rows(double* __restrict to, const double* by, const double* __restrict from, Eigen::Index stride,
                  Eigen::Index width, std::integer_sequence<Eigen::Index, j...> /*rows*/) {
  const double factors[] = {by[j]...};
  for (Eigen::Index column = 0; column < width; column += lanes) {
    double sum[lanes];
    for (Eigen::Index lane = 0; lane < lanes; ++lane) sum[lane] = to[column + lane];
    const auto add = [&](double factor, const double* row) {
      for (Eigen::Index lane = 0; lane < lanes; ++lane) sum[lane] += factor * row[lane];
    };
    (add(factors[j], from + column + j * stride), ...);
    for (Eigen::Index lane = 0; lane < lanes; ++lane) to[column + lane] = sum[lane];
  }
}

template <Eigen::Index count>
void add_few_rows(double* to, const double* by, const double* from, Eigen::Index stride, Eigen::Index width) {
  add_few_rows(to, by, from, stride, width, std::make_integer_sequence<Eigen::Index, count>());
}

}  // namespace

void add_rows(double* to, const double* by, Eigen::Index count, const double* from, Eigen::Index stride,
              Eigen::Index width) {
  constexpr Eigen::Index most = 8;
  for (; count > most; count -= most, by += most, from += most * stride)
    add_few_rows<most>(to, by, from, stride, width);
  switch (count) {
    case 1:
      return add_row(to, *by, from, width);
    case 2:
      return add_few_rows<2>(to, by, from, stride, width);
    case 3:
      return add_few_rows<3>(to, by, from, stride, width);
    case 4:
      return add_few_rows<4>(to, by, from, stride, width);
    case 5:
      return add_few_rows<5>(to, by, from, stride, width);
    case 6:
      return add_few_rows<6>(to, by, from, stride, width);
    case 7:
      return add_few_rows<7>(to, by, from, stride, width);
    case 8:
      return add_few_rows<8>(to, by, from, stride, width);
    default:
      return;
  }
}

}  // namespace zwidth::internal
