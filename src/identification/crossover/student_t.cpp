#include "identification/crossover/student_t.hpp"

#include <boost/math/distributions/students_t.hpp>

namespace zwidth::internal {

double student_t_quantile(double freedom) {
  // In double: in long double it takes a compiler 1 s more.
  using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return boost::math::quantile(boost::math::students_t_distribution<double, Policy>(freedom), 0.975);
}

}  // namespace zwidth::internal
