#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "design/synthesis/margin_wall.hpp"
#include "zwidth/design/notch_design.hpp"

namespace zwidth::internal {

/// The margins that a notch is designed for.
[[nodiscard]] RequiredMargins required(const NotchOptions& options);

/// What is wrong with an uncertainty of the modal frequencies of this device: from 0 to 0.9, and links that have modes.
[[nodiscard]] std::optional<OptionProblem> find_modal_frequency_uncertainty_problem(double uncertainty,
                                                                                    const Device& device);

/// Where the wall sees the device's vibration modes, rad/s: themselves, or their aliases below Nyquist.
[[nodiscard]] std::vector<double> seen_modes(const Device& device);

/// Searches the notch that makes the least stiffest wall over some modal shifts of a device greatest, on grids of
/// frequencies.
class NotchSearch {
 public:
  /// Centre (rad/s), damping ratio and depth of a notch, as logarithms.
  using Point = std::array<double, 3>;
  [[nodiscard]] static WallFilter notch_at(const Point& at);

  /// `modes`: where the wall sees them, rad/s. `options` must outlive the search, whose work they
  /// are told within a step.
  NotchSearch(const NotchOptions& options, std::vector<double> modes, double period,
              bool keep_absolute_stability_limit);

  /// One modal shift of the device more.
  void add(const Device& device);
  /// `grid`: of the device with whatever virtual damper.
  void add(const Device& device, const LoopGrid& of_device);

  /// The best of a grid around each mode, with and without a look between the frequencies.
  [[nodiscard]] std::vector<Point> candidates(const Progress& progress) const;

  /// Pattern search from each: the best of the 26 neighbours of a cube, halved where none is better; at first on the
  /// grids, then exactly, since a grid may miss a narrow dip. With their stiffest walls; one more where the look between
  /// the frequencies leads elsewhere. Up to `nothing_gained` only a move that is seen to gain something is made.
  [[nodiscard]] std::vector<std::pair<double, Point>> refine(const std::vector<Point>& candidates,
                                                             double nothing_gained);
  /// On the grids alone.
  [[nodiscard]] std::pair<double, Point> refine_on_grid(Point at) const;

 private:
  struct Scenario {
    FilteredPlant plant;
    VirtualDamper damper;
    LoopGrid grid;
    double any_user = 0.0;  // without the notch, on the grid; 0: not to be kept
  };
  enum class Route { on_points, on_grid, exact };  // of the grid alone; crossovers between them too
  [[nodiscard]] double least(const Point& at, double enough, Route route) const;
  [[nodiscard]] double least_on_grid(const WallFilter& notch, double enough, Route route,
                                     std::vector<double>& of_scenarios, std::vector<LoopGrid::Response>& factors) const;
  [[nodiscard]] std::pair<double, Point> climb(Point at, double first_step, double last_step, Route route) const;
  [[nodiscard]] bool is_near(const Point& at) const;
  [[nodiscard]] Point inside(const Point& at) const;

  const NotchOptions& options_;
  RequiredMargins margins_;
  std::vector<double> modes_;
  double nyquist_;
  bool keep_absolute_stability_limit_;
  double nothing_gained_ = 0.0;
  std::vector<Scenario> scenarios_;
};

}  // namespace zwidth::internal
