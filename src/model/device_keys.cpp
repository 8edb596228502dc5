#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "model/key_members.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr auto made_tables() {
  using enum DeviceTable;
  return std::to_array<DeviceTableKey>({
      {root, root, ""},
      {body, root, "body", true, "", "1 to 100, all connected by links; or `[mechanism]`, or `[transfer_function]`"},
      {link, root, "link", true, "none", "at most 1000"},
      {mechanism, root, "mechanism", false, "none", "instead of bodies and links; linear motion"},
      {mechanism_pose, mechanism, "pose", false, "none",
       "a key a joint, in rad, or m of a slide, or a text with its unit; others follow loops and cables, or stay as "
       "the file has them"},
      {mechanism_joint, mechanism, "joint", false, "none",
       "numbers in place of those of the mechanism's file, by the joint's name", "1.0", true},
      {mechanism_tendon, mechanism, "tendon", false, "none", "the same of a tendon", "1.0", true},
      {transmission, root, "transmission", true, "none", "with `[mechanism]`: motors that its file does not have"},
      {loop, root, "loop", false, needed_key, ""},
      {loop_damper, loop, "damper", false, "none", "a damper that runs in a loop of its own"},
      {actuator, root, "actuator", false, "", ""},
      {sensor, root, "sensor", false, "", ""},
      {wall, root, "wall", false, "", ""},
      {filter, wall, "filter", true, "none", "at most 20"},
      {user, root, "operator", false, "", "a user at the held body"},
      {transfer_function, root, "transfer_function", false, "none",
       "instead of bodies and links, without `[operator]`: force to sensed position"},
      {uncertainty, root, "uncertainty", false, "none", "of some numbers above"},
      {driver, root, "driver", false, "none", "what a rig reaches the motor through"},
  });
}

// The one table of the device file's keys, in the order of DeviceTable and of a written file. A new key is a row here, its
// member and its use; tests/rules/device_keys.py writes it into the document and for the page.
constexpr auto made_rows() {
  using enum DeviceTable;
  using enum KeyReach;
  using enum KeyType;
  using enum Measure;
  constexpr auto none = std::nullopt;
  constexpr NumberRange above_0 = positive_numbers;
  constexpr NumberRange from_0 = not_negative_numbers;
  constexpr const char* as_file = "as the mechanism's file has it";
  return std::to_array<KeyRow>({
      {{root, "name", text, none, none, "the file's name without its end", "text, at most 200 bytes",
        "Name for people."}},
      {{root, "motion", text, none, none, "`\"linear\"`", "`\"linear\"`, `\"rotary\"`",
        "Which units all numbers have."}},

      {{body, "name", text, none, none, needed_key, "text, at most 200 bytes, different for every body",
        "Name of the body."}},
      {{body, "mass", number, mass, above_0, needed_key, "",
        "Mass of the body; of a rotary device its moment of inertia."},
       &Body::mass},
      {{body, "inertia", number, mass, above_0, "`mass`", "of rotary motion", "The same.", "mass"}},
      {{body, "damping", number, damping, from_0, "0", "", "Viscous damping between the body and the ground."},
       &Body::damping},
      {{body, "stiffness", number, stiffness, from_0, "0", "", "Spring between the body and the ground."},
       &Body::stiffness},
      {{body, "coulomb", number, force, from_0, "0", "", "Coulomb friction of the body. No limit depends on it."},
       &Body::coulomb,
       nothing},

      {{link, "between", texts, none, none, needed_key, "two names of different bodies",
        "The bodies that it connects."}},
      {{link, "stiffness", number, stiffness, from_0, "0", "one of the two > 0",
        "Stiffness of the cable, belt, shaft or gear between two bodies."},
       &Link::stiffness,
       response,
       true},
      {{link, "damping", number, damping, from_0, "0", "one of the two > 0",
        "Viscous damping between the two bodies; of a damping ratio z it is 2 z sqrt(stiffness m), m = m1 m2/(m1 + "
        "m2)."},
       &Link::damping},

      {{mechanism, "file", text, none, none, "needed, or `text`", "beside the device file",
        "File of the mechanism, MJCF or URDF."},
       &MechanismFile::path},
      {{mechanism, "text", text, none, none, "needed, or `file`", "names no other file",
        "What the file says, in its place."}},
      {{mechanism, "tip", text, none, none, needed_key, "a site or body (MJCF), a link (URDF)",
        "Where the wall is touched and the user holds."},
       &MechanismFile::tip},
      {{mechanism, "encoders", texts, none, none, "the joints that motors drive", "joints", "Joints that are read."}},
      {{mechanism, "normal", numbers, none, none, needed_key, "three numbers, not all 0, or \"all\"",
        "Normal of the wall in the world's frame."}},

      {{mechanism_joint, "damping", number, damping, from_0, as_file, "of a slide N s/m",
        "Viscous damping of the joint."}},
      {{mechanism_joint, "stiffness", number, stiffness, from_0, as_file, "of a slide N/m", "Spring of the joint."}},
      {{mechanism_joint, "armature", number, mass, from_0, as_file, "of a slide kg",
        "Inertia of the joint beside that of the bodies, as of a rotor."}},

      {{mechanism_tendon, "stiffness", number, stiffness, from_0, as_file, "0: no cable; by the unit of its length",
        "Stiffness of the cable."},
       {},
       response,
       true},
      {{mechanism_tendon, "damping", number, damping, from_0, as_file, "by the unit of its length",
        "Viscous damping of the cable."}},

      {{transmission, "joint", text, none, none, needed_key, "a joint of the mechanism",
        "Joint that the motor drives."}},
      {{transmission, "ratio", number, ratio, above_0, "1", "", "Turns of the motor per turn of the joint."},
       &Transmission::ratio},
      {{transmission, "inertia", number, mass, above_0, needed_key, "", "Inertia of the motor."},
       &Transmission::inertia},
      {{transmission, "motor_damping", number, damping, from_0, "0", "", "Viscous damping of the motor to ground."},
       &Transmission::motor_damping},
      {{transmission, "stiffness", number, stiffness, from_0, "0", "0: the motor turns with the joint",
        "Stiffness of the cable, at the joint."},
       &Transmission::stiffness,
       response,
       true},
      {{transmission, "damping", number, damping, from_0, "0", "", "Damping of the cable, at the joint."},
       &Transmission::damping},

      {{loop, "actuated", text, none, none, "the first body", "a body's name; none with `[transfer_function]`",
        "The body that the actuator pushes."}},
      {{loop, "sensed", text, none, none, "the first body", "likewise", "The body whose position is sampled."}},
      {{loop, "held", text, none, none, "the last body", "likewise", "The body that the user holds."}},
      {{loop, "sampling_period", number, time, above_0, needed_key, "", "Time between two samples of the controller."},
       &Loop::sampling_period,
       limits},
      {{loop, "delay", number, time, from_0, "0", "at most 10 000 sampling periods",
        "From sample to force, in addition to the half period that holding the force costs."},
       &Loop::delay},

      {{loop_damper, "sampling_period", number, time, above_0, "`loop.sampling_period`",
        "a whole part or multiple of `loop.sampling_period`, at most 1000",
        "Time between two samples of the wall's damper, as where a drive closes it."},
       &LoopDamper::sampling_period,
       limits},
      {{loop_damper, "delay", number, time, from_0, "`loop.delay`", "at most 10 000 sampling periods",
        "From the damper's sample to its force, in addition to the half period that holding the force costs."},
       &LoopDamper::delay,
       limits},

      {{actuator, "time_constant", number, time, from_0, "0", "",
        "Time constant from commanded to real force, first order."},
       &Actuator::time_constant},
      {{actuator, "force_limit", number, force, above_0, "none", "",
        "Where the force saturates. No limit depends on it."},
       &Actuator::force_limit,
       nothing},

      {{sensor, "resolution", number, position, from_0, "0", "",
        "Position of one count of the encoder. No limit depends on it."},
       &Sensor::resolution,
       nothing},
      {{sensor, "tracking_bandwidth", number, angular_frequency, from_0, "0", "0: it reads the position as it is",
        "Bandwidth w of the drive's tracking of the position, (2 w s + w²)/(s + w)²."},
       &Sensor::tracking_bandwidth,
       limits,
       true},

      {{wall, "stiffness", number, stiffness, from_0, "none", "", "Stiffness K of the virtual wall that is judged."},
       &Wall::stiffness,
       nothing},
      {{wall, "damping", number, damping, from_0, "0", "",
        "Virtual damper B of the wall: B times the difference of two sampled positions, per period."},
       &Wall::damping,
       limits},
      {{wall, "velocity_filter_hz", number, frequency_hz, from_0, "0", "",
        "Low-pass of the damper's velocity; 0 is none."},
       &Wall::velocity_filter_hz,
       limits,
       true},
      {{wall, "velocity_filter_tau", number, time, from_0, "0", "not both",
        "The same by backward Euler's time constant.", "velocity_filter_hz"},
       {},
       limits},

      {{filter, "type", text, none, none, needed_key,
        "`\"low_pass\"`, `\"notch\"`, `\"lead_lag\"`, `\"biquad\"`, `\"digital\"`",
        "Which of the numbers below it has."}},
      {{filter, "frequency_hz", number, frequency_hz, above_0, "needed; `biquad`: none, not prewarped",
        "below Nyquist; not of `digital`", "Where the filter of the wall's force acts."},
       &WallFilter::frequency_hz,
       limits},
      {{filter, "order", whole_number, none, NumberRange{1, 2}, "1", "of `low_pass`", "Order of the filter."},
       &WallFilter::order,
       limits},
      {{filter, "damping_ratio", number, ratio, NumberRange{1e-6, 1e3}, "1/sqrt 2",
        "of `low_pass` of order 2 and `notch`", "Damping ratio of the filter."},
       &WallFilter::damping_ratio,
       limits},
      {{filter, "depth", number, ratio, NumberRange{1e-6, 1}, "0.1", "of `notch`",
        "Gain of the notch at its frequency."},
       &WallFilter::depth,
       limits},
      {{filter, "ratio", number, ratio, NumberRange{1e-6, 1e6}, needed_key, "of `lead_lag`",
        "Ratio of the lead (above 1) or lag."},
       &WallFilter::ratio,
       limits},
      {{filter, "numerator", numbers, none, none, needed_key,
        "1 to as many as the denominator, static gain > 0; of `biquad` and `digital`", "Numerator by falling powers."}},
      {{filter, "denominator", numbers, none, none, needed_key,
        "2 or 3, the first not 0, poles stable; each 0 or 1e-100 to 1e100 in magnitude; of the same two",
        "Denominator by falling powers of s or z."}},

      {{user, "mass", number, mass, from_0, "0", "", "Mass of the user's hand."}, &User::mass},
      {{user, "inertia", number, mass, from_0, "`mass`", "of rotary motion", "The same.", "mass"}},
      {{user, "damping", number, damping, from_0, "0", "", "Damping of the user's hand."}, &User::damping},
      {{user, "stiffness", number, stiffness, from_0, "0", "", "Stiffness of the user's hand."}, &User::stiffness},

      {{transfer_function, "numerator", numbers, none, none, needed_key,
        "of lower degree than the denominator, not all 0, no longer than it; each 0 or 1e-100 to 1e100 in magnitude",
        "Numerator by falling powers of s."}},
      {{transfer_function, "denominator", numbers, none, none, needed_key,
        "at most 101, the first not 0; each 0 or 1e-100 to 1e100 in magnitude", "Denominator by falling powers of s."}},

      {{uncertainty, "parameters", texts, none, none,
        "needed, unless the table only says how far the file is to be trusted",
        "1 to 100 different keys, each with a value", "The numbers that are uncertain."}},
      {{uncertainty, "covariance", matrix, none, none, "with `parameters`",
        "a row per parameter; symmetric, positive semidefinite, variances 0 or 1e-60 to 1e60",
        "Their covariance, in products of their units."}},
      {{uncertainty, "verdict", text, none, none, "`doubtful` with a warning, reasons or assumed numbers, else `sound`",
        "`\"sound\"`, `\"doubtful\"`: the numbers stand but the data do not carry them; `\"refused\"`: no limit is "
        "computed "
        "from this device",
        "How far the file is to be trusted; every command repeats it."}},
      {{uncertainty, "warning", text, none, none, "none", "text", "Why; every command repeats it."}},
      {{uncertainty, "reasons", texts, none, none, "none", "an array of texts", "Why; every command repeats them."}},
      {{uncertainty, "assumed", texts, none, none, "none", "keys such as `body.motor.mass`",
        "Numbers that nobody has measured or stated; the device is doubtful until they are off the list."}},

      {{driver, "travel", number, position, above_0, "none", "",
        "How far the device moves per turn behind the gear. Linear: needed; rotary: else a turn."},
       &MotorDrive::travel},
      {{driver, "gear", number, ratio, above_0, "1", "", "Turns of the motor per turn behind the gear."},
       &MotorDrive::gear},
      {{driver, "sign", sign, none, none, "1", "1 or -1", "-1 where the drive counts against the device."},
       &MotorDrive::sign},
      {{driver, "force_sign", sign, none, none, "1", "1 or -1",
        "-1 where a torque turns the motor against the way that the drive counts: `rig check` tells."},
       &MotorDrive::force_sign},
      {{driver, "torque_constant", number, torque_per_current, above_0, "none", "",
        "Torque constant of the motor: for VESC, and SimpleFOC by current."},
       &MotorDrive::torque_constant},
      {{driver, "torque_per_volt", number, torque_per_voltage, above_0, "none", "",
        "Of the motor at rest, k_t/R: for SimpleFOC by voltage."},
       &MotorDrive::torque_per_volt},
      {{driver, "id", whole_number, none, NumberRange{0, 253}, "the firmware's", "",
        "ODrive: the axis, 0 or 1; on CAN its node id, 0 to 62. moteus: 1 to 127. VESC on CAN: its VESC ID, needed."},
       &MotorDrive::id},
      {{driver, "command", text, none, none, "M", "a letter", "The motor's letter in SimpleFOC's Commander."},
       &MotorDrive::command},
      {{driver, "baud", whole_number, none, NumberRange{1200, 4'000'000}, "the firmware's", "of those that a port has",
        "Of the serial line; of a CAN bus its bit rate."},
       &MotorDrive::baud},
  });
}

// Of a joint, whose name is its key.
constexpr KeyRow pose_row{
    {DeviceTable::mechanism_pose, "", KeyType::number, Measure::position, std::nullopt, "", "", ""}};

constexpr auto all_tables = made_tables();
constexpr auto all_rows = made_rows();
static_assert(std::ranges::is_sorted(all_rows, {}, [](const KeyRow& row) { return row.key.table; }));

constexpr auto all_keys = [] {
  std::array<DeviceKey, all_rows.size()> keys;
  std::ranges::transform(all_rows, keys.begin(), &KeyRow::key);
  return keys;
}();

const DeviceTableKey& entry_of(DeviceTable table) { return all_tables[static_cast<std::size_t>(table)]; }

}  // namespace

namespace internal {

std::span<const KeyRow> rows_of(DeviceTable table) {
  const auto table_of = [](const KeyRow& row) { return row.key.table; };
  return {std::ranges::lower_bound(all_rows, table, {}, table_of),
          std::ranges::upper_bound(all_rows, table, {}, table_of)};
}

const DeviceKey& key_of(DeviceTable table, std::string_view name) {
  return std::ranges::find(rows_of(table), name, [](const KeyRow& row) { return row.key.name; })->key;
}

const KeyRow* row_of(std::string_view key) {
  if (key.starts_with(path_of(DeviceTable::mechanism_pose) + ".")) return &pose_row;
  const std::size_t dot = key.rfind('.');
  const std::string_view table = key.substr(0, dot == std::string_view::npos ? 0 : dot);
  const std::string_view name = key.substr(dot + 1);  // npos + 1 is 0
  for (const KeyRow& row : all_rows) {
    if (row.key.name != name) continue;
    const std::string path = path_of(row.key.table);
    const DeviceTableKey& entry = entry_of(row.key.table);
    if (table == path || ((entry.is_many || entry.is_by_name) && table.starts_with(path + "."))) return &row;
  }
  return nullptr;
}

bool is_key_of(WallFilter::Kind kind, std::string_view key) {
  using enum WallFilter::Kind;
  if (key == "type") return true;
  if (key == "frequency_hz") return kind != digital;
  if (key == "order") return kind == low_pass;
  if (key == "damping_ratio") return kind == low_pass || kind == notch;
  if (key == "depth") return kind == notch;
  if (key == "ratio") return kind == lead_lag;
  return kind == biquad || kind == digital;
}

bool is_number_of(const WallFilter& filter, std::string_view key) {
  using enum WallFilter::Kind;
  if (filter.kind == biquad && !(filter.frequency_hz > 0.0)) return false;
  if (filter.kind == low_pass && filter.order == 1 && key == "damping_ratio") return false;
  return is_key_of(filter.kind, key);
}

}  // namespace internal

std::span<const DeviceKey> device_keys() { return all_keys; }

std::span<const DeviceTableKey> device_tables() { return all_tables; }

std::string path_of(DeviceTable table) {
  const DeviceTableKey& own = entry_of(table);
  return own.parent == DeviceTable::root ? std::string(own.name) : fmt::format("{}.{}", path_of(own.parent), own.name);
}

std::string header_of(DeviceTable table) {
  if (table == DeviceTable::root) return "the top level";
  const DeviceTableKey& own = entry_of(table);
  if (own.is_by_name) return fmt::format("[{}.NAME]", path_of(table));
  return fmt::format(fmt::runtime(own.is_many ? "[[{}]]" : "[{}]"), path_of(table));
}

std::optional<Measure> measure_of(std::string_view key) {
  if (key.find('.') != std::string_view::npos) {
    const KeyRow* const row = row_of(key);
    return row == nullptr ? std::nullopt : row->key.measure;
  }
  const auto* const found = std::ranges::find(all_keys, key, &DeviceKey::name);
  return found == all_keys.end() ? std::nullopt : found->measure;
}

}  // namespace zwidth
