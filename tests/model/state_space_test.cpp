#include "zwidth/model/state_space.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <complex>

#include "lhifam.hpp"
#include "log_spaced.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth {
namespace {

std::complex<double> response_of(const ContinuousStateSpace& system, double frequency) {
  Eigen::MatrixXcd matrix = (-system.A).cast<std::complex<double>>();
  matrix.diagonal().array() += std::complex<double>(0.0, frequency);
  const Eigen::VectorXcd state = matrix.fullPivLu().solve(system.B.cast<std::complex<double>>());
  return (system.C.cast<std::complex<double>>() * state)(0);
}

// The pencil sI - A loses digits that the modal form keeps: its condition number times the rounding unit, below 1e-9
// for these devices.
void expect_modal_response(const DeviceParameters& parameters) {
  const Device device(parameters);
  const ModalForm form = modal_form(device);
  const ContinuousStateSpace system = state_space(device);
  for (const double frequency : test::log_spaced(1e-1, 3e3, 40)) {
    EXPECT_LE(std::abs(response_of(system, frequency) / response(form, frequency) - 1.0), 1e-9)
        << "at " << frequency << " rad/s";
  }
}

TEST(StateSpace, OfBodiesIsInPhysicalCoordinates) {
  const ContinuousStateSpace system = state_space(Device(test::handle_sensed(test::lhifam_parameters())));
  Eigen::MatrixXd A(4, 4);
  A << 0.0, 0.0, 1.0, 0.0,  //
      0.0, 0.0, 0.0, 1.0,   //
      -79.5e3 / 0.3, 79.5e3 / 0.3, -15.1 / 0.3, 15.0 / 0.3, 79.5e3 / 5.1, -79.5e3 / 5.1, 15.0 / 5.1, -18.4 / 5.1;
  EXPECT_TRUE(system.A.isApprox(A, 1e-15)) << system.A;
  EXPECT_TRUE(system.B.isApprox(Eigen::Vector4d(0.0, 0.0, 1.0 / 0.3, 0.0), 1e-15)) << system.B;
  EXPECT_EQ(system.C, Eigen::RowVector4d(0.0, 1.0, 0.0, 0.0));
}

TEST(StateSpace, LagAddsOneState) {
  DeviceParameters device = test::lhifam_parameters();
  device.actuator.time_constant = 2e-3;
  const ContinuousStateSpace system = state_space(Device(device));
  ASSERT_EQ(system.A.rows(), 5);
  ASSERT_EQ(system.A.cols(), 5);
  ASSERT_EQ(system.B.size(), 5);
  ASSERT_EQ(system.C.size(), 5);
  EXPECT_EQ(system.A(4, 4), -500.0);
  EXPECT_EQ(system.B(4), 500.0);
  expect_modal_response(device);
}

TEST(StateSpace, ResponseIsThatOfTheModalForm) {
  DeviceParameters device = test::lhifam_parameters();
  expect_modal_response(device);
  expect_modal_response(test::handle_sensed(device));
  device.user = {0.5, 6.0, 300.0};
  device.bodies[0].stiffness = 20.0;
  device.bodies.push_back({"carriage", 0.8, 0.4, 0.0, 0.0});
  device.links.push_back({0, 2, 4e4, 2.0});
  device.links.push_back({1, 2, 3e3, 0.0});
  device.loop.sensed = 2;
  expect_modal_response(device);
}

TEST(StateSpace, OfATransferFunctionIsItsControllableForm) {
  const DeviceParameters device =
      test::transfer_function_parameters({6.0, 4.0}, {2.0, 10.0, 8.0, 4.0}, 1e-3);  // over 2: 3 s + 2, 1 5 4 2
  const ContinuousStateSpace system = state_space(Device(device));
  Eigen::Matrix3d A;
  A << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -2.0, -4.0, -5.0;
  EXPECT_EQ(system.A, A);
  EXPECT_EQ(system.B, Eigen::Vector3d(0.0, 0.0, 1.0));
  EXPECT_EQ(system.C, Eigen::RowVector3d(2.0, 3.0, 0.0));
  expect_modal_response(device);
}

}  // namespace
}  // namespace zwidth
