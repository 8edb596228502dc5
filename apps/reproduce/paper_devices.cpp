#include "reproduce/paper_devices.hpp"

#include <utility>

namespace zwidth::report {

DeviceParameters paper_lhifam() {
  DeviceParameters device;
  device.name = "LHIfAM, translational axis";
  device.bodies = {Body{.name = "motor", .mass = 0.3, .damping = 0.1},
                   Body{.name = "handle", .mass = 5.1, .damping = 3.4}};
  device.links = {Link{.first = 0, .second = 1, .stiffness = 79.5e3, .damping = 15.0}};
  device.loop = Loop{.actuated = 0, .sensed = 0, .held = 1, .sampling_period = 1e-3};
  device.sensor.resolution = 3.14e-6;
  return device;
}

DeviceParameters paper_lhifam_reduced_pretension() {
  DeviceParameters device = paper_lhifam();
  device.name = "LHIfAM, reduced cable pretension (inferred)";
  device.links[0].stiffness = 27.55e3;
  device.links[0].damping = 10.5;
  return device;
}

DeviceParameters paper_lhifam_rigid() {
  const DeviceParameters flexible = paper_lhifam();
  DeviceParameters device;
  device.name = "LHIfAM, rigid";
  // Table I prints 5.4 kg and 3.5 N s/m, the sums.
  device.bodies = {Body{.name = "body", .mass = 5.4, .damping = 3.5}};
  device.loop.sampling_period = flexible.loop.sampling_period;
  device.sensor = flexible.sensor;
  return device;
}

DeviceParameters handle_sensed(DeviceParameters device) {
  device.loop.sensed = device.loop.held;
  return device;
}

DeviceParameters with_delay(DeviceParameters device, double delay) {
  device.loop.delay = delay;
  return device;
}

const std::array<PaperTrial, 36>& paper_table_2() {
  static constexpr std::array<PaperTrial, 36> trials = {{
      {0, 64.9414, 80.3149},     {0, 64.4531, 79.9414},     {0, 65.4297, 80.3552},     {0, 65.4297, 80.3019},
      {0.001, 60.0586, 76.2336}, {0.001, 59.0820, 75.3235}, {0.001, 60.3027, 75.8445}, {0.001, 58.9600, 75.3917},
      {0.002, 4.8828, 76.1063},  {0.002, 4.8828, 76.4240},  {0.002, 4.8828, 76.9967},  {0.002, 4.8828, 75.7971},
      {0.003, 4.3945, 73.5975},  {0.003, 4.3945, 73.8443},  {0.003, 4.3945, 72.9533},  {0.003, 4.3945, 73.9426},
      {0.004, 4.3945, 73.5919},  {0.004, 4.3945, 73.6444},  {0.004, 4.5166, 73.9436},  {0.004, 4.6387, 74.6716},
      {0.005, 4.5166, 73.9604},  {0.005, 4.3945, 73.6567},  {0.005, 4.3945, 73.4947},  {0.005, 4.3945, 73.3171},
      {0.006, 3.1738, 66.8281},  {0.006, 3.1738, 66.7290},  {0.006, 3.1738, 66.6668},  {0.006, 3.1738, 66.7219},
      {0.007, 2.8076, 64.1974},  {0.007, 2.8076, 64.4480},  {0.007, 2.6855, 64.1268},  {0.007, 2.8076, 64.6013},
      {0.008, 2.3193, 61.0258},  {0.008, 2.3193, 60.8367},  {0.008, 2.3193, 61.3209},  {0.008, 2.3193, 61.4755},
  }};
  return trials;
}

}  // namespace zwidth::report
