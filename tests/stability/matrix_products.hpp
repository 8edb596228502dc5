#pragma once

// What Eigen takes seconds to compile in each expression that is written out: here it is compiled once.

#include <Eigen/Core>

namespace zwidth::test {

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXcd complex_product(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b);
Eigen::MatrixXcd complex_of(const Eigen::MatrixXd& real);

/// to += weight * along * along'.
void add_square(Eigen::MatrixXd& to, double weight, const Eigen::VectorXd& along);

Eigen::MatrixXcd solution(const Eigen::MatrixXcd& of, const Eigen::MatrixXcd& right);
Eigen::MatrixXcd inverse_of(const Eigen::MatrixXcd& of);

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXcd& a);

struct Axes {
  Eigen::VectorXd values;   // rising
  Eigen::MatrixXd vectors;  // columns
};
/// Of the symmetric part.
Axes axes_of(const Eigen::MatrixXd& a);

}  // namespace zwidth::test
