/* A Force Dimension device (omega, delta, sigma) along its x for `zwidth rig --driver udp:127.0.0.1:7000`. Compiled against
 * the functions of the SDK 3 that it uses; never run on hardware.
 *
 *   cc -I ../udp_drive -I SDK/include force_dimension.c -L SDK/lib -ldhd -lm
 */
#include <dhdc.h>

#include "udp_drive.h"

static double read_position(void) {
  double x, y, z;
  return dhdGetPosition(&x, &y, &z, -1) < 0 ? NAN : x; /* m; no number stops the rig */
}

static void apply_force(double newtons) { dhdSetForce(newtons, 0.0, 0.0, -1); }

int main(void) {
  if (dhdOpen() < 0 || dhdEnableForce(1, -1) < 0) return fprintf(stderr, "%s\n", dhdErrorGetLastStr()), 1;
  return udp_drive(7000, read_position, apply_force);
}
