/* A Hapkit, or another paddle on an ATmega328P at 16 MHz, as `zwidth rig --driver serial:PORT` drives it:
 *
 *   zwidth rig check hapkit_paddle.toml --driver serial:/dev/ttyUSB0 --force-limit 2 --position-limit 0.03
 *
 * Hapkit: magnetoresistive sensor at A2, whose voltage begins anew twice in each turn of the motor; motor bridge with PWM at
 * pin 5 and direction at pin 8. Measure the constants below of your own. Where wall.h lies beside this sketch, that wall
 * runs on the board until a host takes hold:
 *
 *   zwidth export hapkit_paddle.toml --format c --safety-factor 0.5 --output wall.h
 */
#include <avr/wdt.h>
#include <util/atomic.h>
#include <zwidth_serial.h>
#if __has_include("wall.h")
#include "wall.h"
#define HAS_WALL 1
#else
#define HAS_WALL 0
#endif

const uint8_t sensor_pin = A2, pwm_pin = 5, direction_pin = 8;
const int counts_per_flip = 980;            /* by which the reading falls where it begins anew */
const float metres_per_count = 1.3e-5f;     /* at the hand; negative where the reading falls as the hand goes forwards */
const float torque_per_force = 0.0047f;     /* m: handle radius times pulley radius over sector radius */
const float torque_of_full_duty = 0.03f;    /* N m; the bridge makes torque with the square of its duty */
const uint8_t forwards = HIGH;              /* the direction pin for a force that moves the hand forwards */
const float force_limit = 5.0f;             /* N, at the hand */
const uint16_t watchdog = 100;              /* ms */
const uint8_t lost_count = 16;              /* fault: the sensor's readings do not follow each other */

zwidth_serial_t zwidth;
volatile uint32_t milliseconds; /* of timer 1 */
long counts;
#if HAS_WALL
hapkit_paddle_wall_t wall;
#endif

ISR(TIMER1_COMPA_vect) { ++milliseconds; }

uint32_t now() {
  uint32_t time;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { time = milliseconds; }
  return time;
}

/* In the middle of a flip the reading means nothing: the next one does. */
void read_sensor() {
  static int last = -1;
  static uint8_t skipped;
  const int reading = analogRead(sensor_pin);
  int step = last < 0 ? 0 : reading - last;
  if (step > counts_per_flip / 2) step -= counts_per_flip;
  if (step < -counts_per_flip / 2) step += counts_per_flip;
  if (abs(step) > counts_per_flip / 8) {
    if (++skipped > 20) zwidth_serial_fail(&zwidth, lost_count);
    return;
  }
  skipped = 0;
  last = reading;
  counts += step;
}

void apply(float force) {
  static float applied;
  if (force == applied) return;
  applied = force;
  const float duty = sqrt(fabs(force) * torque_per_force / torque_of_full_duty);
  digitalWrite(direction_pin, force > 0.0f ? forwards : !forwards);
  analogWrite(pwm_pin, duty < 1.0f ? (int)(255.0f * duty + 0.5f) : 255);
}

float force_of_own_wall(float position, uint32_t time) {
#if HAS_WALL
  static uint32_t last;
  static float force;
  if (time != last) force = hapkit_paddle_wall_force(&wall, position); /* its period is 1 ms */
  last = time;
  return force;
#else
  (void)position, (void)time;
  return 0.0f;
#endif
}

void setup() {
  pinMode(pwm_pin, OUTPUT);
  pinMode(direction_pin, OUTPUT);
  TCCR0B = (TCCR0B & 0xf8) | 1;           /* PWM at 62.5 kHz, */
  TIMSK0 = 0;                             /* whose interrupt would take a third of the processor for millis() */
  ADCSRA = (ADCSRA & 0xf8) | 5;           /* a reading takes 26 us instead of 104 */
  TCCR1A = 0;                             /* timer 1: an interrupt each millisecond */
  TCCR1B = _BV(WGM12) | _BV(CS11) | _BV(CS10);
  OCR1A = 249;
  TIMSK1 = _BV(OCIE1A);
  Serial.begin(1000000);
  zwidth_serial_begin(&zwidth, force_limit, watchdog);
#if HAS_WALL
  hapkit_paddle_wall_reset(&wall);
#endif
  read_sensor();
  wdt_enable(WDTO_250MS); /* of the microcontroller: it starts anew, without a force, where this loop hangs */
}

void loop() {
  wdt_reset();
  read_sensor();
  const uint32_t time = now();
  const float position = metres_per_count * counts;
  while (Serial.available() > 0) {
    if (!zwidth_serial_receive(&zwidth, Serial.read(), time)) continue;
    uint8_t out[ZWIDTH_SERIAL_MOST];
    Serial.write(out, zwidth_serial_answer(&zwidth, position, 0.0f, out));
  }
  apply(zwidth_serial_force(&zwidth, force_of_own_wall(position, time), time));
}
