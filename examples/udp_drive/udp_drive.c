/* A drive for `zwidth rig --driver udp:HOST:PORT` in C99, to start a firmware or a bridge from.
 *
 *   cc -O2 -o udp_drive udp_drive.c -lm && ./udp_drive 7000
 *   zwidth rig limit devices/lhifam_rigid.toml --driver udp:127.0.0.1:7000 --force-limit 20 --position-limit 0.1
 *
 * Replace read_position() and apply_force() by those of your device; here they are a mass with friction in air.
 */
#include "udp_drive.h"

static const double mass = 5.4, damping = 3.5; /* kg, N s/m */
static double position, velocity, acting, moved_at;

/* m or rad. Here: the exact motion of the mass under the force since the last call. */
static double read_position(void) {
  const double time = now(), h = time - moved_at, a = exp(-damping * h / mass), end = acting / damping;
  position += end * h + (velocity - end) * (1.0 - a) * mass / damping;
  velocity = end + (velocity - end) * a;
  moved_at = time;
  return position;
}

/* N or N m, from now on. */
static void apply_force(double newtons) {
  read_position();
  acting = newtons;
}

int main(int count, char** arguments) {
  moved_at = now();
  return udp_drive(count > 1 ? atoi(arguments[1]) : 7000, read_position, apply_force);
}
