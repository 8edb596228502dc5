#include "cli/workspace_series.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "cli/request_context.hpp"

namespace zwidth::cli {
namespace {

constexpr double of_one_normal = 1e-12;  // of two that are the same to rounding

struct LimitTable {
  std::size_t columns;
  std::vector<double> nobody;
  std::vector<double> any_user;
  std::vector<double> normals;

  LimitTable(std::size_t rows, std::size_t columns_of_row)
      : columns(columns_of_row),
        nobody(rows * columns, std::numeric_limits<double>::quiet_NaN()),
        any_user(nobody),
        normals(3 * rows * columns, std::numeric_limits<double>::quiet_NaN()) {}

  void put_normal(std::size_t row, std::size_t column, const Eigen::Vector3d& normal) {
    std::copy(normal.begin(), normal.end(),
              normals.begin() + static_cast<std::ptrdiff_t>(3 * (row * columns + column)));
  }
  void put(std::size_t row, std::size_t column, const DirectionLimits& limits) {
    put_normal(row, column, limits.normal);
    nobody[row * columns + column] = limits.nobody;
    if (limits.any_user) any_user[row * columns + column] = *limits.any_user;
  }
};

}  // namespace

void hand_over_limits(const CLI::App& command, const Workspace& workspace, const WorkspaceOptions& options) {
  if (request_of(command) == nullptr) return;
  const std::size_t rows = workspace.poses.size();
  std::size_t columns = options.normals.size();
  for (const WorkspacePose& each : workspace.poses) {
    columns = std::max(columns, each.directions.size() + each.refused.size());
  }
  LimitTable table(rows, columns);
  for (std::size_t row = 0; row < rows; ++row) {
    const WorkspacePose& pose = workspace.poses[row];
    std::size_t next = 0;
    for (std::size_t column = 0; column < options.normals.size(); ++column) {
      const Eigen::Vector3d normal = options.normals[column].normalized();
      table.put_normal(row, column, normal);
      if (next == pose.directions.size() || !normal.isApprox(pose.directions[next].normal, of_one_normal)) continue;
      table.put(row, column, pose.directions[next++]);
    }
    if (!options.normals.empty()) continue;
    std::size_t column = 0;
    for (const DirectionLimits& each : pose.directions) table.put(row, column++, each);
    for (const RefusedDirection& each : pose.refused) table.put_normal(row, column++, each.normal);
  }
  hand_over_series(command, "shape", {static_cast<double>(rows), static_cast<double>(columns)});
  hand_over_series(command, "nobody", table.nobody);
  hand_over_series(command, "any_user", table.any_user);
  hand_over_series(command, "normals", table.normals);
}

}  // namespace zwidth::cli
