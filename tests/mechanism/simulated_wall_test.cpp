// The limit of a mechanism beside MuJoCo's own motion of it: the wall, sampled and late, on its actuators at steps of 10 us.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "mechanism/random_mechanism.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using test::Positions;
using test::RandomMechanism;

constexpr double period = 1e-3;  // s
constexpr double step = 1e-5;    // s
constexpr int steps_a_period = 100;
constexpr double near = 0.02;   // relative, of the limit: how far above it the motion grows, below it decays
constexpr double push = 1e-6;   // m or rad, and that over a millisecond: small motion
constexpr int periods = 200;    // that are watched
constexpr double still = 1e-7;  // relative, a period: what rounding and the solver of loops leave of a pole at z = 1

/// A mechanism in MuJoCo, and a wall that knows it by its encoders alone.
class SampledWall {
 public:
  SampledWall(const RandomMechanism& mechanism, const std::string& path) {
    char why[1000] = "";
    model_.reset(mj_loadXML(path.c_str(), nullptr, why, sizeof why));
    if (!model_) throw std::runtime_error(why);
    model_->opt.timestep = step;
    model_->opt.integrator = mjINT_IMPLICIT;
    model_->opt.solver = mjSOL_NEWTON;
    model_->opt.tolerance = 0.0;
    model_->opt.disableflags |= mjDSBL_CONTACT;
    data_.reset(mj_makeData(model_.get()));
    late_ = static_cast<int>(std::lround(mechanism.delay / step));
    const Positions rest = mechanism.joints_of_pose(mechanism.pose);
    go_to(rest);
    rest_ = positions();
    const auto slope = [&](const std::string& joint, const Positions& at, const auto& joints_of) {
      constexpr double little = 1e-5;
      Positions up = at;
      Positions down = at;
      up[joint] += little;
      down[joint] -= little;
      return mechanism.normal.dot(tip(joints_of(up)) - tip(joints_of(down))) / (2.0 * little);
    };
    for (std::size_t i = 0; i < mechanism.motors.size(); ++i) {
      const std::string& motor = mechanism.motors[i];
      Positions driven;
      for (const std::string& each : mechanism.motors) driven[each] = rest.at(each);
      const double by_motor = slope(motor, driven, mechanism.joints_of_motors);
      by_actuator_.push_back(by_motor / mechanism.gears[i]);
      if (mechanism.encoders.empty()) by_encoder_.emplace_back(index(motor), by_motor);
    }
    for (const std::string& joint : mechanism.encoders) {
      by_encoder_.emplace_back(index(joint), slope(joint, mechanism.pose, mechanism.joints_of_pose));
    }
  }

  /// Positions from rest, velocities by milliseconds, and the forces that are under way.
  [[nodiscard]] Eigen::Index size() const { return 2 * model_->nv + forces(); }

  void start(const Eigen::VectorXd& state) {
    const int n = model_->nv;
    mj_resetData(model_.get(), data_.get());
    Eigen::Map<Eigen::VectorXd>(data_->qpos, n) = rest_ + state.head(n);
    Eigen::Map<Eigen::VectorXd>(data_->qvel, n) = state.segment(n, n) / period;
    commanded_.assign(state.end() - forces(), state.end());
  }

  [[nodiscard]] Eigen::VectorXd state() const {
    const int n = model_->nv;
    Eigen::VectorXd result(size());
    result << positions() - rest_, period * Eigen::Map<const Eigen::VectorXd>(data_->qvel, n),
        Eigen::Map<const Eigen::VectorXd>(std::vector<double>(commanded_.begin(), commanded_.end()).data(), forces());
    return result;
  }

  /// From one sample to the next.
  void run_a_period(double stiffness) {
    double tip = 0.0;
    for (const auto& [joint, by] : by_encoder_) tip += by * (data_->qpos[joint] - rest_(joint));
    commanded_.push_back(-stiffness * tip);
    for (int i = 0; i < steps_a_period; ++i) {
      // MuJoCo's velocity is that of half a step before its position: a force that changes at a step acts over half of it.
      const double force = 0.5 * (acting(i - 1) + acting(i));
      for (std::size_t motor = 0; motor < by_actuator_.size(); ++motor)
        data_->ctrl[motor] = by_actuator_[motor] * force;
      mj_step(model_.get(), data_.get());
    }
    commanded_.pop_front();
  }

  /// What a period makes of a small state: one column a coordinate of it.
  Eigen::MatrixXd transition(double stiffness) {
    Eigen::MatrixXd result(size(), size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      for (const double way : {push, -push}) {
        start(way * Eigen::VectorXd::Unit(size(), i));
        run_a_period(stiffness);
        if (way > 0.0) {
          result.col(i) = state();
        } else {
          result.col(i) = (result.col(i) - state()) / (2.0 * push);
        }
      }
    }
    return result;
  }

 private:
  [[nodiscard]] Eigen::Index forces() const { return 1 + late_ / steps_a_period; }

  // The force at a step after the last sample: the newest, or one before it.
  [[nodiscard]] double acting(int at) const {
    const int before = at < late_ ? (late_ - at + steps_a_period - 1) / steps_a_period : 0;
    return *(commanded_.end() - 1 - before);
  }

  [[nodiscard]] Eigen::VectorXd positions() const { return Eigen::Map<const Eigen::VectorXd>(data_->qpos, model_->nv); }
  [[nodiscard]] int index(const std::string& joint) const {
    return mj_name2id(model_.get(), mjOBJ_JOINT, joint.c_str());
  }
  void go_to(const Positions& joints) {
    for (const auto& [joint, position] : joints) data_->qpos[index(joint)] = position;
    mj_fwdPosition(model_.get(), data_.get());
  }
  Eigen::Vector3d tip(const Positions& joints) {
    go_to(joints);
    return Eigen::Map<const Eigen::Vector3d>(data_->site_xpos + 3 * mj_name2id(model_.get(), mjOBJ_SITE, "tip"));
  }

  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  int late_ = 0;  // steps
  Eigen::VectorXd rest_;
  std::vector<double> by_actuator_;                 // signals of unit force at the tip
  std::vector<std::pair<int, double>> by_encoder_;  // motion of the tip along the normal of unit motion
  std::deque<double> commanded_;                    // by the samples, the newest last
};

/// How the motion at the limit's frequency grew over the periods, started alone.
double growth(SampledWall& wall, double stiffness, double frequency, double* largest_pole) {
  const Eigen::MatrixXd transition = wall.transition(stiffness);
  const Eigen::EigenSolver<Eigen::MatrixXd> right(transition);
  const std::complex<double> wanted = std::polar(1.0, frequency * period);
  Eigen::Index mode = 0;
  (right.eigenvalues().array() - wanted).abs().minCoeff(&mode);
  *largest_pole = right.eigenvalues().cwiseAbs().maxCoeff();
  const Eigen::EigenSolver<Eigen::MatrixXd> left(transition.transpose());
  Eigen::Index same = 0;
  (left.eigenvalues().array() - right.eigenvalues()(mode)).abs().minCoeff(&same);
  const Eigen::VectorXcd along = left.eigenvectors().col(same);
  Eigen::VectorXd state = right.eigenvectors().col(mode).real();
  state *= push / state.cwiseAbs().maxCoeff();
  const auto amplitude = [&along](const Eigen::VectorXd& of) {
    return std::abs(along.conjugate().dot(of.cast<std::complex<double>>()));
  };
  wall.start(state);
  const double before = amplitude(state);
  for (int i = 0; i < periods; ++i) wall.run_a_period(stiffness);
  return amplitude(wall.state()) / before;
}

unsigned mechanisms() {
  const char* wanted = std::getenv("ZWIDTH_MECHANISM_CASES");
  return wanted != nullptr ? static_cast<unsigned>(std::stoul(wanted)) : test::by_tier(8U, 100U);
}

TEST(SimulatedWall, grows_above_the_limit_and_decays_below_it) {
  for (unsigned seed = 1; seed <= mechanisms(); ++seed) {
    SCOPED_TRACE(seed);
    const RandomMechanism mechanism = test::random_mechanism(seed);
    const std::string path = testing::TempDir() + "random_mechanism.xml";
    std::ofstream(path) << mechanism.xml;
    DeviceParameters loop;
    loop.loop.sampling_period = period;
    loop.loop.delay = mechanism.delay;
    const MechanismAtPose at = at_pose(
        {.path = path, .tip = "tip", .encoders = mechanism.encoders, .pose = mechanism.pose, .transmissions = {}});
    const CriticalStiffness limit = critical_stiffness(device_along(at, mechanism.normal, loop));
    ASSERT_EQ(limit.status, StiffnessStatus::finite);
    EXPECT_TRUE(limit.trust.sound());
    SampledWall wall(mechanism, path);
    double largest = 0.0;
    EXPECT_GT(growth(wall, (1.0 + near) * limit.stiffness, limit.limit->frequency, &largest), 1.0);
    EXPECT_GT(largest, 1.0 + still);
    EXPECT_LT(growth(wall, (1.0 - near) * limit.stiffness, limit.limit->frequency, &largest), 1.0);
    EXPECT_LT(largest, 1.0 + still);
  }
}

}  // namespace
}  // namespace zwidth
