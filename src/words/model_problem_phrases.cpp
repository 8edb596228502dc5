#include <array>

#include "words/problem_phrase.hpp"

namespace zwidth::internal {

std::span<const ProblemPhrase> model_problem_phrases() {
  using enum ProblemCode;
  static constexpr const char* is = "is {value:exact}";
  static constexpr std::array phrases{
      ProblemPhrase{no_finite_number, "no_finite_number", is,
                    "must be a finite number {?from_zero|>=}{!from_zero|>} 0"},
      ProblemPhrase{not_one_of, "not_one_of", "is {?value|{value:exact}}{!value|\"{given}\"}",
                    "{?meant|did you mean \"{meant}\"?}{!meant|must be {choices}}"},
      ProblemPhrase{control_character, "control_character", "has a control character",
                    "must be one line of plain text"},
      ProblemPhrase{too_many_bytes, "too_many_bytes", "has {bytes:n} bytes", "must be at most {most:n} bytes long"},
      ProblemPhrase{stands_too_often, "stands_too_often", "stands {count:n} times", "must be at most {most:n} {what}"},
      ProblemPhrase{name_empty, "name_empty", "is empty", "must be a name"},
      ProblemPhrase{names_two_bodies, "names_two_bodies", "\"{name}\" names two bodies",
                    "must be different for every body"},
      ProblemPhrase{no_body_number, "no_body_number", "{?of_two|has}{!of_two|is} body number {body:n} of {bodies:n}",
                    "must be {?of_two|two bodies}{!of_two|a body} of the device, counted from 0"},
      ProblemPhrase{tied_to_itself, "tied_to_itself", "ties \"{name}\" to itself", "must be two different bodies"},
      ProblemPhrase{link_of_nothing, "link_of_nothing", "and damping are both 0",
                    "one of the two must be > 0, or there is no link"},
      ProblemPhrase{body_not_connected, "body_not_connected",
                    "{?other|is not connected to body \"{other}\"}{!other|is tied to nothing}",
                    "must be connected to every other body through [[link]]s"},
      ProblemPhrase{number_of_coefficients, "number_of_coefficients",
                    "{?count=0|is empty}{!count=0|has {count:n} coefficients}",
                    "must {?denominator|have at least 1 and no more than the denominator}"
                    "{?least|have {least:n} to {most:n}, by falling powers}"
                    "{!denominator|{!least|be {?count=0|one or more}{!count=0|at most {most:n}} coefficients}}"},
      ProblemPhrase{coefficient_out_of_range, "coefficient_out_of_range", "has the coefficient {value:exact}",
                    "every coefficient must be 0 or from {least:exact} to {most:exact} in magnitude"},
      ProblemPhrase{all_coefficients_zero, "all_coefficients_zero", "is 0", "must have a coefficient that is not 0"},
      ProblemPhrase{begins_with_zero, "begins_with_zero", "begins with 0", "the leading coefficient must not be 0"},
      ProblemPhrase{degree_not_lower, "degree_not_lower",
                    "has degree {degree:n} under a denominator of degree {denominator:n}",
                    "must be of lower degree than the denominator"},
      ProblemPhrase{longer_than_denominator, "longer_than_denominator", "is longer than the denominator",
                    "leave out its leading zeros"},
      ProblemPhrase{beside_transfer_function, "beside_transfer_function",
                    "{?part=loop|names a body}{!part=loop|stands} beside [transfer_function]",
                    "{?part=bodies|must be either bodies and links or a transfer function}"
                    "{?part=loop|a transfer function has no bodies: leave it out}"
                    "{?part=operator|an operator needs bodies: leave it out}"},
      ProblemPhrase{beside_coordinates, "beside_coordinates", "stand beside bodies, links or a transfer function",
                    "must be one of the three"},
      ProblemPhrase{coordinates_out_of_range, "coordinates_out_of_range", "are {count:n}",
                    "must be from 1 to {most:n}, the same number for every point"},
      ProblemPhrase{weights_not_one_a_coordinate, "weights_not_one_a_coordinate",
                    "does not have a finite weight for each of the {count:n} coordinates, one of them other than 0",
                    ""},
      ProblemPhrase{no_mass_matrix, "no_mass_matrix", "is no mass matrix of {count:n} coordinates",
                    "must be square, symmetric and positive definite"},
      ProblemPhrase{no_direction, "no_direction", "[{x:exact}, {y:exact}, {z:exact}] is no direction",
                    "must be three numbers, one of them other than 0"},
      ProblemPhrase{tip_does_not_move, "tip_does_not_move",
                    "the tip cannot move along [{x:.6g}, {y:.6g}, {z:.6g}] at this pose",
                    "must be another normal or pose"},
      ProblemPhrase{tip_not_determined_by_encoders, "tip_not_determined_by_encoders",
                    "encoders and cables do not tell how the tip moves along [{x:.6g}, {y:.6g}, {z:.6g}]",
                    "must be an encoder for every motion"},
      ProblemPhrase{tip_not_moved_by_motors, "tip_not_moved_by_motors",
                    "motors cannot push the tip along [{x:.6g}, {y:.6g}, {z:.6g}] alone",
                    "must be a motor for every motion"},
      ProblemPhrase{motor_or_encoder_depends, "motor_or_encoder_depends",
                    "one of the motors or encoders turns as the others and the cables say",
                    "leave it out, or give another pose"},
      ProblemPhrase{
          mechanism_file_refused, "mechanism_file_refused",
          "{?line|{?file|{file}: }line {line:n}: }{?why|{why}}{?name|\"{name}\" cannot be read}{?part=reader|MuJoCo "
          "cannot read it}{?part=joint|has "
          "no joint}{?part=loops|has too many "
          "loops}{?part=files|includes too many files}{?part=mass|has masses, inertias or armatures that make "
          "no mass matrix}{?part=tip|has its tip beyond 1e+06 m}{?part=viscosity|is in a viscous fluid, and drag on "
          "geoms is "
          "not read}{?part=numbers|has numbers that are none: NaN, infinity, or a quaternion of "
          "zeros}{?part=joint's|{attribute} of joint \"{of}\" "
          "is {value:exact}}{?part=tendon's|{attribute} of tendon \"{of}\" is {value:exact}}",
          "{!value|must {!part=viscosity|be a file in MJCF or URDF}{?part=viscosity|leave viscosity out: write the "
          "drag as "
          "damping of joints}}{?value|must be a finite number{?attribute=position| from "
          "-1e+06 to 1e+06}{!attribute=position|, 0 or from 1e-30 to 1e+30}}"},
      ProblemPhrase{no_such_part, "no_such_part",
                    "the mechanism has no {?kind=joint|joint}{?kind=tip|site or body}{?kind=tendon|tendon} \"{name}\"",
                    "{?names|must be one of {names}}"},
      ProblemPhrase{joint_of_many_motions, "joint_of_many_motions", "joint \"{name}\" is neither hinge nor slide",
                    "must be joints of one motion"},
      ProblemPhrase{loop_does_not_close, "loop_does_not_close",
                    "the mechanism's loops stay open by {open:.3g} at this pose",
                    "must be a pose that the loops reach"},
      ProblemPhrase{no_motor, "no_motor", "the mechanism has no motor", "must have actuators, or a [[transmission]]"},
      ProblemPhrase{built_without_mujoco, "built_without_mujoco", "this build reads no mechanisms",
                    "build with libmujoco-dev"},
      ProblemPhrase{no_mechanism_at_pose, "no_mechanism_at_pose", "has no coordinates",
                    "must be made by device_of_mechanism()"},
      ProblemPhrase{beside_mechanism, "beside_mechanism", "stands beside [mechanism]",
                    "{?part=loop|motors, encoders and tip are the mechanism's: leave it out}"
                    "{!part=loop|must be one of the two}"},
      ProblemPhrase{mechanism_of_rotary_motion, "mechanism_of_rotary_motion",
                    "is rotary: the wall that a mechanism touches is linear", "leave it out"},
      ProblemPhrase{without_mechanism, "without_mechanism", "stands without [mechanism]",
                    "must be motors of a mechanism"},
      ProblemPhrase{normal_not_three_numbers, "normal_not_three_numbers", "has {count:n} numbers",
                    "must be three: x, y and z in the world's frame"},
      ProblemPhrase{point_wall_not_known, "point_wall_not_known", "is a wall in every direction",
                    "must be one direction, such as [1, 0, 0]: analyze and region answer for all"},
      ProblemPhrase{unit_of_other_joint, "unit_of_other_joint",
                    "has {!number|a unit of {?slides|angle}{!slides|length}}{?number|the unit of a joint that "
                    "{?slides|turns}{!slides|slides}}, and joint \"{name}\" {?slides|slides}{!slides|turns}",
                    "must {!number|be {?slides|a length}{!slides|an angle}}{?number|have the unit of one that "
                    "{?slides|slides}{!slides|turns}}"},
      ProblemPhrase{file_beside_text, "file_beside_text", "names a file, and the device came as text",
                    "write what the file says as mechanism.text"},
      ProblemPhrase{mechanism_too_large, "mechanism_too_large", "{?line|line {line:n}: }more than {most:n} {what}",
                    "must be smaller"},
      ProblemPhrase{
          no_xml, "no_xml",
          "{?file|{file}: }line {line:n}: {?why=XML_ERROR_MISMATCHED_ELEMENT|an element does not end with a tag of its "
          "name}{?why=XML_ERROR_PARSING_ELEMENT|a tag does not end}{?why=XML_ERROR_PARSING_ATTRIBUTE|an attribute "
          "without "
          "its value in quotes, or twice}{?why=XML_ERROR_PARSING_TEXT|text that no tag follows}"
          "{?why=XML_ERROR_PARSING_CDATA|CDATA does not end}{?why=XML_ERROR_PARSING_COMMENT|a comment does not end}"
          "{?why=XML_ERROR_PARSING_DECLARATION|a declaration does not end, or is not the first}"
          "{?why=XML_ERROR_PARSING_UNKNOWN|a declaration does not end}{?why=XML_ERROR_PARSING|a tag without a name}"
          "{?why=XML_ERROR_EMPTY_DOCUMENT|no element}{?why=XML_ELEMENT_DEPTH_EXCEEDED|elements stand in one another "
          "too "
          "deep}{?why=many|more elements than are read}{?why=roots|a second root element}{?why=value|an attribute has "
          "a "
          "<}{?why=zero|a byte of 0}{?why=none|no "
          "element}{?why=declared|declarations of types, CDATA and text outside "
          "of "
          "elements are not read}",
          ""},
      ProblemPhrase{element_not_read, "element_not_read", "{?file|{file}: }line {line:n}: <{name}> is not read",
                    "{?name=mimic|write the motion that follows another as an equality of MJCF}"
                    "{!name=mimic|write the bodies themselves}"},
      ProblemPhrase{path_in_text, "path_in_text", "line {line:n}: <{name}> names a file",
                    "a mechanism that came as text names none; meshes may be left out: inertia alone counts"},
      ProblemPhrase{mass_of_mesh, "mass_of_mesh",
                    "{?file|{file}: }line {line:n}: {?name|\"{name}\"}{!name|a body} has its mass of a mesh, and "
                    "meshes are not read",
                    "must have <inertial>"},
      ProblemPhrase{include_not_read, "include_not_read",
                    "{?file|{file}: }line {line:n}: {?name|\"{name}\"}{!name|an include} {?twice|is included "
                    "twice}{!twice|cannot be read}",
                    "must be a file beside it, once"},
      ProblemPhrase{tip_stands_still, "tip_stands_still", "the tip cannot move at this pose", "must be another pose"},
      ProblemPhrase{not_a_mechanism, "not_a_mechanism", "the device is no mechanism",
                    "must be a device with [mechanism]"},
      ProblemPhrase{joint_without_range, "joint_without_range",
                    "nothing says from where to where joint \"{name}\" moves: the mechanism's file gives it no range",
                    "give its positions, first, last and how many, or the joint a range in the file"},
      ProblemPhrase{poses_given_twice, "poses_given_twice", "poses are given as a {first} and as {second}",
                    "must be one of a grid, a list and points of the tip"},
      ProblemPhrase{joint_given_twice, "joint_given_twice", "joint \"{name}\" stands twice", "must stand once"},
      ProblemPhrase{too_many_workspace_limits, "too_many_workspace_limits",
                    "{poses:n} poses times {directions:n} directions", "must be at most {most:n} together"},
      ProblemPhrase{no_wall_stiffness, "no_wall_stiffness", "the wall has no stiffness", "must be a number > 0"},
      ProblemPhrase{one_direction_alone, "one_direction_alone",
                    "the wall's filters and a damper in a loop of its own are known along one normal alone",
                    "must be a wall without them"},
      ProblemPhrase{coordinates_not_known, "coordinates_not_known", "the device has coordinates in place of bodies",
                    "this is computed for bodies and links alone"},
      ProblemPhrase{no_body_at_all, "no_body_at_all",
                    "is missing: the device has no [[body]] and no [transfer_function]",
                    "must be one or more bodies, or a transfer function"},
      ProblemPhrase{no_such_body, "no_such_body", "the device has no body \"{name}\"", ""},
      ProblemPhrase{delay_of_too_many_periods, "delay_of_too_many_periods",
                    "is {delay:exact} s, {periods:.6g} sampling periods", "must be at most {most:n} sampling periods"},
      ProblemPhrase{no_whole_ratio, "no_whole_ratio", "is {value:exact} s beside a loop of {period:exact} s",
                    "must be a whole part or multiple of it, at most {most:n}: {nearest:exact} is the nearest"},
      ProblemPhrase{filters_beside_damper_loop, "filters_beside_damper_loop",
                    "filters the force of spring and damper together, and [loop.damper] runs the damper apart",
                    "leave out one of the two"},
      ProblemPhrase{damper_loop_not_known, "damper_loop_not_known", "runs the damper in a loop of its own",
                    "this computation knows one loop for both: leave [loop.damper] out for its answer"},
      ProblemPhrase{tracking_not_known, "tracking_not_known", "has the drive track the position",
                    "this computation knows positions that are read as they are: leave it out for its answer"},
      ProblemPhrase{travel_per_turn_missing, "travel_per_turn_missing", "is missing",
                    "must be given: how far the device moves in a turn, such as \"25 mm\""},
      ProblemPhrase{no_letter, "no_letter", "is no letter", "must be one letter, such as \"M\""},
      ProblemPhrase{filter_not_stable, "filter_not_stable", "has a pole that does not die out",
                    "{?variable=z|all roots in z must lie inside the unit circle}"
                    "{?variable=s|all coefficients must have one sign, none may be 0}"},
      ProblemPhrase{static_gain_not_positive, "static_gain_not_positive", "gives the static gain {gain:exact}",
                    "the static gain must be > 0, or the wall does not push back"},
      ProblemPhrase{frequency_of_digital_filter, "frequency_of_digital_filter", is,
                    "a digital filter runs as it stands: leave it out"},
      ProblemPhrase{filter_frequency_out_of_range, "filter_frequency_out_of_range", is,
                    "must be at least {least:exact} and below the Nyquist frequency, {nyquist:.6g} Hz"},

      // Fits of models to a response
      ProblemPhrase{locking_transfer_function, "locking_transfer_function",
                    "a transfer function has no bodies that could be locked", ""},
      ProblemPhrase{no_body_to_lock, "no_body_to_lock", "there is no body number {body:n} to lock", ""},
      ProblemPhrase{locked_body_needed, "locked_body_needed", "the {role} body \"{name}\" is locked",
                    "lock another one"},
      ProblemPhrase{locked_bodies_part_device, "locked_bodies_part_device",
                    "the locked bodies part the sensed body from the actuated one", ""},
      ProblemPhrase{fit_needs_bodies, "fit_needs_bodies", "the structure is a transfer function",
                    "it must be a device of bodies"},
      ProblemPhrase{response_point_unusable, "response_point_unusable",
                    "the response at {frequency:exact} rad/s is not a frequency > 0 with a finite value that is not 0 "
                    "and a variance >= 0",
                    ""},
      ProblemPhrase{too_few_points_to_fit, "too_few_points_to_fit",
                    "the response has {points:n} points for {parameters:n} free parameters, and must have more",
                    "leave fewer parameters free, widen the band, or record for longer (more lines)"},
      ProblemPhrase{no_number_of_structure, "no_number_of_structure", "no parameter of the structure is called {key}",
                    ""},
      ProblemPhrase{not_in_response, "not_in_response", "{key} does not show in a frequency response",
                    "it cannot be free"},
      ProblemPhrase{nothing_free, "nothing_free", "no parameter is free", ""},
      ProblemPhrase{too_many_free, "too_many_free", "{free:n} parameters are free",
                    "at most {most:n} can be fitted at once"},
      ProblemPhrase{structure_never_fits, "structure_never_fits",
                    "the fit finds no values for which the structure answers at all like the record",
                    "name a structure with other bodies, free fewer parameters, or start from values that are nearly "
                    "right"}};
  return phrases;
}

}  // namespace zwidth::internal
