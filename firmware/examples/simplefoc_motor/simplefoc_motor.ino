/* A brushless motor that SimpleFOC (2.3 or newer) commutates, as `zwidth rig --driver serial:PORT` drives it. SimpleFOC has
 * no watchdog of its own; this sketch does.
 *
 *   zwidth rig check knob.toml --driver serial:/dev/ttyACM0 --force-limit 0.05 --position-limit 1
 *
 * Put in your sensor, driver and pins, as SimpleFOC's documents say, and the torque that a volt makes at rest.
 */
#include <SimpleFOC.h>
#include <zwidth_serial.h>

const float torque_per_volt = 0.02f; /* N m/V: torque constant over phase resistance */
const float torque_limit = 0.1f;     /* N m */
const uint16_t watchdog = 100;       /* ms */
const uint8_t no_foc = 16;           /* fault: initFOC() failed */

MagneticSensorI2C sensor = MagneticSensorI2C(AS5600_I2C);
BLDCDriver3PWM driver = BLDCDriver3PWM(9, 5, 6, 8);
BLDCMotor motor = BLDCMotor(7);
zwidth_serial_t zwidth;

void setup() {
  Serial.begin(1000000); /* of no consequence over USB */
  sensor.init();
  motor.linkSensor(&sensor);
  driver.voltage_power_supply = 12;
  driver.init();
  motor.linkDriver(&driver);
  motor.controller = MotionControlType::torque;
  motor.torque_controller = TorqueControlType::voltage;
  motor.voltage_limit = torque_limit / torque_per_volt;
  motor.init();
  zwidth_serial_begin(&zwidth, torque_limit, watchdog);
  if (!motor.initFOC()) zwidth_serial_fail(&zwidth, no_foc);
}

void loop() {
  motor.loopFOC(); /* reads the sensor */
  const float direction = (float)motor.sensor_direction; /* so that torque > 0 turns towards greater angles */
  while (Serial.available() > 0) {
    if (!zwidth_serial_receive(&zwidth, Serial.read(), millis())) continue;
    uint8_t out[ZWIDTH_SERIAL_MOST];
    Serial.write(out, zwidth_serial_answer(&zwidth, direction * sensor.getAngle(), direction * sensor.getVelocity(), out));
  }
  motor.move(zwidth_serial_force(&zwidth, 0.0f, millis()) / torque_per_volt);
}
