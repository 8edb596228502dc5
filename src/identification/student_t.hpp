#pragma once

namespace zwidth::internal {

/// The 97.5 % quantile of Student's t of so many degrees of freedom, > 0.
[[nodiscard]] double student_t_quantile(double freedom);

}  // namespace zwidth::internal
