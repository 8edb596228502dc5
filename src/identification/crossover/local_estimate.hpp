#pragma once

#include <cstddef>
#include <span>

namespace zwidth::internal {

/// A value with its standard deviation.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;
};

/// One sample of a smooth curve. Its error is normal, of zero mean.
struct CurveSample {
  double x = 0.0;
  double y = 0.0;
  double sigma = 0.0;  ///< > 0
  bool counts = true;  ///< else it only takes up its place
};

/// The curve at samples[index].x: a parabola (a line, a constant: among few samples) fitted to the samples around.
///
/// As wide a neighbourhood is taken as its misfit allows and as agrees with the narrower ones (Lepski's rule), so that
/// the bias stays below the noise that is left. `correlation`: variance of the sum of neighbouring errors over that of
/// as many independent ones. The sample itself must count. Source: Lepski 1991; Fan & Gijbels 1996, ch. 3.
[[nodiscard]] Estimate local_estimate(std::span<const CurveSample> samples, std::size_t index, double correlation);

}  // namespace zwidth::internal
