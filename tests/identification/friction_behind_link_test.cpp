// A motor that rubs behind a stiff, lightly damped link: it stops and starts again while the link swings, above all that the
// force excites.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "identification/model/motion_model.hpp"
#include "identification/model/number_keys.hpp"
#include "identification/model/rivals/rival.hpp"
#include "identification/simulated_record.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

/// A third of the force is friction, the link swings at 950 Hz.
DeviceParameters capstan() {
  return read_device_file(ZWIDTH_SOURCE_DIR "/devices/capstan_paddle.toml").value().parameters();
}

std::vector<double> swept(double duration) {
  return test::commanded(ExcitationKind::linear_chirp, 0.03, 2.0, 20.0, duration, 2);
}

TEST(FrictionBehindLink, IsPlayedAsASimulatorOfItsOwnDoes) {
  using internal::Number;
  const DeviceParameters device = capstan();
  const std::vector<double> force = swept(3.0);
  const std::vector<double> position = test::simulated_positions(test::plant_of(device), force);
  internal::ModelParts parts;
  parts.add({"body.motor.damping", Number::Scale::not_negative, device.bodies[0].damping});
  parts.add({"loop.delay", Number::Scale::not_negative, device.loop.delay});
  parts.add({internal::friction_key("motor"), Number::Scale::not_negative, device.bodies[0].coulomb});
  parts.terms.frictions.push_back({"motor", internal::friction_key("motor")});
  const internal::DeviceFamily family(device, parts.numbers, {});
  Eigen::VectorXd x = Eigen::VectorXd::Ones(3);
  for (const int substeps : {2, 8}) {
    const internal::MotionModel model(family, parts.terms, {{force, position, 1e-3}}, substeps);
    const auto motion = model.play(x, {{0, 0, position.size()}}, {Eigen::VectorXd::Zero(model.states())}, false);
    ASSERT_TRUE(motion.has_value());
    double squares = 0.0;
    double all = 0.0;
    for (std::size_t k = 0; k < position.size(); ++k) {
      squares += std::pow((*motion)[0].positions(static_cast<Eigen::Index>(k)) - position[k], 2);
      all += std::pow(position[k], 2);
    }
    EXPECT_LT(std::sqrt(squares / all), substeps == 2 ? 1e-3 : 2e-4) << substeps;
  }
}

/// What a fit misses of stops and starts it calls damping.
TEST(FrictionBehindLink, FitFindsTheLinkThatTheForceDoesNotExcite) {
  const DeviceParameters device = capstan();
  const double truth = critical_stiffness(Device(device)).stiffness;
  const Recording record = test::simulated_record(device, swept(5.0), {.step = 2.6e-4, .force = 0.0});
  const Identification found = identify(record, Device(device));
  ASSERT_TRUE(found.analysis.interval.has_value());
  EXPECT_LT(found.analysis.interval->lower, truth);
  EXPECT_GT(found.analysis.interval->upper, truth);
  EXPECT_NEAR(found.fit.device.bodies()[0].mass, device.bodies[0].mass, 0.05 * device.bodies[0].mass);
}

}  // namespace
}  // namespace zwidth
