#pragma once

#include <optional>
#include <vector>

#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// How large |P| is at most on an interval of x = |z - 1|². |c0 + c1 delta + c2 delta²|² is a quadratic in x, whose range
// on an interval is exact: factor by factor and term by term no wide interval widens the bound, other than that of
// products of Taylor models.
class ResponseBound {
 public:
  explicit ResponseBound(const FilteredPlant& plant);

  // >= |P| for begin <= x <= end; infinite where nothing bounds it, as beside poles on the circle and of terms of more
  // than two poles.
  [[nodiscard]] double greatest(double begin, double end) const;

 private:
  struct Quadratic {
    Quadratic(double c0, double c1, double c2);
    [[nodiscard]] double least(double begin, double end) const;
    [[nodiscard]] double greatest(double begin, double end) const;
    double coefficients[3] = {};
    double sizes[3] = {};  // of what was added up in each
  };
  struct Quotient {
    Quadratic numerator;
    Quadratic denominator;
    std::size_t nyquist_zeros = 0;
    [[nodiscard]] double greatest(double begin, double end) const;
  };
  [[nodiscard]] double greatest_of_numerator(double begin, double end) const;

  const SampledPlant& plant_;
  bool is_told_ = true;
  std::vector<Quotient> terms_;
  std::vector<Quotient> filters_;
};

}  // namespace zwidth::internal
