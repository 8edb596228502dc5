/* A Touch or Phantom (OpenHaptics 3) along its x for `zwidth rig --driver udp:127.0.0.1:7000`. Compiled against the
 * functions of HDAPI that it uses; never run on hardware. Its servo loop of 1 kHz adds up to 1 ms of delay.
 *
 *   cc -I ../udp_drive openhaptics.c -lHD -lm
 */
#include <HD/hd.h>

#include "udp_drive.h"

static volatile double position = NAN, acting;

static HDCallbackCode HDCALLBACK servo(void* unused) {
  HDdouble at[3], forces[3] = {acting, 0.0, 0.0};
  (void)unused;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, at); /* mm */
  hdSetDoublev(HD_CURRENT_FORCE, forces);
  hdEndFrame(hdGetCurrentDevice());
  position = 1e-3 * at[0];
  return HD_CALLBACK_CONTINUE;
}

static double read_position(void) { return position; }
static void apply_force(double newtons) { acting = newtons; }

int main(void) {
  if (hdInitDevice(HD_DEFAULT_DEVICE) == HD_INVALID_HANDLE) return fprintf(stderr, "no device\n"), 1;
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(servo, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  return udp_drive(7000, read_position, apply_force);
}
