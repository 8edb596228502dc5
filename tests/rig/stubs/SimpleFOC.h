/* What firmware/examples/simplefoc_motor takes of Arduino and of SimpleFOC 2.3.4, to compile it without them. */
#pragma once
#include <stddef.h>
#include <stdint.h>

extern "C" unsigned long millis(void);
struct SerialPort {
  void begin(unsigned long baud);
  int available();
  int read();
  size_t write(const uint8_t* bytes, size_t count);
};
extern SerialPort Serial;

enum Direction : int8_t { CW = 1, CCW = -1, UNKNOWN = 0 };
enum MotionControlType : uint8_t { torque = 0, velocity = 1, angle = 2 };
enum TorqueControlType : uint8_t { voltage = 0, dc_current = 1, foc_current = 2 };
struct MagneticSensorI2CConfig_s {
  int chip_address;
};
extern MagneticSensorI2CConfig_s AS5600_I2C;
struct Sensor {
  virtual float getAngle();
  virtual float getVelocity();
};
struct MagneticSensorI2C : Sensor {
  explicit MagneticSensorI2C(MagneticSensorI2CConfig_s config);
  void init();
};
struct BLDCDriver3PWM {
  BLDCDriver3PWM(int a, int b, int c, int enable);
  int init();
  float voltage_power_supply;
};
struct BLDCMotor {
  explicit BLDCMotor(int pole_pairs);
  void linkSensor(Sensor* sensor);
  void linkDriver(BLDCDriver3PWM* driver);
  int init();
  int initFOC();
  void loopFOC();
  void move(float target);
  MotionControlType controller;
  TorqueControlType torque_controller;
  float voltage_limit;
  Direction sensor_direction;
};
