#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "reference/planar_arm.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using enum ProblemCode;

struct Refused {
  const char* name;
  std::function<void(DeviceParameters&)> change;
  const char* key;
  ProblemCode code;
};

TEST(Coordinates, are_refused_where_they_make_no_device) {
  const Refused cases[] = {
      {"beside_bodies",
       [](auto& d) {
         d.bodies.push_back({"body", 1.0, 0.0, 0.0, 0.0});
       },
       "coordinates", beside_coordinates},
      {"none", [](auto& d) { d.coordinates = Coordinates{}; }, "coordinates", coordinates_out_of_range},
      {"short_weights", [](auto& d) { d.coordinates->points[1].weights.pop_back(); }, "coordinates.points.1",
       weights_not_one_a_coordinate},
      {"no_weight", [](auto& d) { d.coordinates->elements[2].weights.assign(4, 0.0); }, "coordinates.elements.2",
       weights_not_one_a_coordinate},
      {"rounding_alone", [](auto& d) { d.coordinates->elements[2].weights.assign(4, 1e-32); }, "coordinates.elements.2",
       weights_not_one_a_coordinate},
      {"mass_of_rounding_alone", [](auto& d) { d.coordinates->mass[15] = 1e-32; }, "coordinates.mass", no_mass_matrix},
      {"negative_stiffness", [](auto& d) { d.coordinates->elements[4].stiffness = -1.0; }, "coordinates.elements.4",
       no_finite_number},
      {"neither", [](auto& d) { d.coordinates->elements[0].damping = 0.0; }, "coordinates.elements.0", link_of_nothing},
      {"friction_of_nothing",
       [](auto& d) {
         d.coordinates->frictions.push_back({{0.0, 0.0, 0.0, 0.0}, 1.0});
       },
       "coordinates.frictions.0", weights_not_one_a_coordinate},
      {"friction_of_no_force",
       [](auto& d) {
         d.coordinates->frictions.push_back({{1.0, 0.0, 0.0, 0.0}, 0.0});
       },
       "coordinates.frictions.0", no_finite_number},
      {"asymmetric_mass", [](auto& d) { d.coordinates->mass[1] *= 1.5; }, "coordinates.mass", no_mass_matrix},
      {"indefinite_mass", [](auto& d) { d.coordinates->mass[15] = 0.0; }, "coordinates.mass", no_mass_matrix},
      {"no_such_point", [](auto& d) { d.loop.held = 2; }, "loop.held", no_body_number},
  };
  for (const Refused& each : cases) {
    SCOPED_TRACE(each.name);
    DeviceParameters parameters = planar_arm::device({0.3, 1.2}, 1.0, 0.0);
    ASSERT_FALSE(find_problem(parameters));
    each.change(parameters);
    const std::optional<DeviceProblem> found = find_problem(parameters);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->key, each.key);
    EXPECT_EQ(found->problem.value().code, each.code);
  }
}

// Two motions of the arm that no spring holds are one rigid term: one pole at zero is seen along a normal.
TEST(Coordinates, may_have_what_rounding_leaves_of_0) {
  DeviceParameters parameters = planar_arm::device({0.3, 1.2}, 1.0, 0.0);
  ASSERT_EQ(parameters.coordinates->points[1].weights.size(), 4U);
  const double limit = critical_stiffness(Device(parameters)).stiffness;
  parameters.coordinates->points[0].weights[3] += 1e-32;
  parameters.coordinates->elements[2].weights[3] = -1e-32;
  parameters.coordinates->mass[3] = parameters.coordinates->mass[12] = 1e-35;
  ASSERT_FALSE(find_problem(parameters));
  EXPECT_NEAR(critical_stiffness(Device(parameters)).stiffness / limit, 1.0, 1e-12);
}

TEST(Coordinates, of_an_arm_have_one_rigid_term_and_a_mode_for_each_cable) {
  const ModalForm form = modal_form(Device(planar_arm::device({0.3, 1.2}, 1.0, 0.0)));
  EXPECT_EQ(form.modes.size(), 2U);
  ASSERT_FALSE(form.terms.empty());
  EXPECT_EQ(form.terms.front().mode, 0);
  EXPECT_EQ(form.terms.front().integrators, 1);
}

TEST(Coordinates, are_refused_by_what_knows_bodies_alone) {
  const Device arm(planar_arm::device({0.3, 1.2}, 1.0, 0.0));
  try {
    require_no_coordinates(arm);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::needs_bodies);
  }
  DeviceParameters bodies;
  bodies.bodies.push_back({"body", 1.0, 0.0, 0.0, 0.0});
  bodies.loop.sampling_period = 1e-3;
  EXPECT_NO_THROW(require_no_coordinates(Device(bodies)));
}

}  // namespace
}  // namespace zwidth
