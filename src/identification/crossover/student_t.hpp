#pragma once

namespace zwidth::internal {

/// The 97.5 % quantile of a normal deviate: 95 % of them lie between it and its opposite.
inline constexpr double two_sided_95 = 1.959963984540054;

/// The 97.5 % quantile of Student's t of so many degrees of freedom, > 0.
[[nodiscard]] double student_t_quantile(double freedom);

}  // namespace zwidth::internal
