#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "stability/tip/chebyshev_panels.hpp"
#include "stability/tip/grasp_discs.hpp"
#include "stability/tip/grasp_stiffness.hpp"
#include "stability/users/termination_discs.hpp"

namespace zwidth::internal {

// The least over frequency of what some grasp of the tip destabilises, at one pose.
//
// What a disc is made of are functions of the frequency whose poles are known: GraspDiscs::lossless_points(), and what turns with
// the aliases. Between them they are polynomials through the nodes of panels, which are short where poles are near; at the ends of
// each the polynomials are compared with the functions, and a panel that errs is halved. The least is that of the polynomials, and
// where it is asked for exactly, of the discs themselves beside it.
class GraspSearch {
 public:
  // `corners`: poles and zeros in z of the filters that the walls are behind.
  GraspSearch(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions,
              const SampledTip& plant, const std::vector<std::complex<double>>& corners = {});

  using WallAt = std::function<WallResponse(double angle)>;
  // A wall at all points of the panels.
  struct Wall {
    WallAt at;
    std::vector<WallResponse> at_points;
  };
  [[nodiscard]] Wall wall(WallAt at) const;

  struct Least {
    double gain = std::numeric_limits<double>::infinity();
    double angle = 0.0;
    bool is_at_low_end = false;
  };

  // The discs along one normal. Must not outlive the search.
  class Along {
   public:
    Along(const GraspSearch& search, const Eigen::Vector3d& normal);
    // Of the discs themselves.
    [[nodiscard]] Least least(const Wall& wall) const;
    // Of the polynomials.
    [[nodiscard]] Least quickly_least(const Wall& wall) const;

   private:
    // By column: real and imaginary part of the centre before the delay, its |c|^2 - r^2 and the square of the radius without the other
    // aliases, their radius.
    using Parts = Eigen::Matrix<double, panel_nodes, 5>;
    // At the angle's logarithm x, the least between two others.
    struct Low {
      double gain = std::numeric_limits<double>::infinity();
      double x = 0.0;
      double before = 0.0;
      double after = 0.0;
    };
    [[nodiscard]] static TerminationDiscs::Disc disc(const Eigen::Matrix<double, 5, 1>& parts,
                                                     std::complex<double> delay);
    [[nodiscard]] TerminationDiscs::Disc disc_near(double x) const;
    // What may be the least: 1.3 times the least of the points or `bound`, whatever is more.
    [[nodiscard]] std::vector<Low> lows(const Wall& wall, double bound) const;

    const GraspSearch* search_;
    Eigen::Vector3d normal_;
    std::vector<Parts> panels_;
    std::vector<TerminationDiscs::Disc> at_points_;
  };

  // Of a point wall in all m directions of the tip: of the discs at the nodes, refined beside the least.
  struct LeastOfPoint {
    Least at_least;
    Least at_most;
  };
  [[nodiscard]] LeastOfPoint least_of_point(Eigen::Index m, VirtualDamper damper) const;

  [[nodiscard]] const GraspDiscs& discs() const { return discs_; }

  // Not where the slowest corner lies so low that the discs' digits do not reach below it: no limit is known then, and gains are NaN.
  [[nodiscard]] bool is_known() const { return is_known_; }

 private:
  // Over angle; by rows the nodes.
  struct OthersPanel {
    Panel panel;
    std::vector<GraspDiscs::Others> at_nodes;
  };
  // Over the angle's logarithm; by columns products_of() a normal.
  struct OwnPanel {
    using Forms = Eigen::Matrix<GraspDiscs::Real, panel_nodes, 6>;
    Panel panel;
    Forms real;
    Forms imaginary;
    Forms left;
    Forms right;
    std::array<std::complex<double>, panel_nodes> shared;
    std::vector<std::size_t> others;  // which panel of them each node lies in
    Eigen::Matrix<double, panel_nodes, panel_nodes> others_weights;
    std::vector<GraspDiscs::Sample> at_points;  // where the polynomials err: beside a lossless point on the axis
    [[nodiscard]] bool errs() const { return !at_points.empty(); }
  };
  // Over `shared`, which is before the delay.
  struct OwnForms {
    using Form = Eigen::Matrix<GraspDiscs::Real, 1, 6>;
    Form real;
    Form imaginary;
    Form left;
    Form right;
    std::complex<double> shared;
  };

  void add_others(const std::vector<std::complex<double>>& poles);
  void add_own(const std::vector<std::complex<double>>& poles);
  [[nodiscard]] std::size_t others_panel_of(double angle) const;
  // `at_nodes`: what the panel's polynomials are of, along each of the probes.
  [[nodiscard]] bool others_drown(const OwnPanel& own,
                                  const std::vector<Eigen::Matrix<double, Eigen::Dynamic, 5>>& at_nodes) const;
  [[nodiscard]] OwnForms own_forms(double angle) const;
  [[nodiscard]] Least least_at(double gain, double x) const;
  [[nodiscard]] Least known(const Least& least) const;

  GraspDiscs discs_;
  double period_ = 0.0;
  double delay_angle_ = 0.0;  // t_d/T: what an angle turns by
  double lowest_ = 0.0;
  double slowest_ = 0.0;  // corner, rad a sample
  bool is_known_ = true;
  std::vector<OthersPanel> others_;
  std::vector<OwnPanel> panels_;
  std::vector<double> points_;  // the angle's logarithm, rising
  std::vector<std::complex<double>> delays_;
};

// rad/s; 0 where there is none, and at the low end.
[[nodiscard]] double frequency_of(const GraspSearch::Least& least, double period);

}  // namespace zwidth::internal
